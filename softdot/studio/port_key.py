"""The key of a port, kept for a while so that a tab finds the studio again that is started anew."""

import os
import re
import time
from contextlib import suppress
from pathlib import Path

from foundation.files import write_whole_text
from softdot.studio.guard import new_key

LONGEST_KEPT_S = 600.0
"""After the end of a studio; later its key is worth nothing."""
KEY = re.compile(r"[\w-]{43}")


class PortKey:
    """Keys in a folder that only this user can read, one file for each port, renewed while the studio runs."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def last_port(self) -> int:
        """The port that a studio had a short time ago; 0 where there is none."""
        found = [file for file in self._folder.glob("*.key") if file.stem.isdecimal() and self._is_young(file)]
        return int(max(found, key=lambda file: file.stat().st_mtime).stem) if found else 0

    def take(self, port: int) -> str:
        """The key of a port: that of a short time ago, where nobody else can have written or read it; else a new one.

        A folder that cannot be written leaves the key with this start alone.
        """
        file = self._file(port)
        key = self._read(file) or new_key()
        with suppress(OSError):
            for folder in (self._folder.parent, self._folder):
                folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            write_whole_text(file, key)
            file.chmod(0o600)
        return key

    def renew(self, port: int) -> None:
        """The studio runs still."""
        with suppress(OSError):
            os.utime(self._file(port))

    def _file(self, port: int) -> Path:
        return self._folder / f"{port}.key"

    def _read(self, file: Path) -> str | None:
        try:
            state, text = file.stat(), file.read_text("ascii")
        except (OSError, ValueError):
            return None
        own = not hasattr(os, "getuid") or (state.st_uid == os.getuid() and state.st_mode & 0o077 == 0)
        return text if own and self._is_young(file) and KEY.fullmatch(text) else None

    def _is_young(self, file: Path) -> bool:
        with suppress(OSError):
            return 0.0 <= time.time() - file.stat().st_mtime + 1.0 <= LONGEST_KEPT_S
        return False
