"""Candidates of the film: it was stretched before it was bonded, or it yields."""

from collections.abc import Iterator, Sequence
from math import sinh
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.scene import Scene, growing, shrinking
from solve.materials.parameters import PiezoelectricFilm

STRETCH = 0.015  # the yield strain is 2 to 3 %
SLACK = -0.002  # a film with more slack buckles
WEAKEST_MPA = 5.0  # a tenth of what PVDF is sold with


def of_film(scene: Scene) -> Iterator[Candidate]:
    """Both; in a slice nothing tells a stretch across it from one along it."""
    yield _prestretch(scene)
    yield _yield_stress(scene)


def _prestretch(scene: Scene) -> Candidate:
    axes = ("x", "y") if scene.model.segment.section == "solid" else ("x",)
    have = scene.model.physics.prestretch
    nodes = (SLACK, 0.3 * STRETCH, STRETCH)
    coordinates = tuple(Coordinate(f"strain_{axis}", SLACK, STRETCH, (0.002, -0.001), nodes) for axis in axes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        added = (*values, 0.0)[:2]
        return {"strain_x": have[0] + added[0], "strain_y": have[1] + added[1]}

    units = {"strain_x": "", "strain_y": ""}
    return Candidate("film-prestretch", "film", coordinates, parameters, units=units)


def _yield_stress(scene: Scene) -> Candidate:
    """One over the yield stress, in terms of that of the film's table: below some value nothing yields."""
    film = scene.model.materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    usual = film.yield_stress_MPa or 50.0
    most = max(usual / WEAKEST_MPA, 2.0)
    nodes = tuple(share * most for share in (0.12, 0.22, 0.35, 0.6, 1.0))
    coordinate = growing("inverse_stress", 1.0, most, (1.5, 0.5 * most), nodes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"yield_stress_MPa": shrinking(usual, sinh(values[0]))}

    units = {"yield_stress_MPa": "MPa"}
    return Candidate("film-yield", "film", (coordinate,), parameters, units=units)
