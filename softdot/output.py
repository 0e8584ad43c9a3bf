"""The output folder: checked before any work, filled beside its place, and put there whole."""

import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from foundation.errors import InputError
from foundation.scratch_folders import lock_folder, sweep_folder, unlock_folder
from softdot.log import LOG_FILE, log_file
from softdot.no_room import refuse_cut_files, refuse_full_disk


@dataclass(frozen=True)
class Product:
    """The files that one command writes: entries of its folder, and the JSON file among them that names the format."""

    format: str
    summary: str
    entries: frozenset[str]

    @property
    def files(self) -> frozenset[str]:
        """The entries and the log."""
        return self.entries | {LOG_FILE}


RUN = Product(
    "softdot-run/1",
    "summary.json",
    frozenset({"summary.json", "report.html", "cad", "mesh", "results", "pictures"}),
)


@contextmanager
def staged_folder(out: Path, product: Product) -> Iterator[Path]:
    """An empty folder beside out that takes its place when the block ends without an exception.

    A folder of an earlier product of the same kind is replaced. InputError, before the block starts, when out is a
    file, cannot be written, holds anything else or is written by another process at this moment. After any exception,
    Ctrl-C too, nothing is left; the leavings of a killed process are removed by the next one.
    """
    place = check_output(out, product)
    made = _make_parents(place)
    staging, held = _make_staging(out, place, made)
    try:
        with log_file(staging / LOG_FILE):
            yield staging
        refuse_cut_files(staging)
        _publish(staging, place, product)
        made = []
    except Exception as error:
        try:
            refuse_full_disk(staging)
        except OSError as full:  # what a library raised when it could not write says less
            raise OSError(full.errno, full.strerror, str(place)) from error
        raise
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        unlock_folder(held)
        _remove_empty(made)


def _staging_name(place: Path) -> str:
    """The name of the staging folder, the same for all processes: the one that holds that folder writes."""
    return f".{place.name}.softdot"


def check_output(out: Path, product: Product) -> Path:
    """The real path of out. InputError unless it is absent, empty or the folder of an earlier such product."""
    try:
        place = out.resolve()
        _require_folder(out, place)
        entries = {entry.name for entry in place.iterdir()} if place.exists() else set()
    except (OSError, RuntimeError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"output '{out}': cannot be read ({reason})") from None
    foreign = sorted(entries - product.files - {_staging_name(place)})
    if foreign or (entries and not _is_earlier(place, product)):
        found = foreign[0] if foreign else sorted(entries)[0]
        raise InputError(f"output '{out}': holds '{found}', which softdot did not write; name a new or empty folder")
    return place


def _require_folder(out: Path, place: Path) -> None:
    """InputError unless the nearest existing path on the way to out is a folder."""
    existing = next(path for path in (place, *place.parents) if path.exists())
    if existing.is_dir():
        return
    what = "this" if existing == place else f"'{existing}'"
    raise InputError(f"output '{out}': {what} is a file, a folder is needed")


def _is_earlier(folder: Path, product: Product) -> bool:
    try:
        summary = json.loads((folder / product.summary).read_text("utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(summary, dict) and summary.get("format") == product.format


def _make_parents(out: Path) -> list[Path]:
    """Create the folders above out; return those that were missing, innermost first."""
    missing = [parent for parent in out.parents if not parent.exists()]
    made: list[Path] = []
    for parent in reversed(missing):
        try:
            parent.mkdir()
        except OSError as error:
            _remove_empty(made)
            raise InputError(f"output '{out}': '{parent}' cannot be created ({error.strerror})") from None
        made.insert(0, parent)
    return made


def _make_staging(out: Path, place: Path, made: list[Path]) -> tuple[Path, int | None]:
    """A new folder beside the place, or inside it where only that can be written, and the lock on it."""
    reason = None
    for parent in [place.parent, *([place] if place.is_dir() else [])]:
        if not os.access(parent, os.W_OK):
            reason = reason or "Permission denied"
            continue
        staging = parent / _staging_name(place)
        try:
            _recover(staging, place)
            staging.mkdir()
            held = lock_folder(staging)
        except FileExistsError:
            raise _in_use(out, staging) from None
        except OSError as error:
            reason = error.strerror
            continue
        if held is None:
            raise _in_use(out, staging)
        return staging, held
    _remove_empty(made)
    raise InputError(f"output '{out}': not writable ({reason})")


def _in_use(out: Path, staging: Path) -> InputError:
    return InputError(
        f"output '{out}': another softdot process is writing it; wait for it, name another folder, or remove "
        f"'{staging}' if there is none"
    )


def _recover(staging: Path, place: Path) -> None:
    """Remove what a killed process left, and put back an earlier result that it left beside its place."""
    old = _set_aside_path(staging)
    if staging.exists():
        sweep_folder(staging)
    if old.exists() and not staging.exists():
        shutil.rmtree(old, ignore_errors=True) if place.exists() else old.rename(place)


def _set_aside_path(staging: Path) -> Path:
    """The path of the earlier result while the new one takes its place."""
    return staging.with_name(f"{staging.name}-old")


def _publish(staging: Path, out: Path, product: Product) -> None:
    """Put the staged folder in its place, by renaming where the file system allows it."""
    old = _set_aside_path(staging)
    if staging.parent == out or out.is_mount() or Path.cwd().is_relative_to(out):
        _replace_entries(staging, out, product)
        return
    if out.exists():
        out.rename(old)
    try:
        staging.rename(out)
    except BaseException:
        if old.exists():
            old.rename(out)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _replace_entries(staging: Path, out: Path, product: Product) -> None:
    """Replace the content of a mount point or of the working folder, which keep their place, the summary last."""
    for name in product.files:
        with suppress(FileNotFoundError):
            path = out / name
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    for path in sorted(staging.iterdir(), key=lambda entry: entry.name == product.summary):
        shutil.move(path, out / path.name)


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        with suppress(OSError):
            folder.rmdir()
