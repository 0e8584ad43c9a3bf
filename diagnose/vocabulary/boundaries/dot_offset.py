"""The dot stands elsewhere."""

from collections.abc import Iterator, Sequence
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.boundaries.dot_offset import DOT_OFFSET

ASIDE = 0.16  # of the segment's size: 0.4 mm of 2.5, by hand 0.1 to 0.3


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Of any dot."""
    yield _offset(scene)


def _offset(scene: Scene) -> Candidate:
    segment = scene.model.segment
    sizes = {"x": segment.length_mm, "y": segment.width_mm}
    axes = ("x", "y") if segment.section == "solid" else ("x",)
    coordinates = tuple(_aside(f"offset_{axis}_mm", ASIDE * sizes[axis]) for axis in axes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"offset_mm": (*values, 0.0)[:2]}

    return Candidate(DOT_OFFSET.name, "dot", coordinates, parameters, units={"offset_mm": "mm"})


def _aside(name: str, most: float) -> Coordinate:
    return Coordinate(name, -most, most, (0.3 * most, -0.3 * most), (-most, -0.5 * most, 0.5 * most, most))


register(Vocabulary(DOT_OFFSET, "{} is not where rig.toml places it", of_segment=of_segment))
