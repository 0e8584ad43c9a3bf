"""Candidates behind the film: input, filters, limits, hum, neighbouring channels. All are exact without new presses."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import hypot, pi, sinh, sqrt
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.scene import Scene, growing, shrinking
from solve.readout.filters import corner_over_natural

SHARPEST = 2.0  # Q^2 of a filter whose resonance is 3 dB
DEAD = 0.8  # of a filter's whole delay
ONE_STAGE = 1e-3  # Q^2 below which the second stage is too fast to be seen
CLIPPED = 20.0  # an amplifier that stops at less than this part of what was recorded gives no signal
SOFTEST = 1.7  # sharpness of its knee: a hyperbolic tangent has 2.5
HARD = 1e-3  # one over the sharpness that is as good as no knee
HUM = 10.0  # of the largest voltage


def electric(scene: Scene) -> Iterator[Candidate]:
    """Those that the amplifiers and channels of this rig admit."""
    if scene.voltage_mode:
        yield _leakage(scene, "readout")
        yield _leakage(scene, "film")
        yield _parasitic(scene)
    yield _low_pass(scene)
    yield _saturation(scene)
    yield _hum(scene)
    if scene.channels > 1:
        yield from (_crosstalk(channel) for channel in range(1, scene.channels + 1))


def _leakage(scene: Scene, component: str) -> Candidate:
    """Conductance. At most, the charge is gone within one sample."""
    scale, most = scene.conductance_uS, 1e-6 * scene.capacitance_pF / scene.step_s
    top = max(most, 100.0 * scale)
    coordinate = growing("conductance", scale, top, (0.3 * scale, 3.0 * scale, sqrt(scale * top)))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"resistance_MOhm": shrinking(1.0 / scale, sinh(values[0]))}

    return Candidate("charge-leakage", component, (coordinate,), parameters, units={"resistance_MOhm": "MOhm"})


def _parasitic(scene: Scene) -> Candidate:
    """Up to a hundred times what is there: then no signal is left."""
    scale = scene.capacitance_pF
    coordinate = growing("capacitance", scale, 100.0 * scale, (0.2 * scale, 2.0 * scale))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"capacitance_pF": scale * sinh(values[0])}

    return Candidate("parasitic-capacitance", "readout", (coordinate,), parameters, units={"capacitance_pF": "pF"})


def _low_pass(scene: Scene) -> Candidate:
    """H(s) = exp(-s d D) / (1 + s T + k s^2 T^2) with T = (1 - d) D; k = Q^2 of order two.

    D is the delay of what changes slowly, whatever k and d: from what one sample shows to the length of a run. k = 0
    is one RC stage, 1/3 Bessel's filter, 1/2 Butterworth's; a share d of the delay is dead time in higher orders.
    """
    scale = 2.0 * scene.step_s
    time = growing("time_constant", scale, scene.duration_s, (scale, 10.0 * scale, 100.0 * scale))
    second = Coordinate("second_order", 0.0, SHARPEST, (0.25, 0.5))
    dead = Coordinate("dead_time", 0.0, DEAD, (0.2,))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        delay_s = values[2] * scale * sinh(values[0])
        reciprocal_s = shrinking(1.0 / scale, sinh(values[0])) / (1.0 - values[2])  # 1 / T
        if values[1] < ONE_STAGE:
            return {"cutoff_Hz": reciprocal_s / (2.0 * pi), "order": 1, "delay_s": delay_s}
        quality = sqrt(values[1])
        corner_Hz = corner_over_natural(quality) / quality * reciprocal_s / (2.0 * pi)
        return {"cutoff_Hz": corner_Hz, "order": 2, "quality": quality, "delay_s": delay_s}

    units = {"cutoff_Hz": "Hz", "order": "", "quality": "", "delay_s": "s"}
    return Candidate("low-pass", "readout", (time, second, dead), parameters, units=units)


def hard_limit(scene: Scene) -> Candidate:
    """One over the limit, in terms of the largest voltage recorded: below about 1 nothing is cut."""
    largest = scene.voltage_V or 1.0
    limit = Coordinate("inverse_limit", 0.0, CLIPPED, (1.1, 1.5, 3.0))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"limit_V": shrinking(largest, values[0])}

    return Candidate("saturation", "readout", (limit,), parameters, units={"limit_V": "V"})


def _saturation(scene: Scene) -> Candidate:
    """A limit with a knee of any sharpness p, from the softest to none.

    The overdrive is (V_largest / V_max)^p of the softest: what that one takes away is linear in it. A hard limit takes
    nothing away before it is reached: a fit that starts there does not see where to go.
    """
    hard = hard_limit(scene)
    starts = tuple(inverse**SOFTEST for inverse in (0.5, 1.1, 3.0))
    overdrive = Coordinate("overdrive", 0.0, CLIPPED**SOFTEST, starts)
    hardness = Coordinate("hardness", 0.0, 1.0, (0.5, 0.9), levels_off=(False, True))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        limit, softness = hard.parameters([values[0] ** (1.0 / SOFTEST)]), (1.0 - values[1]) / SOFTEST
        return limit if softness < HARD else {**limit, "sharpness": 1.0 / softness}

    units = {**hard.units, "sharpness": ""}
    return replace(hard, coordinates=(overdrive, hardness), parameters=parameters, units=units)


def _hum(scene: Scene) -> Candidate:
    """Sine and cosine of each run: nobody knows the phase of the mains. The amplitude is the mean square's."""
    most = HUM * (scene.voltage_V or 1.0)
    start = 0.01 * (scene.voltage_V or 1.0)
    names = (f"{part}_{run}" for run in range(scene.runs) for part in ("sine", "cosine"))
    coordinates = tuple(Coordinate(name, -most, most, (start, -start)) for name in names)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"frequency_Hz": scene.mains_Hz, "amplitude_V": hypot(*values) / sqrt(scene.runs)}

    units = {"frequency_Hz": "Hz", "amplitude_V": "V"}
    return Candidate("mains-hum", "readout", coordinates, parameters, units=units)


def _crosstalk(channel: int) -> Candidate:
    """Coupling of either sign."""
    coordinate = Coordinate("coupling", -0.95, 0.95, (0.1, -0.1))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"coupling": values[0]}

    return Candidate("crosstalk", f"channel-{channel}", (coordinate,), parameters, units={"coupling": ""})
