"""Candidates of the dot and of the sides: where it stands, how it rubs, its shape, and what holds the segment."""

from collections.abc import Iterator, Sequence
from math import asinh, exp, log, sinh
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.scene import Scene, growing, shrinking

ASIDE = 0.16  # of the segment's size: 0.4 mm of 2.5, by hand 0.1 to 0.3
SLIPPERY, ROUGHEST = 0.1, 1.5  # dry rubber on plastic has 0.3 to 1
STIFF_SIDE_N_PER_MM3 = 3000.0  # the ends of a film of PVDF, a few mm long, begin to move
SOFTEST_SIDE_N_PER_MM3 = 0.5  # rubber of 1 MPa, 2 mm thick
SIDES = 50.0  # factor either way on declared springs


def of_place(scene: Scene) -> Iterator[Candidate]:
    """Those that shape and boundary admit."""
    yield _offset(scene)
    yield _friction()
    if scene.model.segment.boundary == "clamped":
        yield _soft_sides()
    if scene.model.segment.boundary == "elastic":
        yield _other_sides(scene.model.segment.side_stiffness_N_per_mm3)
    if scene.model.dot.shape != "plate":
        yield _dimension()


def _offset(scene: Scene) -> Candidate:
    segment = scene.model.segment
    sizes = {"x": segment.length_mm, "y": segment.width_mm}
    axes = ("x", "y") if segment.section == "solid" else ("x",)
    coordinates = tuple(_aside(f"offset_{axis}_mm", ASIDE * sizes[axis]) for axis in axes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"offset_mm": (*values, 0.0)[:2]}

    return Candidate("dot-offset", "dot", coordinates, parameters, units={"offset_mm": "mm"})


def _aside(name: str, most: float) -> Coordinate:
    return Coordinate(name, -most, most, (0.3 * most, -0.3 * most), (-most, -0.5 * most, 0.5 * most, most))


def _friction() -> Candidate:
    """Where nothing slips any more, more friction changes nothing."""
    coordinate = growing("coefficient", SLIPPERY, ROUGHEST, (0.1, 0.5), (0.15, 0.5, ROUGHEST))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"coefficient": SLIPPERY * sinh(values[0])}

    return Candidate("friction", "dot", (coordinate,), parameters, units={"coefficient": ""})


def _soft_sides() -> Candidate:
    """Compliance of what is declared as clamped."""
    most = asinh(STIFF_SIDE_N_PER_MM3 / SOFTEST_SIDE_N_PER_MM3)
    nodes = tuple(share * most for share in (0.05, 0.14, 0.27, 0.45, 0.62, 0.8, 1.0))
    coordinate = Coordinate("compliance", 0.0, most, (0.15 * most, 0.5 * most), nodes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"stiffness_N_per_mm3": shrinking(STIFF_SIDE_N_PER_MM3, sinh(values[0]))}

    return Candidate("elastic-sides", "sides", (coordinate,), parameters, units={"stiffness_N_per_mm3": "N/mm3"})


def _other_sides(declared: float) -> Candidate:
    """Logarithm of the factor on the declared stiffness."""
    most = log(SIDES)
    coordinate = Coordinate("log_factor", -most, most, (-1.0, 1.0), (-most, -0.4 * most, 0.4 * most, most))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"stiffness_N_per_mm3": declared * exp(values[0])}

    return Candidate("elastic-sides", "sides", (coordinate,), parameters, units={"stiffness_N_per_mm3": "N/mm3"})


def _dimension() -> Candidate:
    """From the declared shape at 0 to the other one at 1; only the ends exist."""
    coordinate = Coordinate("other_shape", 0.0, 1.0, (1.0,), (1.0,))
    return Candidate("dimension-reduction", "dot", (coordinate,), lambda _: {})
