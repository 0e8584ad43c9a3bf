"""softdot studio: the page of a design on this machine, until Ctrl-C."""

import os
import sys
import webbrowser
from argparse import Namespace
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from tempfile import mkdtemp

from foundation.errors import InputError
from foundation.files import read_text
from softdot.console import GOOD
from softdot.log import warn

LOOPBACK = ("127.0.0.1", "localhost", "::1")
REDIRECT = """<!doctype html><meta charset="utf-8"><meta name="referrer" content="no-referrer">
<title>softdot studio</title><meta http-equiv="refresh" content="0; url={address}">"""


def command(chosen: Namespace) -> int:
    """Serve the page of chosen.config until Ctrl-C or SIGTERM. InputError."""
    try:
        from softdot.studio.server import run
    except ImportError as error:
        if error.name != "tornado":
            raise
        raise InputError("softdot studio needs more than softdot alone: pip install 'softdot[studio]'") from None
    if not 0 <= chosen.port <= 65535:
        raise InputError(f"--port = {chosen.port}: must be between 0 and 65535; 0 takes a free one")
    if chosen.host in ("0.0.0.0", "::", ""):
        raise InputError(f"--host {chosen.host}: name one address of this machine, under which alone the page answers")
    start = start_text(chosen.config)
    if chosen.host not in LOOPBACK:
        warn([f"--host {chosen.host}: other machines can reach the page, and what is sent is not encrypted"])
    if chosen.family is not None:
        from softdot.families.folder import load_family

        load_family(chosen.family)
        chosen.family = str(Path(chosen.family).resolve())
    opened: list[Path] = []

    def ready(address: str) -> None:
        print(f"softdot studio: {address}\nCtrl-C ends it.", flush=True)
        if not chosen.no_browser:
            opened.append(_open(address))

    try:
        run(chosen.host, chosen.port, start, ready, chosen.family)
    finally:
        for place in opened:
            with suppress(OSError):
                place.unlink()
                place.parent.rmdir()
    print("softdot studio: ended; designs are kept", file=sys.stderr)
    return GOOD


def start_text(config: str | None) -> str:
    """The text of a configuration file, or of the default design. InputError."""
    if config is None:
        return files("softdot.config").joinpath("default.toml").read_text("utf-8")
    return read_text(Path(config), f"configuration '{config}'")


def _open(address: str) -> Path:
    """Open the page in a browser by a file that only this user can read: other users see the arguments of a browser."""
    place = Path(mkdtemp(prefix="softdot-studio-")) / "open.html"
    descriptor = os.open(place, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(REDIRECT.format(address=address))
    webbrowser.open(place.as_uri())
    return place
