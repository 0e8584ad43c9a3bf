"""An interface that has come apart, in a patch at its centre or from its rim inwards."""

from collections.abc import Iterator, Sequence
from math import hypot, sqrt
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import GIVES_WAY, Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.boundaries.delamination import DELAMINATION

LARGEST_PATCH = 0.9  # of the width
LEAST_BONDED = 0.05  # of the width, between a patch and a rim
RIM_NODES = (0.2 * LARGEST_PATCH, 0.5 * LARGEST_PATCH, LARGEST_PATCH)


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for every bond that the stack has."""
    yield from (_delamination(scene, bond) for bond in scene.bonds)


def _delamination(scene: Scene, bond: str) -> Candidate:
    """A patch at the centre by its share of the area, and a rim by its share of the way to the centre.

    In a slice both are shares of the length. In a solid the rim begins at the corners.
    """
    segment = scene.model.segment
    solid = segment.section == "solid"
    width = min(segment.length_mm, segment.width_mm) if solid else segment.length_mm
    most = LARGEST_PATCH**2 if solid else LARGEST_PATCH
    nodes = (0.2 * most, 0.5 * most, most)
    corners = hypot(segment.length_mm, segment.width_mm) if solid else width
    coordinates = (
        Coordinate("share", 0.0, most, (0.1 * most, 0.5 * most), nodes),
        Coordinate("rim", 0.0, LARGEST_PATCH, (0.1 * LARGEST_PATCH, 0.5 * LARGEST_PATCH), RIM_NODES),
    )

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        share, rim = (max(value, 0.0) for value in values)
        loose, bonded = width * (sqrt(share) if solid else share), corners * (1.0 - rim)
        both = {"center_mm": (0.0, 0.0), "diameter_mm": loose}
        return both | {"bonded_diameter_mm": max(bonded, loose + LEAST_BONDED * width)} if rim > 0.0 else both

    units = dict.fromkeys(("center_mm", "diameter_mm", "bonded_diameter_mm"), "mm")
    return Candidate(DELAMINATION.name, bond, coordinates, parameters, units=units)


register(Vocabulary(DELAMINATION, "{} has come apart", of_segment=of_segment, kind=GIVES_WAY))
