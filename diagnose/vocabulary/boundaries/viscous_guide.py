"""A guide that rubs the more the faster it moves, with friction that fades as a film of oil forms."""

from collections.abc import Iterator, Sequence
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.time_scales import TimeScales, time_scales
from diagnose.vocabulary.base import REMEMBERS, Vocabulary, register
from diagnose.vocabulary.scene import FORCE, CouponScene, Scene
from solve.mechanisms.boundaries.viscous_guide import VISCOUS_GUIDE

MOST = 1.5  # of the largest force, at the speed of the quickest loading
FADING = 0.5  # of that speed: where Stribeck's friction fades, which presses at a few rates do not tell


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates where a force answers, which alone shows it."""
    if scene.shows(FORCE):
        yield _guide(scene.force_N, scene.depth_mm, scene.scales)


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """Yield candidates where a displacement drives."""
    if all(run.drive == "displacement_mm" for run in scene.recording.runs):
        yield _guide(scene.force_N, scene.travel_mm, time_scales(scene.recording))


def _guide(force_N: float, travel_mm: float, scales: TimeScales) -> Candidate:
    """The candidate, in terms of the largest force and of the speed of the quickest loading."""
    speed = travel_mm / scales.loading_s
    coordinates = (
        Coordinate("viscous", 0.0, MOST, (0.05, 0.5)),
        Coordinate("stribeck", 0.0, MOST, (0.05, 0.5)),
    )

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        viscous, stribeck = values
        return {
            "viscous_N_s_per_mm": force_N / speed * viscous,
            "stribeck_N": force_N * stribeck,
            "stribeck_mm_per_s": FADING * speed,
        }

    units = {"viscous_N_s_per_mm": "N s/mm", "stribeck_N": "N", "stribeck_mm_per_s": "mm/s"}
    return Candidate(VISCOUS_GUIDE.name, "rig", coordinates, parameters, units=units)


register(
    Vocabulary(
        VISCOUS_GUIDE,
        "a guide of {} is viscous",
        of_segment=of_segment,
        of_coupon=of_coupon,
        kind=REMEMBERS,
    )
)
