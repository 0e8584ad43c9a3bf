"""Designs on disk: each change of a tab is kept, so that neither a crash nor a closed tab loses one."""

import os
import re
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from foundation.files import read_text, write_whole_text
from softdot.studio.starts import sizes, title

MOST_DESIGNS = 50
NAME = re.compile(r"[a-z0-9]{1,40}")


def folder() -> Path:
    """SOFTDOT_STUDIO, or softdot/studio in the user's data folder of this platform."""
    from platformdirs import user_data_path

    stated = os.environ.get("SOFTDOT_STUDIO")
    return Path(stated) if stated else user_data_path("softdot", appauthor=False) / "studio"


class Autosave:
    """The designs in a folder of this user alone; one file for each tab, the oldest are forgotten."""

    def __init__(self, place: Path) -> None:
        self._place = place

    def save(self, name: str, text: str) -> str | None:
        """Replace the design of a tab, whole. The sentence that says why it could not be saved, None where it was."""
        try:
            self._place.mkdir(parents=True, exist_ok=True, mode=0o700)
            write_whole_text(self._file(name), text)
        except OSError as error:
            reason = error.strerror or type(error).__name__
            return f"This design is not saved: {self._place} cannot be written ({reason}). Save it as a file."
        return None

    def load(self, name: str) -> str | None:
        """The design of a tab, None where there is none. InputError for a name that none of ours is."""
        file = self._file(name)
        return read_text(file, "the saved design") if file.is_file() else None

    def earlier(self, without: set[str]) -> list[dict[str, Any]]:
        """Name, time (seconds since 1970), title and sizes of the designs of other tabs, newest first; forgets the
        oldest.
        """
        found = sorted(self._place.glob("*.toml"), key=lambda file: -file.stat().st_mtime)
        for file in found[MOST_DESIGNS:]:
            file.unlink(missing_ok=True)
        kept = [file for file in found[:MOST_DESIGNS] if file.stem not in without]
        return [{"name": file.stem, "saved_s": file.stat().st_mtime, **_told(file)} for file in kept]

    def _file(self, name: str) -> Path:
        if not NAME.fullmatch(name):
            raise InputError("there is no such saved design")
        return self._place / f"{name}.toml"


def _told(file: Path) -> dict[str, Any]:
    """By what a design is told from the others: its first comment, and its sizes for a sketch."""
    text = ""
    with suppress(OSError):
        text = file.read_text("utf-8", "replace")
    return {"title": title(text), "sizes": sizes(text)}


def new_name() -> str:
    """Of a tab: when it was opened, and something that no other has."""
    return f"{time.strftime('%Y%m%dt%H%M%S')}{os.urandom(4).hex()}"
