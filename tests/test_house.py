"""How the house is built: which way imports go, how large files are, and that names lead somewhere."""

import ast
import re
from collections import Counter
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from mesh.options import MeshOptions

ROOT = Path(__file__).parents[1]
MAY_IMPORT = {
    "foundation": set(),
    "geometry": {"foundation"},
    "mesh": {"foundation", "geometry"},
    "solve": {"foundation", "geometry", "mesh"},
    "export": {"foundation", "geometry", "mesh", "solve"},
    "diagnose": {"foundation", "geometry", "solve"},
    "softdot": {"foundation", "geometry", "mesh", "solve", "export", "diagnose"},
}
FILES = [path for top in MAY_IMPORT for path in sorted((ROOT / top).rglob("*.py"))]
MOST_LINES, MOST_INIT_LINES = 400, 40
REMARK = "    ", "Equation, source and typical values: docs/"
HIDDEN_WORLD = ROOT / "softdot" / "studies" / "proof" / "world"  # knows nothing of the rest, so it has names of its own


@cache
def parsed(path):
    return ast.parse(path.read_text("utf-8"))


def imported(path):
    """Top packages that a file imports, inside functions too."""
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            yield node.module.partition(".")[0]


@pytest.mark.parametrize("top", MAY_IMPORT)
def test_imports_go_one_way(top):
    found = {name for path in FILES if path.is_relative_to(ROOT / top) for name in imported(path)}
    assert found & set(MAY_IMPORT) - {top} <= MAY_IMPORT[top]


def name_of(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


MODULES = {name_of(path) for path in FILES}


def needed(path):
    """Modules that a file imports, in functions too, with the packages that hold them; not those for types alone."""
    own = name_of(path)
    waiting = [parsed(path)]
    for node in waiting:
        if isinstance(node, ast.ImportFrom):
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            typing_only = isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
            waiting += node.orelse if typing_only else ast.iter_child_nodes(node)
            continue
        for name in names:
            parts = name.split(".")
            holders = (".".join(parts[:count]) for count in range(1, len(parts) + 1))
            yield from (holder for holder in holders if holder in MODULES and not f"{own}.".startswith(f"{holder}."))


def test_no_module_imports_itself_in_a_circle():
    """An import inside a function may wait for a heavy library, but not hide that two modules need each other."""
    TopologicalSorter({name_of(path): set(needed(path)) for path in FILES}).prepare()


def test_files_stay_small():
    lines = {path: len(path.read_text("utf-8").splitlines()) for path in FILES}
    most = {path: MOST_INIT_LINES if path.name == "__init__.py" else MOST_LINES for path in FILES}
    assert [path for path, count in lines.items() if count > most[path]] == []


def test_no_package_is_empty():
    """One that holds files of another kind, such as pages and templates, is not."""
    holders = {path.parent for path in FILES if path.name == "__init__.py"}
    assert [
        folder for folder in holders if not set(folder.iterdir()) - {folder / "__init__.py", folder / "__pycache__"}
    ] == []


def test_a_docstring_of_a_module_has_one_headline():
    """A second line that stands alone would be that of a second subject. A reference or an indented line is none."""
    texts = {path: (ast.get_docstring(parsed(path), clean=False) or "").rstrip().split("\n\n")[1:] for path in FILES}
    lone = {
        path: [text for text in more if "\n" not in text and not text.startswith(REMARK)]
        for path, more in texts.items()
    }
    assert {path: found for path, found in lone.items() if found} == {}


def test_no_class_name_occurs_twice():
    trees = (parsed(path) for path in FILES if not path.is_relative_to(HIDDEN_WORLD))
    names = Counter(node.name for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef))
    assert [name for name, count in names.items() if count > 1] == []


def test_modules_that_a_text_names_exist():
    """Dotted names in docstrings, messages and comments; a name inside a module must occur in its source."""
    named = {(path.name, name) for path in FILES for text in texts(path) for name in re.findall(DOTTED, text)}
    keys = {f"mesh.{key}" for key in MeshOptions.model_fields}
    assert {(file, name) for file, name in named if name not in keys and not leads_somewhere(name)} == set()


def test_files_that_a_text_names_exist():
    """By the end of their path; those that a program writes itself stand alone in a string."""
    held = [f"/{path.relative_to(ROOT)}" for top in (*MAY_IMPORT, "benchmarks") for path in (ROOT / top).rglob("*.py")]
    written = {text for path in FILES for text in strings(path) if text.endswith(".py") and " " not in text}
    named = {(path.name, name) for path in FILES for text in texts(path) for name in re.findall(r"[\w/]+\.py\b", text)}
    lost = {one for one in named if one[1] not in written and not any(path.endswith(f"/{one[1]}") for path in held)}
    assert lost == set()


DOTTED = rf"\b(?:{'|'.join(MAY_IMPORT)})(?:\.(?!md\b)[a-z_]+)+"


def texts(path):
    """Docstrings, messages and comments of a file."""
    return [text for text in strings(path) if " " in text] + re.findall(r"#.*", path.read_text("utf-8"))


@cache
def strings(path):
    constants = (node.value for node in ast.walk(parsed(path)) if isinstance(node, ast.Constant))
    return [value for value in constants if isinstance(value, str)]


def leads_somewhere(name):
    """Whether a dotted name is a package or module, or a name that a module holds."""
    place = ROOT.joinpath(*name.split("."))
    if place.is_dir() or place.with_suffix(".py").is_file():
        return True
    module = (
        place.parent.with_suffix(".py") if place.parent.with_suffix(".py").is_file() else place.parent / "__init__.py"
    )
    return module.is_file() and re.search(rf"\b{place.name}\b", module.read_text("utf-8")) is not None
