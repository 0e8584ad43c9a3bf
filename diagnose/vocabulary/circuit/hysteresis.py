"""Hysteresis without rate of the film, or of whatever makes an unknown sensor's charge: plays of fixed widths."""

from collections.abc import Iterator, Sequence
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import REMEMBERS, Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.hysteresis import HYSTERESIS

WIDTHS = 0.02, 0.06, 0.15, 0.35  # half widths over the largest charge; half of it never shows in a press
OF_LOOP = 0.03, 0.15, 0.4, 0.7  # the same of a signal of both signs
NEVER = 2.0  # a play that is never crossed: all of a push has another sensitivity
MOST, MOST_OF_SENSOR = 0.5, 2.0  # of one share
PULLED = 0.1  # of the largest force: what is less is no pull


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any film."""
    yield _plays(scene, WIDTHS, (), 0.0, MOST)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Yield candidates for a sensor that may saturate too: shares of either sign.

    What is pulled too may differ between push and pull.
    """
    pulled = any(run.drive_values.min() < -PULLED * run.drive_values.max() for run in recording.runs)
    widths, of_push = (OF_LOOP, (*OF_LOOP, NEVER)) if pulled else (WIDTHS, ())
    yield _plays(scene, widths, of_push, -MOST_OF_SENSOR, MOST_OF_SENSOR)


def _plays(scene: Scene, widths: Sequence[float], of_push: Sequence[float], low: float, high: float) -> Candidate:
    """The candidate, in terms of the largest charge."""
    largest_pC, count = scene.charge_pC, len(widths)
    names = [f"behind_{width:g}" for width in widths] + [f"push_behind_{width:g}" for width in of_push]
    coordinates = tuple(Coordinate(name, low, high, (0.05 * high, 0.4 * high)) for name in names)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        shown = _acting(values[:count], widths, largest_pC)
        pushed = _acting(values[count:], of_push, largest_pC)
        both = {"play_shares": shown[0], "play_pC": shown[1]}
        return both | ({"push_shares": pushed[0], "push_play_pC": pushed[1]} if of_push else {})

    def told(values: Sequence[float]) -> dict[str, Any]:
        plays = zip(names, values, (*widths, *of_push), strict=True)
        kinds = ((name.partition("behind")[0], value, width * largest_pC) for name, value, width in plays)
        return {f"{push}share_behind_{float(f'{play:.3g}'):g}_pC": value for push, value, play in kinds if value}

    units = {"play_shares": "", "play_pC": "pC", "push_shares": "", "push_play_pC": "pC"}
    return Candidate(HYSTERESIS.name, "film", coordinates, parameters, units=units, told=told)


def _acting(values: Sequence[float], widths: Sequence[float], largest_pC: float) -> tuple[list[float], list[float]]:
    """Shares of the plays that act, and half their widths in pC."""
    shown = [(value, width * largest_pC) for value, width in zip(values, widths, strict=True) if value]
    return [share for share, _ in shown], [play for _, play in shown]


register(
    Vocabulary(
        HYSTERESIS,
        "the response of {} lags behind its strain, at any rate (hysteresis)",
        of_segment=of_segment,
        of_unknown_geometry=of_unknown_geometry,
        kind=REMEMBERS,
    )
)
