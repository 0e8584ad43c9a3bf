"""The documentation site: every document is on it, it builds without a warning, and it loads nothing from the net."""

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest

from docs.website import gallery, reference

ROOT = Path(__file__).parents[2]
SETTINGS = (ROOT / "mkdocs.yml").read_text("utf-8")
NAV = re.findall(r"^ +- (?:[^:\n]+: )?(\S+\.md)$", SETTINGS, re.MULTILINE)
EXCLUDED = re.findall(r"^  (\S+\.md)$", SETTINGS, re.MULTILINE)
MADE = ["docs/gallery.md"]
ON_SITE = sorted(
    path.relative_to(ROOT).as_posix()
    for pattern in ("*.md", "docs/*.md", "docs/*/*.md", "examples/**/*.md")
    for path in ROOT.glob(pattern)
)
LOADING = {"script": "src", "link": "href", "img": "src", "iframe": "src", "source": "src", "video": "src"}


def test_every_document_is_in_the_navigation_or_excluded():
    assert sorted([*NAV, *EXCLUDED]) == sorted([*ON_SITE, *MADE])


def test_gallery_shows_every_example_with_its_comment_and_picture():
    page = gallery.page(ROOT)
    for file in [*ROOT.glob("examples/*.toml"), *ROOT.glob("examples/mechanisms/*.toml")]:
        text = file.read_text("utf-8")
        assert gallery.first_comment(text)
        assert gallery.first_comment(text) in page
        assert f"(../{file.relative_to(ROOT).as_posix()})" in page
    pictures = [f"pictures/mechanisms/{path.name}" for path in (ROOT / "docs/pictures/mechanisms").glob("*.png")]
    assert [name for name in [*pictures, "pictures/deformed.png"] if f"({name})" not in page] == []


def test_reference_holds_every_module():
    text = "\n".join(reference.pages(ROOT).values())
    shown = set(re.findall(r"^::: (\S+)$", text, re.MULTILINE))
    modules = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for top in reference.top_packages(ROOT)
        for path in (ROOT / top).rglob("[!_]*.py")
        if (path.parent / "__init__.py").exists()
    }
    assert modules
    assert modules - shown == set()


def test_citation_has_the_version_of_the_program():
    version = re.search(r'^version = "(.+)"$', (ROOT / "pyproject.toml").read_text("utf-8"), re.MULTILINE)[1]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text("utf-8")


class Loaded(HTMLParser):
    """Collects what a browser loads for a page without being asked."""

    def __init__(self):
        super().__init__()
        self.addresses = []

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        if tag in LOADING and found.get("rel") not in ("canonical", "next", "prev"):
            self.addresses.append(found.get(LOADING[tag]) or "")
        self.addresses += re.findall(r"url\(([^)]+)\)", found.get("style") or "")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    for needed in ("latex2mathml", "material", "mkdocs", "mkdocstrings_handlers.python"):
        pytest.importorskip(needed)
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)]
    own = {**os.environ, "PYTHONUTF8": "1"}
    done = subprocess.run(command, cwd=ROOT, env=own, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.process
def test_site_has_every_document(site):
    for name in (*NAV, "docs/api/index.md"):
        page = re.sub(r"README\.md$", "index.md", name).removesuffix(".md") + ".html"
        assert (site / page).is_file()


@pytest.mark.process
def test_site_loads_nothing_from_the_net(site):
    pages = sorted(site.rglob("*.html"))
    assert len(pages) > len(ON_SITE)
    for page in pages:
        text = page.read_text("utf-8")
        loaded = Loaded()
        loaded.feed(text)
        assert [address for address in loaded.addresses if re.match(r"\s*['\"]?(https?:)?//", address)] == []
        assert 'class="mermaid"' not in text  # the only thing for which the theme's own script asks the net
    for sheet in site.rglob("*.css"):
        assert re.findall(r"(?:url\(|@import)\s*['\"]?(?:https?:)?//", sheet.read_text("utf-8")) == []


@pytest.mark.process
def test_every_formula_of_the_site_is_drawn(site):
    solve = (site / "docs" / "solve.html").read_text("utf-8")
    assert solve.count("<math") > 100
    assert [page.name for page in site.rglob("*.html") if "arithmatex" in page.read_text("utf-8")] == []
