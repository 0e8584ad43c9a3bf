"""The arrangement of the parts of a kit side by side, as in kit.step."""

from collections.abc import Sequence
from dataclasses import replace

from geometry.fabrication.part import FabricationPart

PART_GAP_MM, ROW_LENGTH_MM = 5.0, 150.0


def side_by_side(parts: Sequence[FabricationPart]) -> list[FabricationPart]:
    """The parts in rows along x, their undersides at z = 0, in mm."""
    from build123d import Pos

    found, x, y, depth = [], 0.0, 0.0, 0.0
    for part in parts:
        box = part.solid.bounding_box()
        if x > 0.0 and x + box.size.X > ROW_LENGTH_MM:
            x, y, depth = 0.0, y + depth + PART_GAP_MM, 0.0
        moved = Pos(x - box.min.X, y - box.min.Y, -box.min.Z) * part.solid
        moved.label, moved.color = part.solid.label, part.solid.color
        found.append(replace(part, solid=moved))
        x, depth = x + box.size.X + PART_GAP_MM, max(depth, box.size.Y)
    return found
