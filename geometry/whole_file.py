"""Files appear whole or not at all: written beside their place, then renamed."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def whole_file(path: Path, shared: bool = False) -> Iterator[Path]:
    """Yield where to write; that file takes the place of path when the block ends without an exception.

    After any exception, Ctrl-C too, nothing is left beside path. A process that was killed leaves .NAME.part.
    shared : several processes may write path at once, so each one writes beside under a name of its own.
    """
    own = f".{os.urandom(8).hex()}" if shared else ""
    beside = path.with_name(f".{path.name}{own}.part")
    try:
        yield beside
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)
