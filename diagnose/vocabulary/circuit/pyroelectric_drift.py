"""A temperature step of the film, and its time constant."""

from collections.abc import Iterator, Sequence
from math import exp, log
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import OTHER_CHARGE, Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.pyroelectric_drift import PYROELECTRIC_DRIFT
from solve.physics import like
from solve.readout.heat_and_touch import Pyroelectric

UNDONE_BY = ("with the dot as warm as the film", {"dot_temperature": "of the film"})
HOTTEST_K = 30.0  # a finger is about 10 K warmer than the room


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any film."""
    yield _heat(scene)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Yield the candidates of a segment."""
    yield _heat(scene)


def _heat(scene: Scene) -> Candidate:
    """A step of either sign; its time from a few samples to a few runs."""
    declared = like(scene.model.physics.added, Pyroelectric())
    base = declared.time_constant_s if declared.temperature_step_K != 0.0 else min(1.0, 0.3 * scene.scales.lasting_s)
    step = Coordinate("temperature_step_K", -HOTTEST_K, HOTTEST_K, (0.1, -0.1))
    fastest, slowest = log(5.0 * scene.scales.step_s / base), log(5.0 * scene.scales.lasting_s / base)
    time = Coordinate("log_time", min(fastest, -1.0), max(slowest, 1.0), (-1.5, 1.0))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {
            "temperature_step_K": declared.temperature_step_K + values[0],
            "time_constant_s": base * exp(values[1]),
        }

    units = {"temperature_step_K": "K", "time_constant_s": "s"}
    return Candidate(PYROELECTRIC_DRIFT.name, "film", (step, time), parameters, units=units)


register(
    Vocabulary(
        PYROELECTRIC_DRIFT,
        "{} changes temperature on contact",
        of_segment=of_segment,
        of_unknown_geometry=of_unknown_geometry,
        undone_by=UNDONE_BY,
        kind=OTHER_CHARGE,
    )
)
