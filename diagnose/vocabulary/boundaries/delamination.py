"""A patch without bond at the centre of an interface, by its share of the width."""

from collections.abc import Iterator, Sequence
from math import sqrt
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import GIVES_WAY, Scene, Vocabulary, register
from solve.mechanisms.boundaries.delamination import DELAMINATION

LARGEST_PATCH = 0.9  # of the width


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Of every bond that the stack has."""
    yield from (_delamination(scene, bond) for bond in scene.bonds)


def _delamination(scene: Scene, bond: str) -> Candidate:
    """A patch at the centre, by its share of the width: of the area in a solid, of the length in a slice."""
    segment = scene.model.segment
    solid = segment.section == "solid"
    width = min(segment.length_mm, segment.width_mm) if solid else segment.length_mm
    most = LARGEST_PATCH**2 if solid else LARGEST_PATCH
    nodes = (0.2 * most, 0.5 * most, most)
    coordinate = Coordinate("share", 0.0, most, (0.1 * most, 0.5 * most), nodes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        share = max(values[0], 0.0)
        return {"center_mm": (0.0, 0.0), "diameter_mm": width * (sqrt(share) if solid else share)}

    return Candidate(DELAMINATION.name, bond, (coordinate,), parameters, units={"center_mm": "mm", "diameter_mm": "mm"})


register(Vocabulary(DELAMINATION, "{} has come apart in one place", of_segment=of_segment, kind=GIVES_WAY))
