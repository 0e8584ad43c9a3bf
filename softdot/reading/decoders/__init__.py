"""The decoders by name, and what they see of the voltages."""

from collections.abc import Callable

from foundation.errors import InputError
from softdot.reading.decoders import learned, model, threshold
from softdot.reading.decoders.fitted import Track
from softdot.reading.decoders.model import DecodedCells
from softdot.reading.decoders.pressing import PressedCells, pressed
from softdot.reading.decoders.track import tracked
from softdot.reading.voltages import Reader, Voltages, without_mains

Decoder = Callable[[Reader, Track | PressedCells], DecodedCells]
DECODERS: dict[str, Decoder] = {
    "model": model.decode,
    "threshold": threshold.decode,
    "learned": learned.decode,
}


def named_decoders(names: str) -> list[str]:
    """Names of decoders, separated by commas. InputError for one that is none."""
    found = list(dict.fromkeys(name.strip() for name in names.split(",")))
    for name in found:
        if name not in DECODERS:
            raise InputError(f"--decoders = '{names}': '{name}' is none of {', '.join(DECODERS)}")
    return found


def seen_of(reader: Reader, heard: Voltages) -> Track | PressedCells:
    """What all decoders begin with. InputError where there is nothing to read."""
    quiet = without_mains(heard)
    return tracked(reader, quiet) if reader.presses is None else pressed(reader, quiet)
