"""From the files that instruments write to a folder that softdot diagnose reads. Names load on first use."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from softdot.convert.files import read_log, read_mat, read_sheet
    from softdot.convert.instruments import read_oscilloscope
    from softdot.convert.recording import run_text, white_noise, write_recording

_HOMES = {
    "read_log": "files",
    "read_mat": "files",
    "read_oscilloscope": "instruments",
    "read_sheet": "files",
    "run_text": "recording",
    "white_noise": "recording",
    "write_recording": "recording",
}
__all__ = ["read_log", "read_mat", "read_oscilloscope", "read_sheet", "run_text", "white_noise", "write_recording"]


def __getattr__(name: str) -> Any:
    """Import a public name from its home."""
    if name in _HOMES:
        return getattr(import_module(f"softdot.convert.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'softdot.convert' has no attribute '{name}'")
