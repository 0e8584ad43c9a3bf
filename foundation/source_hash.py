"""A hash of the program as far as a result depends on it, derived from its imports, so that an edit forgets it."""

import hashlib
import re
from functools import cache
from pathlib import Path

PROGRAM = Path(__file__).parents[1]
DATA = (".toml", ".csv")


@cache
def source_hash(module: str) -> str:
    """Of the program as far as a module depends on it: its own source, and that of all it imports, however indirectly.

    Imports inside functions and packages' __init__ count too, data files that a source names beside itself, and all
    modules of a package that finds its modules by walking through itself.
    """
    found: dict[Path, bytes] = {}
    waiting, seen = [module], {module}
    while waiting:
        path = _source_path(waiting.pop())
        if path is None or path in found:
            continue
        found[path], needed, data = _source(path)
        waiting += needed - seen  # most are named by many sources, and to look for a file takes long
        seen |= needed
        found |= data
    return hashlib.sha256(b"".join(found[path] for path in sorted(found))).hexdigest()


def _source(path: Path) -> tuple[bytes, set[str], dict[Path, bytes]]:
    """A source, the modules that it needs, and the data files that it names."""
    text = path.read_bytes()
    imported = imported_names(text.decode())
    needed = imported | (_modules_below(path.parent) if "pkgutil.walk_packages" in imported else set())
    beside = (data for data in path.parent.iterdir() if data.suffix in DATA and data.name.encode() in text)
    return text, needed, {data: data.read_bytes() for data in beside}


def _source_path(module: str) -> Path | None:
    """The file of a module of this program, None for a name that is none."""
    path = PROGRAM.joinpath(*module.split("."))
    return next((one for one in (path.with_suffix(".py"), path / "__init__.py") if one.is_file()), None)


def _modules_below(folder: Path) -> set[str]:
    """Dotted names of all modules in a folder of this program, however deep."""
    return {".".join(path.relative_to(PROGRAM).with_suffix("").parts) for path in folder.rglob("*.py")}


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
