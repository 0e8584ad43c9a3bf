"""Hysteresis without rate of the film, or of whatever makes the charge of an unknown sensor.

Plays at fixed widths, so that the answer is linear in their shares.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import REMEMBERS, Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.hysteresis import HYSTERESIS

WIDTHS = 0.02, 0.06, 0.15, 0.35  # half widths over the largest charge; half of it never shows in a press
WIDTHS_OF_LOOP = 0.03, 0.08, 0.16, 0.28, 0.42, 0.58, 0.78  # the same of a signal of both signs
MOST, MOST_OF_SENSOR = 0.5, 2.0  # of one share


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Of any film."""
    yield _plays(scene, WIDTHS, 0.0, MOST)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Of a sensor that may saturate too: shares of either sign."""
    yield _plays(scene, WIDTHS_OF_LOOP, -MOST_OF_SENSOR, MOST_OF_SENSOR)


def _plays(scene: Scene, widths: Sequence[float], low: float, high: float) -> Candidate:
    """In terms of the largest charge."""
    largest_pC = scene.charge_pC
    coordinates = tuple(Coordinate(f"behind_{width:g}", low, high, (0.05 * high, 0.4 * high)) for width in widths)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        shown = [(value, width * largest_pC) for value, width in zip(values, widths, strict=True) if value]
        return {"play_shares": [share for share, _ in shown], "play_pC": [play for _, play in shown]}

    def derived(values: Sequence[float]) -> dict[str, float]:
        return {"hysteretic_share": float(sum(values))}

    units = {"play_shares": "", "play_pC": "pC", "hysteretic_share": ""}
    return Candidate(HYSTERESIS.name, "film", coordinates, parameters, derived, units)


register(
    Vocabulary(
        HYSTERESIS,
        "the charge of {} lags behind its strain, at any rate (hysteresis)",
        of_segment=of_segment,
        of_unknown_geometry=of_unknown_geometry,
        kind=REMEMBERS,
    )
)
