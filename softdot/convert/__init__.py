"""From the files that instruments write to a folder that softdot diagnose reads. Names load on first use."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from softdot.convert.matlab import read_mat
    from softdot.convert.oscilloscope import read_oscilloscope
    from softdot.convert.rig_text import run_text
    from softdot.convert.sheet import read_sheet
    from softdot.convert.white import white_noise
    from softdot.convert.write import write_recording

_HOMES = {
    "read_mat": "matlab",
    "read_oscilloscope": "oscilloscope",
    "read_sheet": "sheet",
    "run_text": "rig_text",
    "white_noise": "white",
    "write_recording": "write",
}
__all__ = ["read_mat", "read_oscilloscope", "read_sheet", "run_text", "white_noise", "write_recording"]


def __getattr__(name: str) -> Any:
    """Import a public name from its home."""
    if name in _HOMES:
        return getattr(import_module(f"softdot.convert.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'softdot.convert' has no attribute '{name}'")
