"""The decoders by name, and their common input from the voltages."""

from collections.abc import Callable

from foundation.errors import InputError
from softdot.reading.decoders import learned, model, threshold
from softdot.reading.decoders.model import DecodedCells
from softdot.reading.decoders.pressing import PressedCells, pressed_cells
from softdot.reading.decoders.track import Track, track_slide
from softdot.reading.voltages import Reader, Voltages, without_mains

Decoder = Callable[[Reader, Track | PressedCells], DecodedCells]
DECODERS: dict[str, Decoder] = {
    "model": model.decode,
    "threshold": threshold.decode,
    "learned": learned.decode,
}


def named_decoders(names: str) -> list[str]:
    """The names of decoders in a text, separated by commas. InputError for an unknown one."""
    found = list(dict.fromkeys(name.strip() for name in names.split(",")))
    for name in found:
        if name not in DECODERS:
            raise InputError(f"--decoders = '{names}': '{name}' is none of {', '.join(DECODERS)}")
    return found


def decoder_input(reader: Reader, heard: Voltages) -> Track | PressedCells:
    """The input of all decoders: the track of a slide, or the charges of presses. InputError without a signal."""
    return track_slide(reader, heard) if reader.presses is None else pressed_cells(reader, without_mains(heard))
