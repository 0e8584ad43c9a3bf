"""Compliance of the rig, or of a tester, in terms of what it holds."""

from collections.abc import Iterator, Sequence
from math import sinh
from typing import Any

from diagnose.forward import Candidate
from diagnose.vocabulary.base import GIVES_WAY, Vocabulary, register
from diagnose.vocabulary.scales import growing
from diagnose.vocabulary.scene import CouponScene, Scene
from solve.mechanisms.boundaries.rig_compliance import RIG_COMPLIANCE
from solve.physics import like
from solve.terms.rig import RigSpring

MOST_OF_TRAVEL = 0.25  # a tester that takes more than a quarter of the travel is seen to bend


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any rig whose path was recorded."""
    if scene.path_shown:
        yield _compliance(scene)


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """Yield candidates for the tester; with largest travel over largest force nothing is left to the coupon."""
    scale = scene.travel_mm / scene.force_N
    coordinate = growing("compliance", scale, MOST_OF_TRAVEL * scale, (0.05 * scale, 0.2 * scale))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"compliance_mm_per_N": scale * sinh(values[0])}

    yield Candidate(RIG_COMPLIANCE.name, "rig", (coordinate,), parameters, units={"compliance_mm_per_N": "mm/N"})


def _compliance(scene: Scene) -> Candidate:
    """Scaled by the segment's own: at ten times that the rig takes nearly all of the travel."""
    scale = scene.depth_mm / scene.force_N
    have = like(scene.model.physics.terms, RigSpring()).compliance_mm_per_N
    coordinate = growing("compliance", scale, 10.0 * scale, (0.05 * scale, scale))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"compliance_mm_per_N": have + scale * sinh(values[0])}

    units = {"compliance_mm_per_N": "mm/N"}
    return Candidate(RIG_COMPLIANCE.name, "rig", (coordinate,), parameters, units=units)


register(
    Vocabulary(
        RIG_COMPLIANCE,
        "{} deflects, which the displacement sensor does not see",
        of_segment=of_segment,
        of_coupon=of_coupon,
        kind=GIVES_WAY,
    )
)
