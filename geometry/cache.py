"""What softdot keeps on disk for itself, and the hashes that say what it depends on.

Each file ends with a SHA-256 of its content, so that damage is never believed: a damaged file is deleted and made
again. Arrays go into one .npz file without pickle; several processes may write and read it at once. What a kept thing
depends on in the program is derived from imports (source_hash), so that an edit forgets it.
"""

import hashlib
import json
import logging
import os
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import cache
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any, TypeVar

import numpy as np

from geometry.base import InputError
from geometry.files import whole_file

MARK = b"\nsoftdot sha256 "
TRAILER = len(MARK) + 64 + 1
PROGRAM = Path(__file__).parents[1]
DATA = (".toml", ".csv")


def folder() -> Path:
    """Where meshes are kept: SOFTDOT_CACHE, or the user's cache folder of this platform."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("SOFTDOT_CACHE") or user_cache_dir("softdot", appauthor=False))


def check_folder() -> None:
    """InputError where SOFTDOT_CACHE names a folder that cannot be made or written.

    The platform's own folder may be closed to this process; then nothing is kept.
    """
    stated = os.environ.get("SOFTDOT_CACHE")
    if not stated:
        return
    try:
        Path(stated).mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=stated):
            pass
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(
            f"SOFTDOT_CACHE = '{stated}': cannot be used as the folder of the cache ({reason}); name a folder that can "
            "be written, or unset it"
        ) from None


def write_kept(path: Path, content: bytes) -> None:
    """Write the file whole, in a folder that is made where it is missing. OSError when it cannot be written.

    Several processes may write and read it at once.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path, shared=True) as beside:
        beside.write_bytes(content + _trailer(content))


def read_kept(path: Path) -> bytes | None:
    """What was written. None when there is no file, or when it is damaged: then a warning says so and it is deleted."""
    try:
        whole = path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        logging.getLogger("softdot").warning("'%s' cannot be read (%s); it is made again", path, error.strerror)
        return None
    content = whole[:-TRAILER]
    if whole[-TRAILER:] == _trailer(content):
        return content
    logging.getLogger("softdot").warning("'%s' is damaged; it is deleted and made again", path)
    _delete(path)
    return None


def _trailer(content: bytes) -> bytes:
    return MARK + hashlib.sha256(content).hexdigest().encode() + b"\n"


def _delete(path: Path) -> None:
    """Remove the file; where that is not allowed, its checksum still keeps it from being believed."""
    try:
        path.unlink(missing_ok=True)
    except OSError:
        return


Content = TypeVar("Content")


def write_arrays(path: Path, arrays: Mapping[str, Any], compressed: bool = False) -> None:
    """Write the file whole, in a folder that is made where it is missing. OSError when it cannot be written."""
    buffer = BytesIO()
    (np.savez_compressed if compressed else np.savez)(buffer, **arrays)
    write_kept(path, buffer.getvalue())


def read_arrays(path: Path, decoded: Callable[[Mapping[str, Any]], Content]) -> Content | None:
    """What decoded makes of the arrays; None when there is no file, it is damaged or decoded finds it wrong.

    decoded : says so by KeyError, TypeError or ValueError; the checksum leaves only another program's file for that.
    """
    content = read_kept(path)
    if content is None:
        return None
    try:
        with np.load(BytesIO(content), allow_pickle=False) as data:
            return decoded(data)
    except (ValueError, KeyError, TypeError):
        return None


def data_hash(content: Any) -> str:
    """Of what JSON can hold, whatever the order of its keys."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


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


def recall(name: str) -> Any | None:
    """The plain data remembered under a name, None when nothing was or the file is damaged."""
    content = read_kept(folder() / f"{name}.json")
    return None if content is None else json.loads(content)


def remember(name: str, value: Any) -> None:
    """Keep plain data, to the last digit; a cache that cannot be written is no cache."""
    text = json.dumps(value, indent=2, allow_nan=False, ensure_ascii=False)
    with suppress(OSError):
        write_kept(folder() / f"{name}.json", text.encode())


CHECKSUM = "sha256"
"""Key of the SHA-256 of all the others, as canonical JSON."""


def write_checked(path: Path, record: dict[str, Any]) -> None:
    """Write a record of plain data and its checksum to the last digit, whole or not at all."""
    text = json.dumps({**record, CHECKSUM: data_hash(record)}, indent=2, allow_nan=False, ensure_ascii=False)
    with whole_file(path) as beside:
        beside.write_text(text + "\n", "utf-8")


def read_checked(path: Path, consequence: str) -> dict[str, Any] | None:
    """What was written. None without a file, and for a damaged one: then a warning says so, and it is deleted.

    consequence : what follows from that, for the warning.
    """
    try:
        record = json.loads(path.read_bytes())
        if record.pop(CHECKSUM, None) == data_hash(record):
            return dict(record)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, AttributeError, TypeError, RecursionError):
        pass
    logging.getLogger("softdot").warning("'%s' is damaged; it is deleted and %s", path, consequence)
    with suppress(OSError):
        path.unlink()
    return None
