"""Friction of a guide or a seal in the fixture: against the motion, the same at any speed.

Sliders at fixed travels, half a decade apart, by their forces over the largest that was recorded: the answer is linear
in them, and the best sum of two neighbours differs from a slider in between by up to a sixth of its force.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from diagnose.engines.coupon.tested_layer import SPECIMEN
from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import REMEMBERS, Vocabulary, register
from diagnose.vocabulary.scene import FORCE, CouponScene, Scene
from solve.mechanisms.boundaries.guide_friction import GUIDE_FRICTION
from solve.mechanisms.circuit.hysteresis import HYSTERESIS

TRAVELS = tuple(10.0 ** (0.5 * n - 3.0) for n in range(6))  # of the largest travel, where a slider slips
MOST, EVERYDAY = 1.5, 0.003  # of the largest force; the latter any tester has (rule of thumb)


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates where a force answers: of one that drives nobody knows what a guide takes."""
    if scene.shows(FORCE):
        yield _guide(scene.force_N, scene.depth_mm)


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """Yield candidates where a displacement drives: of a force that drives nobody knows what a guide takes."""
    if all(run.drive == "displacement_mm" for run in scene.recording.runs):
        same = (HYSTERESIS.name, SPECIMEN)  # of the specimen itself, by plays of its strain
        yield replace(_guide(scene.force_N, scene.travel_mm), identical_to=(same,))


def _guide(force_N: float, travel_mm: float) -> Candidate:
    """The candidate, in terms of the largest force and travel."""
    travels = [share * travel_mm for share in TRAVELS]
    coordinates = tuple(Coordinate(f"force_from_{travel:.3g}_mm", 0.0, MOST, (0.05, 0.5)) for travel in travels)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        rubbing = [(force_N * value, at) for value, at in zip(values, travels, strict=True) if value > 0.0]
        return {"friction_force_N": [force for force, _ in rubbing], "presliding_mm": [at for _, at in rubbing]}

    def derived(values: Sequence[float]) -> dict[str, float]:
        return sliding(**parameters(values))

    forces = {f"friction_within_{travel:.3g}_mm_N": n for n, travel in enumerate(travels)}

    def told(values: Sequence[float]) -> dict[str, Any]:
        return {name: force_N * values[n] for name, n in forces.items() if values[n] > 0.0}

    units = {"friction_force_N": "N", "presliding_mm": "mm", "sliding_friction_N": "N", "half_of_it_within_mm": "mm"}
    units |= dict.fromkeys(forces, "N")
    everyday = {"sliding_friction_N": EVERYDAY * force_N}
    return Candidate(GUIDE_FRICTION.name, "rig", coordinates, parameters, derived, units, everyday=everyday, told=told)


def sliding(friction_force_N: Sequence[float], presliding_mm: Sequence[float]) -> dict[str, float]:
    """Force of all sliders in N once they slip, and the travel in mm from rest within which half of it is there.

    presliding_mm (k,) ascends, one for each force (k,).
    """
    forces, travels = np.array(friction_force_N), np.array([0.0, *presliding_mm])
    grown = np.minimum(travels[:, None] / travels[1:], 1.0) @ forces
    return {
        "sliding_friction_N": float(grown[-1]),
        "half_of_it_within_mm": float(np.interp(0.5 * grown[-1], grown, travels)),
    }


register(
    Vocabulary(
        GUIDE_FRICTION,
        "a guide or seal of {} rubs",
        of_segment=of_segment,
        of_coupon=of_coupon,
        kind=REMEMBERS,
    )
)
