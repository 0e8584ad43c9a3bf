"""Purpose and look of each layer of a cut file, and how a size is written."""

from typing import NamedTuple

from geometry.flat.pattern import LayerName


class Style(NamedTuple):
    """Look of a layer. purpose : one phrase. colour : red, green, blue, 0 to 255. weight : of its lines, 0.01 mm."""

    purpose: str
    colour: tuple[int, int, int]
    weight: int


STYLES: dict[LayerName, Style] = {
    "CUT": Style("cut through; the kerf is compensated", (210, 30, 30), 18),
    "ELECTRODE-TOP": Style("edge of the metal on the face towards the dot", (200, 120, 0), 13),
    "ELECTRODE-BOTTOM": Style("edge of the metal on the other face, seen from above", (30, 90, 190), 13),
    "ENGRAVE": Style("marks, to be engraved or written", (40, 130, 60), 9),
    "DIMENSION": Style("sizes of the finished part; not to be cut", (110, 110, 110), 5),
}


def size_text(length_mm: float) -> str:
    """A size for a drawing, to a hundredth of a millimetre."""
    return f"{length_mm:.2f}".rstrip("0").rstrip(".")
