"""Shared parts of the HTML pages: frame, style and the filling of templates."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import jinja2

HERE = Path(__file__).parent


def page_environment(folder: Path) -> "jinja2.Environment":
    """Environment of the Jinja templates in a folder, which may extend base.html and include article.css.

    Values are escaped.
    """
    import jinja2

    loader = jinja2.FileSystemLoader([folder, HERE])
    return jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)


def script_safe(text: str) -> str:
    """The JSON text with "<" escaped, so that it cannot end the script element that holds it."""
    return text.replace("<", "\\u003c")
