"""Files and folders appear whole or not at all: written beside, then renamed."""

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from geometry.whole_file import whole_file


@contextmanager
def whole_folder(folder: Path) -> Iterator[Path]:
    """Yield a temporary folder beside ``folder`` that takes its place when the block ends without error.

    A folder of that name from an earlier run is replaced; after an error it is untouched.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    scratch = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        new, old = scratch / "new", scratch / "old"
        new.mkdir()
        yield new
        if folder.exists():
            folder.rename(old)
        new.rename(folder)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def write_whole_text(path: Path, text: str) -> None:
    """Write a UTF-8 text file that never exists half-written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path, shared=True) as beside:
        beside.write_text(text, "utf-8")
