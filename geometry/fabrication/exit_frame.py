"""A segment seen from its cable: x points to where the cable leaves. Lengths in millimetres."""

from dataclasses import dataclass
from typing import Any

from geometry.fabrication.parameters import Fabrication
from geometry.parameters import Segment

TURNS_DEG = {"+x": 0.0, "+y": 90.0, "-x": 180.0, "-y": 270.0}


@dataclass(frozen=True)
class ExitFrame:
    """along, across : sizes of the footprint in x (towards the cable) and y of this frame.

    count_along, count_across : segments of the array. turn_deg : about z, back into the segment's frame.
    """

    along: float
    across: float
    count_along: int
    count_across: int
    turn_deg: float

    def placed(self, solid: Any) -> Any:
        """A solid of this frame in the frame of the segment."""
        from build123d import Rot

        return Rot(0, 0, self.turn_deg) * solid


def exit_frame(segment: Segment, fabrication: Fabrication) -> ExitFrame:
    """The frame of fabrication.cable_exit."""
    sizes, counts = (segment.length_mm, segment.width_mm), fabrication.array
    if fabrication.cable_exit.endswith("y"):
        sizes, counts = (sizes[1], sizes[0]), (counts[1], counts[0])
    return ExitFrame(*sizes, *counts, TURNS_DEG[fabrication.cable_exit])
