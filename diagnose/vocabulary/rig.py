"""Candidates around the segment that need no new presses: gap, compliance, mass, heat, charge of the touch."""

from collections.abc import Iterator, Sequence
from math import exp, log, sinh
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.scene import Scene, growing

HOTTEST_K = 30.0  # a finger is about 10 K warmer than the room
TOUCH_CHARGE = 10.0  # of the largest charge that was recorded
MASS_G = 5.0
HEAVIEST_G = 500.0


def around(scene: Scene) -> Iterator[Candidate]:
    """Those that the drives of this rig admit."""
    yield _gap(scene)
    yield _compliance(scene)
    yield _mass(scene)
    yield _heat(scene)
    yield _touch(scene)


def _gap(scene: Scene) -> Candidate:
    """Up to half the deepest press."""
    deepest = scene.depth_mm
    coordinate = Coordinate("gap_mm", 0.0, 0.5 * deepest, (0.03 * deepest, 0.15 * deepest))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"gap_mm": values[0]}

    return Candidate("contact-gap", "dot", (coordinate,), parameters, units={"gap_mm": "mm"})


def _compliance(scene: Scene) -> Candidate:
    """Scaled by the segment's own: at ten times that the rig takes nearly all of the travel."""
    scale = scene.depth_mm / scene.force_N
    have = scene.model.physics.rig_compliance_mm_per_N
    coordinate = growing("compliance", scale, 10.0 * scale, (0.05 * scale, scale))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"compliance_mm_per_N": have + scale * sinh(values[0])}

    units = {"compliance_mm_per_N": "mm/N"}
    return Candidate("rig-compliance", "rig", (coordinate,), parameters, units=units)


def _mass(scene: Scene) -> Candidate:
    """The dot, its holder and half of the beam: grams."""
    have = scene.model.physics.moving_mass_g
    coordinate = growing("mass", MASS_G, HEAVIEST_G, (MASS_G, 10.0 * MASS_G))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"moving_mass_g": have + MASS_G * sinh(values[0])}

    return Candidate("inertia", "rig", (coordinate,), parameters, units={"moving_mass_g": "g"})


def _heat(scene: Scene) -> Candidate:
    """A step of either sign; its time from a few samples to a few runs."""
    declared = scene.model.physics.pyroelectric
    base = declared.time_constant_s if declared.temperature_step_K != 0.0 else min(1.0, 0.3 * scene.duration_s)
    step = Coordinate("temperature_step_K", -HOTTEST_K, HOTTEST_K, (0.1, -0.1))
    fastest, slowest = log(5.0 * scene.step_s / base), log(5.0 * scene.duration_s / base)
    time = Coordinate("log_time", min(fastest, -1.0), max(slowest, 1.0), (-1.5, 1.0))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {
            "temperature_step_K": declared.temperature_step_K + values[0],
            "time_constant_s": base * exp(values[1]),
        }

    units = {"temperature_step_K": "K", "time_constant_s": "s"}
    return Candidate("pyroelectric-drift", "film", (step, time), parameters, units=units)


def _touch(scene: Scene) -> Candidate:
    """In terms of the charge that makes the largest voltage recorded."""
    scale = scene.capacitance_pF * (scene.voltage_V or 1.0)
    declared = scene.model.physics.contact_charge_pC
    coordinate = Coordinate("charge", -TOUCH_CHARGE, TOUCH_CHARGE, (0.1, -0.1))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"charge_pC": declared + scale * values[0]}

    return Candidate("contact-electrification", "film", (coordinate,), parameters, units={"charge_pC": "pC"})
