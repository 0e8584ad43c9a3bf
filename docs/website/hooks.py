"""What MkDocs is told beyond mkdocs.yml: the site mirrors the repository, so that links need no rewriting.

A document lies at the same place on the site as in the repository, README.md at the top and docs/ below it. Relative
links therefore lead to the same document on the site, on a code-hosting page and in an editor. Three kinds of pages
exist on the site only and are made here: the gallery of the examples, the notebooks and the reference of the packages.
"""

from pathlib import Path
from typing import Any

import formulas
import gallery
import notebooks
import reference
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
PUBLISHED = (
    "*.md",
    "docs/*.md",
    "docs/*/*.md",
    "docs/*.json",
    "docs/pictures/**/*.png",
    "examples/**/*.md",
    "examples/**/*.py",
    "examples/**/*.toml",
    "examples/**/*.txt",
    "examples/**/*.ipynb",
)
GALLERY = "docs/gallery.md"
GENERATED = {"made from the source": reference.navigation, "made from the notebooks": notebooks.navigation}
"""Entries of nav that generated pages replace."""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the pages that are made here into the navigation."""
    config.nav = _filled(config.nav)
    return config


def _filled(nav: Any) -> Any:
    """The navigation with its placeholders replaced by pages."""
    if isinstance(nav, list):
        return [filled for item in nav for filled in _pages_of(item)]
    if isinstance(nav, dict):
        return {title: _filled(item) for title, item in nav.items()}
    return nav


def _pages_of(item: Any) -> list[Any]:
    """What stands in the navigation for one entry."""
    return GENERATED[item](ROOT) if isinstance(item, str) and item in GENERATED else [_filled(item)]


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the documents of the repository and the pages that are made from it."""
    for pattern in PUBLISHED:
        for path in sorted(ROOT.glob(pattern)):
            name = path.relative_to(ROOT).as_posix()
            files.append(File(name, str(ROOT), config.site_dir, config.use_directory_urls))
    made = {GALLERY: gallery.page(ROOT), **notebooks.pages(ROOT), **reference.pages(ROOT)}
    for name, text in made.items():
        files.append(File.generated(config, name, content=text))
    return files


def on_page_content(html: str, **_: Any) -> str:
    """Formulas become MathML, which browsers draw themselves: no script, no fonts, nothing to load."""
    return formulas.as_mathml(html)
