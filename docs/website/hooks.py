"""What MkDocs is told beyond mkdocs.yml: the site mirrors the repository, so that links need no rewriting.

A document lies at the same place on the site as in the repository, README.md at the top and docs/ below it. Relative
links therefore lead to the same document on the site, on a code-hosting page and in an editor. Two kinds of pages
exist on the site only and are made here: the gallery of the examples and the reference of the packages.
"""

from pathlib import Path
from typing import Any

import formulas
import gallery
import reference
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
PUBLISHED = (
    "*.md",
    "docs/*.md",
    "docs/*.json",
    "docs/pictures/**/*.png",
    "examples/**/*.md",
    "examples/**/*.py",
    "examples/**/*.toml",
)
GALLERY = "docs/gallery.md"
GENERATED_REFERENCE = "made from the source"  # the entry of nav that the reference of the packages replaces


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the pages of the packages into the navigation."""
    config.nav = _filled(config.nav, reference.navigation(ROOT))
    return config


def _filled(nav: Any, pages: list[Any]) -> Any:
    """The navigation with its placeholder replaced by pages."""
    if isinstance(nav, list):
        return [filled for item in nav for filled in (pages if item == GENERATED_REFERENCE else [_filled(item, pages)])]
    if isinstance(nav, dict):
        return {title: _filled(item, pages) for title, item in nav.items()}
    return nav


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the documents of the repository and the pages that are made from it."""
    for pattern in PUBLISHED:
        for path in sorted(ROOT.glob(pattern)):
            name = path.relative_to(ROOT).as_posix()
            files.append(File(name, str(ROOT), config.site_dir, config.use_directory_urls))
    made = {GALLERY: gallery.page(ROOT), **reference.pages(ROOT)}
    for name, text in made.items():
        files.append(File.generated(config, name, content=text))
    return files


def on_page_content(html: str, **_: Any) -> str:
    """Formulas become MathML, which browsers draw themselves: no script, no fonts, nothing to load."""
    return formulas.as_mathml(html)
