"""A low-pass behind the read-out: by its delay, its order and its dead time."""

from collections.abc import Iterator, Sequence
from math import pi, sinh, sqrt
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scales import growing, shrinking
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.low_pass import LOW_PASS
from solve.readout.filters import corner_over_natural

SHARPEST = 2.0  # Q^2 of a filter whose resonance is 3 dB
DEAD = 0.8  # of a filter's whole delay
ONE_STAGE = 1e-3  # Q^2 below which the second stage is too fast to be seen


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any amplifier: of all channels together, or of one."""
    yield _low_pass(scene, "readout")
    yield from (_low_pass(scene, channel) for channel in scene.numbered)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Yield candidates for all channels together."""
    yield _low_pass(scene, "readout")


def _low_pass(scene: Scene, component: str) -> Candidate:
    """H(s) = exp(-s d D) / (1 + s T + k s^2 T^2) with T = (1 - d) D; k = Q^2 of order two.

    D is the delay of what changes slowly, whatever k and d: from what one sample shows to the length of a run. k = 0
    is one RC stage, 1/3 Bessel's filter, 1/2 Butterworth's; a share d of the delay is dead time in higher orders.
    """
    scale = 2.0 * scene.scales.step_s
    time = growing("time_constant", scale, scene.scales.lasting_s, (scale, 10.0 * scale, 100.0 * scale))
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
    return Candidate(LOW_PASS.name, component, (time, second, dead), parameters, units=units)


register(
    Vocabulary(LOW_PASS, "{} filters out fast changes", of_segment=of_segment, of_unknown_geometry=of_unknown_geometry)
)
