"""Pages of the reference, made from what the source tree holds: a file that moves takes its page along."""

import ast
import tomllib
from pathlib import Path
from typing import Any

FOLDER = "docs/api"
PUBLIC = "softdot"  # the package whose top-level names are promised to users
PUBLIC_PAGE = f"{FOLDER}/index.md"
PUBLIC_HEAD = f"""# Public names

`import {PUBLIC}` gives these names. They load on first use, so that the import itself costs nothing. Everything else
that the pages of the packages list may change from one release to the next. [Configuration](../configuration.md) lists
the keys of `Config`, and [Derivative][softdot.differentiation.Derivative] is what `derivatives` returns.
"""


def top_packages(root: Path) -> list[str]:
    """The packages that are installed, as pyproject.toml names them."""
    project = tomllib.loads((root / "pyproject.toml").read_text("utf-8"))
    return [pattern.rstrip("*") for pattern in project["tool"]["setuptools"]["packages"]["find"]["include"]]


def navigation(root: Path) -> list[Any]:
    """Entries of nav: the public names, then one section for each installed package with its packages."""
    sections = [{top: [{name: _page_of(name)} for name in packages(root, top)]} for top in top_packages(root)]
    return [{"Public names": PUBLIC_PAGE}, *sections]


def pages(root: Path) -> dict[str, str]:
    """The pages of the reference: name -> text in Markdown."""
    made = {PUBLIC_PAGE: _public_page(root)}
    for name in (name for top in top_packages(root) for name in packages(root, top)):
        made[_page_of(name)] = _package_page(root, name)
    return made


def packages(root: Path, top: str) -> list[str]:
    """A package and those inside it, dotted, in the order of the alphabet."""
    found = sorted((root / top).rglob("__init__.py"))
    return [".".join(path.parent.relative_to(root).parts) for path in found]


def _page_of(package: str) -> str:
    return f"{FOLDER}/{package}.md"


def _public_page(root: Path) -> str:
    tree = ast.parse((root / PUBLIC / "__init__.py").read_text("utf-8"))
    names: list[str] = next(
        ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"
    )
    public = sorted(name for name in names if not name.startswith("_"))
    shown = [_shown(root, f"{PUBLIC}.{name}", full_path=False, inherited_members="true") for name in public]
    return "\n".join([PUBLIC_HEAD, *shown])


def _shown(root: Path, name: str, full_path: bool, **more: str) -> str:
    """What mkdocstrings replaces by the documentation of a name.

    It follows a name into another package only where that was loaded before, hence the list of all of them.
    """
    options = {
        "heading_level": 2,
        "show_root_full_path": str(full_path).lower(),
        "preload_modules": f"[{', '.join(top_packages(root))}]",
        **more,
    }
    return "\n".join([f"::: {name}", "    options:", *(f"      {key}: {value}" for key, value in options.items()), ""])


def _package_page(root: Path, package: str) -> str:
    """What a package is for, a table of its modules, then the modules one by one."""
    folder = root.joinpath(*package.split("."))
    modules = {f"{package}.{path.stem}": _docstring(path) for path in sorted(folder.glob("[!_]*.py"))}
    rows = [f"| [`{name}`][{name}] | {_first_sentence(text)} |" for name, text in modules.items()]
    inside = [name for name in packages(root, package.replace(".", "/")) if name.count(".") == package.count(".") + 1]
    rows += [f"| [`{name}`]({name}.md) | {_first_sentence(_docstring(_init(root, name)))} |" for name in inside]
    table = ["| module or package | subject |", "|---|---|", *rows, ""] if rows else []
    shown = [_shown(root, name, full_path=True) for name in modules]
    return "\n".join([f"# {package}\n", _docstring(_init(root, package)) + "\n", *table, *shown])


def _init(root: Path, package: str) -> Path:
    return root.joinpath(*package.split("."), "__init__.py")


def _docstring(path: Path) -> str:
    return ast.get_docstring(ast.parse(path.read_text("utf-8"))) or ""


def _first_sentence(docstring: str) -> str:
    """The first paragraph on one line, as a cell of a table."""
    return " ".join(docstring.partition("\n\n")[0].split()).replace("|", "\\|")
