"""A hash of the program as far as a result depends on it, derived from its imports, so that an edit forgets it."""

import hashlib
import os
import re
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

PROGRAM = Path(__file__).parents[1]
DATA = (".toml", ".csv")


@cache
def source_hash(module: str) -> str:
    """Of the program as far as a module depends on it: its own source, and that of all it imports, however indirectly.

    Imports inside functions and packages' __init__ count too, data files that a source names beside itself, and all
    modules of a package that finds its modules by walking through itself. Other distributions do not count.
    """
    modules, data = _files(PROGRAM)
    found: dict[Path, bytes] = {}
    waiting, seen = [module], {module}
    while waiting:
        path = modules.get(waiting.pop())
        if path is None or path in found:
            continue
        text, needed = _source(path)
        found[path] = text
        found |= {one: one.read_bytes() for one in data.get(path.parent, ()) if one.name.encode() in text}
        if "pkgutil.walk_packages" in needed:
            needed = needed | {name for name, one in modules.items() if path.parent in one.parents}
        waiting += needed - seen
        seen |= needed
    return hashlib.sha256(b"".join(found[path] for path in sorted(found))).hexdigest()


@cache
def _files(program: Path) -> tuple[dict[str, Path], dict[Path, list[Path]]]:
    """Every module of this distribution with its file, and the data files of each of its folders."""
    modules, data = dict[str, Path](), dict[Path, list[Path]]()
    for package in _packages(program):
        for folder, _, names in os.walk(program / package):
            dotted = Path(folder).relative_to(program).parts
            for path in (Path(folder, name) for name in names):
                if path.suffix == ".py":
                    modules[".".join(dotted if path.stem == "__init__" else (*dotted, path.stem))] = path
                elif path.suffix in DATA:
                    data.setdefault(path.parent, []).append(path)
    return modules, data


def _packages(program: Path) -> list[str]:
    """Of this distribution alone, as it may be installed among others; of a bare copy of the sources all there are."""
    try:
        return (distribution("softdot").read_text("top_level.txt") or "").split()
    except PackageNotFoundError:
        return [typed.parent.name for typed in program.glob("*/py.typed")]


@cache
def _source(path: Path) -> tuple[bytes, set[str]]:
    """A source and the names that it imports."""
    text = path.read_bytes()
    return text, imported_names(text.decode())


FROM = re.compile(r"^[ \t]*from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n#;]*)", re.MULTILINE)
IMPORT = re.compile(r"^[ \t]*import[ \t]+([^\n#;]*)", re.MULTILINE)
NAME = re.compile(r"([\w.]+)(?:[ \t]+as[ \t]+\w+)?")


def imported_names(source: str) -> set[str]:
    """Names that a source imports, with the packages that hold them; some may be no modules.

    By the look of its lines, in a tenth of the time of a syntax tree: a name too many does no harm.
    """
    names = {name for line in IMPORT.findall(source) for name in NAME.findall(line)}
    for module, taken in FROM.findall(source):
        names |= {module, *(f"{module}.{name}" for name in NAME.findall(re.sub(r"#.*", "", taken)))}
    parts = [name.split(".") for name in names]
    return {".".join(one[:count]) for one in parts for count in range(1, len(one) + 1)}
