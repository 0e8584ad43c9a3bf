"""Pages of the notebooks: their text and code; the results appear when a notebook is run."""

import json
from pathlib import Path

FOLDER = "docs/notebooks"
SOURCE = "examples/notebooks"
HEAD = "[Download this notebook](../../{source}) and run it with `jupyter notebook {name}`.\n"


def pages(root: Path) -> dict[str, str]:
    """Name -> text in Markdown, for every notebook."""
    return {f"{FOLDER}/{path.stem}.md": _page(path, root) for path in sorted((root / SOURCE).glob("*.ipynb"))}


def navigation(root: Path) -> list[str]:
    """Entries of nav."""
    return list(pages(root))


def _page(path: Path, root: Path) -> str:
    cells = json.loads(path.read_text("utf-8"))["cells"]
    title, *rest = (_block("".join(cell["source"]), cell["cell_type"]) for cell in cells)
    source = path.relative_to(root).as_posix()
    return "\n\n".join([title, HEAD.format(source=source, name=path.name), *rest]) + "\n"


def _block(text: str, kind: str) -> str:
    return text if kind == "markdown" else f"```python\n{text}\n```"
