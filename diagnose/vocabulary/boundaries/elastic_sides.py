"""Compliance of held sides, another stiffness of declared springs, or something that free sides lean on."""

from collections.abc import Iterator, Sequence
from math import asinh, exp, log, sinh
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import GIVES_WAY, Vocabulary, register
from diagnose.vocabulary.scales import shrinking
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.boundaries.elastic_sides import ELASTIC_SIDES

STIFF_SIDE_N_PER_MM3 = 3000.0  # the ends of a film of PVDF, a few mm long, begin to move
SOFTEST_SIDE_N_PER_MM3 = 0.5  # rubber of 1 MPa, 2 mm thick
SIDES = 50.0  # factor either way on declared springs
LEAST_SIDE_N_PER_MM3 = 0.02  # a foam of 50 kPa, 2.5 mm thick
NODES = 0.18, 0.31, 0.42, 0.55, 0.69, 0.84, 1.0  # of the way from free to held


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Whatever rig.toml says of the sides."""
    segment = scene.model.segment
    if segment.boundary == "clamped":
        yield _soft_sides()
    elif segment.boundary == "elastic":
        yield _other_sides(segment.side_stiffness_N_per_mm3)
    else:
        yield _leaning_sides()


def _soft_sides() -> Candidate:
    """Compliance of what is declared as clamped."""
    most = asinh(STIFF_SIDE_N_PER_MM3 / SOFTEST_SIDE_N_PER_MM3)
    nodes = tuple(share * most for share in (0.05, 0.14, 0.27, 0.45, 0.62, 0.8, 1.0))
    coordinate = Coordinate("compliance", 0.0, most, (0.15 * most, 0.5 * most), nodes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"stiffness_N_per_mm3": shrinking(STIFF_SIDE_N_PER_MM3, sinh(values[0]))}

    return Candidate(ELASTIC_SIDES.name, "sides", (coordinate,), parameters, units={"stiffness_N_per_mm3": "N/mm3"})


def _leaning_sides() -> Candidate:
    """Stiffness of what is declared as free, up to sides that are as good as clamped."""
    scale, units = LEAST_SIDE_N_PER_MM3, {"stiffness_N_per_mm3": "N/mm3"}
    most = asinh(STIFF_SIDE_N_PER_MM3 / scale)
    nodes = tuple(share * most for share in NODES)
    coordinate = Coordinate("stiffness", 0.0, most, (0.15 * most, 0.4 * most), nodes, levels_off=(False, True))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"stiffness_N_per_mm3": scale * sinh(values[0])}

    return Candidate(ELASTIC_SIDES.name, "sides", (coordinate,), parameters, units=units)


def _other_sides(declared: float) -> Candidate:
    """Logarithm of the factor on the declared stiffness."""
    most = log(SIDES)
    coordinate = Coordinate("log_factor", -most, most, (-1.0, 1.0), (-most, -0.4 * most, 0.4 * most, most))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"stiffness_N_per_mm3": declared * exp(values[0])}

    return Candidate(ELASTIC_SIDES.name, "sides", (coordinate,), parameters, units={"stiffness_N_per_mm3": "N/mm3"})


register(Vocabulary(ELASTIC_SIDES, "{} are compliant", of_segment=of_segment, kind=GIVES_WAY))
