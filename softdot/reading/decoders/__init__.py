"""The decoders by name, and what they begin with."""

from collections.abc import Callable

from foundation.errors import InputError
from softdot.reading.decoders import learned, model, threshold
from softdot.reading.decoders.fitted import Track
from softdot.reading.decoders.model import DecodedCells
from softdot.reading.decoders.pressing import PressedCells, pressed_cells
from softdot.reading.decoders.track import track_slide
from softdot.reading.voltages import Reader, Voltages, without_mains

Decoder = Callable[[Reader, Track | PressedCells], DecodedCells]
DECODERS: dict[str, Decoder] = {
    "model": model.decode,
    "threshold": threshold.decode,
    "learned": learned.decode,
}
HAND = "hand"
"""The decoder that finds its own track (softdot.reading.decoders.hand)."""


def named_decoders(names: str) -> list[str]:
    """The names of decoders in a text, separated by commas. InputError for an unknown one."""
    found = list(dict.fromkeys(name.strip() for name in names.split(",")))
    for name in found:
        if name not in (*DECODERS, HAND):
            raise InputError(f"--decoders = '{names}': '{name}' is none of {', '.join((*DECODERS, HAND))}")
    return found


def decoder_input(reader: Reader, heard: Voltages) -> Track | PressedCells:
    """The input of all decoders but HAND: the track of a slide, or the charges of presses. InputError without a
    signal.
    """
    quiet = without_mains(heard)
    return track_slide(reader, quiet) if reader.presses is None else pressed_cells(reader, quiet)
