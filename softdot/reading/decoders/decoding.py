"""All decoders that are asked for, each with what it begins with."""

from collections.abc import Callable

from foundation.errors import InputError
from softdot.reading.decoders import DECODERS, HAND, decoder_input, hand
from softdot.reading.decoders.fitted import Track
from softdot.reading.decoders.hand import HandTrack, track_hand
from softdot.reading.decoders.model import DecodedCells
from softdot.reading.decoders.pressing import PressedCells
from softdot.reading.voltages import Reader, Voltages

Seen = Track | PressedCells | HandTrack


def decoded(
    reader: Reader, heard: Voltages, names: list[str], told: Callable[[int], None]
) -> tuple[Seen, dict[str, DecodedCells]]:
    """What the first decoder has seen, and the cells of each by its name. told : with the number of those done.

    InputError without a signal, and for presses that HAND should read.
    """
    if HAND in names and reader.presses is not None:
        raise InputError(f"--decoders: '{HAND}' reads slides; leave it out with --mode press")
    common = None if names == [HAND] else decoder_input(reader, heard)
    by_hand = track_hand(reader, heard) if HAND in names else None
    found = {}
    for number, name in enumerate(names, 1):
        if name == HAND:
            assert by_hand is not None
            found[name] = hand.decode(by_hand)
        else:
            assert common is not None
            found[name] = DECODERS[name](reader, common)
        told(number)
    seen = by_hand if names[0] == HAND else common
    assert seen is not None
    return seen, found
