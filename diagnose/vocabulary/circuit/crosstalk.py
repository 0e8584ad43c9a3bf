"""What leaks between channels: two inputs tied by a capacitance, or all others into one, of either sign.

A capacitance between two inputs is reciprocal, so that a pair has no direction. It needs inputs whose voltage moves:
those of charge amplifiers are virtual grounds, and only what lies behind them can mix.
"""

from collections.abc import Iterator, Sequence
from math import sinh
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scales import growing
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.crosstalk import CROSSTALK

SEEN = 0.01  # of a channel's own capacitance
MOST = 1.0  # of the same: half of what a neighbour has


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates where there are several channels."""
    if scene.voltage_mode:
        yield from (_tied(scene.of_each_channel, pair) for pair in scene.paired)
    yield from (_mixed(channel) for channel in scene.numbered)


def _tied(scene: Scene, pair: str) -> Candidate:
    """Capacitance between two inputs, up to that of one of them."""
    own = scene.capacitance_pF
    scale = SEEN * own
    coordinate = growing("capacitance", scale, MOST * own, (3.0 * scale, 0.2 * own))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"capacitance_pF": scale * sinh(values[0])}

    return Candidate(CROSSTALK.name, pair, (coordinate,), parameters, units={"capacitance_pF": "pF"})


def _mixed(channel: str) -> Candidate:
    """Coupling of either sign."""
    coordinate = Coordinate("coupling", -0.95, 0.95, (0.1, -0.1))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"coupling": values[0]}

    return Candidate(CROSSTALK.name, channel, (coordinate,), parameters, units={"coupling": ""})


register(
    Vocabulary(
        CROSSTALK,
        "other channels couple into {}",
        of_segment=of_segment,
        words_of_two="{} and {} couple into each other through a capacitance between their inputs",
    )
)
