"""What a browser sends: bounded in size and number, and never written outside its own folder."""

import io
import json
import re
import stat
import zipfile
from collections.abc import Iterable
from pathlib import Path, PurePosixPath
from typing import IO

from foundation.errors import InputError

LARGEST_MB = 25.0
"""Of one upload, as it is sent."""
LARGEST_UNPACKED_MB = 100.0
MOST_FILES = 500
ENDINGS = {".toml", ".csv"}
PART = re.compile(r"[\w .,()+=@°µ-]{1,120}")
CHUNK = 1 << 20


def unpack(sent: Iterable[tuple[str, bytes]], folder: Path) -> Path:
    """Write the files of a recording into an empty folder and return the one that holds rig.toml.

    sent : name and content of each file, or of one zip file. InputError for anything else than TOML and CSV files below
    that folder, for too many of them, or too large ones.
    """
    files = list(sent)
    if len(files) == 1 and files[0][1][:4] == b"PK\x03\x04":
        _unzip(files[0][1], folder)
    else:
        _refuse_many(len(files))
        for name, content in files:
            if _wanted(name):
                _write(_place(name, folder), content)
    found = sorted(folder.rglob("rig.toml"), key=lambda file: len(file.parts))
    if not found:
        raise InputError("what was sent holds no rig.toml: send the folder of a recording, or a zip file of it")
    return found[0].parent


def _unzip(content: bytes, folder: Path) -> None:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            wanted = [one for one in archive.infolist() if not one.is_dir() and _wanted(one.filename)]
            _refuse_many(len(wanted))
            room = LARGEST_UNPACKED_MB * 1e6
            for one in wanted:
                if stat.S_ISLNK(one.external_attr >> 16):
                    raise InputError(f"'{_short(one.filename)}': a zip file with links is not read")
                place = _place(one.filename, folder)
                with archive.open(one) as stream:
                    room -= _copy(stream, place, room)
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError("this zip file is damaged, encrypted or packed in a way that is not read") from None


def _copy(stream: IO[bytes], place: Path, room: float) -> int:
    """Bytes that were written; what a zip file claims of its sizes is not believed."""
    total = 0
    place.parent.mkdir(parents=True, exist_ok=True)
    with place.open("xb") as out:
        while chunk := stream.read(CHUNK):
            total += len(chunk)
            if total > room:
                raise InputError(f"the files have more than {LARGEST_UNPACKED_MB:.0f} MB, which is not read")
            out.write(chunk)
    return total


def _write(place: Path, content: bytes) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    try:
        with place.open("xb") as out:
            out.write(content)
    except OSError as error:
        raise InputError(f"'{place.name}': cannot be written ({error.strerror})") from None


def _refuse_many(count: int) -> None:
    if count > MOST_FILES:
        raise InputError(f"{count} files were sent, at most {MOST_FILES} are read")


def _wanted(name: str) -> bool:
    """Other files of a folder, pictures say, are left out; hidden ones too."""
    path = PurePosixPath(name.replace("\\", "/"))
    return path.suffix.lower() in ENDINGS and not path.name.startswith(".") and "__MACOSX" not in path.parts


def _place(name: str, folder: Path) -> Path:
    """Where a file goes. InputError for a name that leads out of the folder, or that no file of a lab has."""
    path = PurePosixPath(name.replace("\\", "/"))
    parts = path.parts
    if path.is_absolute() or ".." in parts or ":" in name or not all(PART.fullmatch(part) for part in parts):
        raise InputError(f"'{_short(name)}': this name of a file is not allowed")
    place = folder.joinpath(*parts)
    if not place.resolve().is_relative_to(folder.resolve()):
        raise InputError(f"'{_short(name)}': this name of a file is not allowed")
    return place


def _short(name: str) -> str:
    return "".join(character if character.isprintable() else "?" for character in name[:60])


def split(body: bytes) -> list[tuple[str, bytes]]:
    """Name and content of each file of an upload. InputError."""
    head, _, rest = body.partition(b"\n")
    try:
        listed = [(str(name), int(size)) for name, size in json.loads(head)]
    except (ValueError, TypeError, RecursionError):
        raise InputError("the upload is not in the form in which the page sends it") from None
    if any(size < 0 for _, size in listed) or sum(size for _, size in listed) != len(rest):
        raise InputError("the upload is not as long as it says")
    found, at = [], 0
    for name, size in listed:
        found.append((name, rest[at : at + size]))
        at += size
    return found
