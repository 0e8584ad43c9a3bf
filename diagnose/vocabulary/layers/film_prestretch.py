"""A film that was stretched before it was bonded; in a slice nothing tells a stretch across it from one along it."""

from collections.abc import Iterator, Sequence
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.layers.film_prestretch import FILM_PRESTRETCH

STRETCH = 0.015  # the yield strain is 2 to 3 %
SLACK = -0.002  # a film with more slack buckles


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any film."""
    yield _prestretch(scene)


def _prestretch(scene: Scene) -> Candidate:
    axes = ("x", "y") if scene.model.segment.section == "solid" else ("x",)
    have = scene.model.physics.prestretch
    nodes = (SLACK, 0.3 * STRETCH, STRETCH)
    coordinates = tuple(Coordinate(f"strain_{axis}", SLACK, STRETCH, (0.002, -0.001), nodes) for axis in axes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        added = (*values, 0.0)[:2]
        return {"strain_x": have[0] + added[0], "strain_y": have[1] + added[1]}

    units = {"strain_x": "", "strain_y": ""}
    return Candidate(FILM_PRESTRETCH.name, "film", coordinates, parameters, units=units)


register(Vocabulary(FILM_PRESTRETCH, "{} was stretched before it was bonded", of_segment=of_segment))
