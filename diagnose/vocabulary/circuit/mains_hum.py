"""Mains hum: a sine and a cosine of each run."""

from collections.abc import Iterator, Sequence
from math import hypot, sqrt
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.mains_hum import MAINS_HUM

HUM = 10.0  # of the largest voltage


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any amplifier."""
    yield _hum(scene)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Yield the candidates of a segment."""
    yield _hum(scene)


def _hum(scene: Scene) -> Candidate:
    """Sine and cosine of each run: nobody knows the phase of the mains. The amplitude is the mean square's."""
    most = HUM * (scene.voltage_V or 1.0)
    start = 0.01 * (scene.voltage_V or 1.0)
    names = (f"{part}_{run}" for run in range(scene.runs) for part in ("sine", "cosine"))
    coordinates = tuple(Coordinate(name, -most, most, (start, -start)) for name in names)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"frequency_Hz": scene.mains_Hz, "amplitude_V": hypot(*values) / sqrt(scene.runs)}

    units = {"frequency_Hz": "Hz", "amplitude_V": "V"}
    return Candidate(MAINS_HUM.name, "readout", coordinates, parameters, units=units)


register(
    Vocabulary(MAINS_HUM, "there is mains hum on {}", of_segment=of_segment, of_unknown_geometry=of_unknown_geometry)
)
