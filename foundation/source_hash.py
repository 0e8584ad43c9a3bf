"""A hash of the program as far as a result depends on it, derived from its imports, so that an edit forgets it."""

import hashlib
import os
import re
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

PROGRAM_FOLDER = Path(__file__).parents[1]
DATA_SUFFIXES = (".toml", ".csv")


@cache
def source_hash(module: str) -> str:
    """Return the SHA-256 of a module's source and of all that it imports, however indirectly.

    Imports inside functions and packages' __init__ count too, data files that a source names beside itself, and all
    modules of a package that finds its modules by walking through itself. Other distributions do not count.
    """
    modules, data = _program_files(PROGRAM_FOLDER)
    found: dict[Path, bytes] = {}
    waiting, seen = [module], {module}
    while waiting:
        path = modules.get(waiting.pop())
        if path is None or path in found:
            continue
        text, needed = _source_and_imports(path)
        found[path] = text
        found |= {one: one.read_bytes() for one in data.get(path.parent, ()) if one.name.encode() in text}
        if "pkgutil.walk_packages" in needed:
            needed = needed | {name for name, one in modules.items() if path.parent in one.parents}
        waiting += needed - seen
        seen |= needed
    return hashlib.sha256(b"".join(found[path] for path in sorted(found))).hexdigest()


@cache
def _program_files(program: Path) -> tuple[dict[str, Path], dict[Path, list[Path]]]:
    """Return every module of this distribution with its file, and the data files of each of its folders."""
    modules, data = dict[str, Path](), dict[Path, list[Path]]()
    for package in _package_names(program):
        for folder, _, names in os.walk(program / package):
            dotted = Path(folder).relative_to(program).parts
            for path in (Path(folder, name) for name in names):
                if path.suffix == ".py":
                    modules[".".join(dotted if path.stem == "__init__" else (*dotted, path.stem))] = path
                elif path.suffix in DATA_SUFFIXES:
                    data.setdefault(path.parent, []).append(path)
    return modules, data


def _package_names(program: Path) -> list[str]:
    """Return the top packages of this program: those of its distribution where others lie beside them, else all there
    are, since the distribution of a working copy does not know a package that is newer than its installation.
    """
    alone = [typed.parent.name for typed in program.glob("*/py.typed")]
    if (program / "pyproject.toml").is_file():
        return alone
    try:
        return (distribution("softdot").read_text("top_level.txt") or "").split()
    except PackageNotFoundError:
        return alone


@cache
def _source_and_imports(path: Path) -> tuple[bytes, set[str]]:
    """Return the bytes of a source and the names that it imports."""
    text = path.read_bytes()
    return text, imported_names(text.decode())


FROM_IMPORT = re.compile(r"^[ \t]*from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n#;]*)", re.MULTILINE)
PLAIN_IMPORT = re.compile(r"^[ \t]*import[ \t]+([^\n#;]*)", re.MULTILINE)
IMPORTED_NAME = re.compile(r"([\w.]+)(?:[ \t]+as[ \t]+\w+)?")


def imported_names(source: str) -> set[str]:
    """Return the names that a source imports, with the packages that hold them; some may be no modules.

    Regular expressions find them in a tenth of the time of a syntax tree; a name too many does no harm.
    """
    names = {name for line in PLAIN_IMPORT.findall(source) for name in IMPORTED_NAME.findall(line)}
    for module, taken in FROM_IMPORT.findall(source):
        names |= {module, *(f"{module}.{name}" for name in IMPORTED_NAME.findall(re.sub(r"#.*", "", taken)))}
    parts = [name.split(".") for name in names]
    return {".".join(one[:count]) for one in parts for count in range(1, len(one) + 1)}
