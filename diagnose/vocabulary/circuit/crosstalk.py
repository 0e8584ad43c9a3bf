"""What leaks from other channels into one: a coupling of either sign."""

from collections.abc import Iterator, Sequence
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import Scene, Vocabulary, register
from solve.mechanisms.circuit.crosstalk import CROSSTALK


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """One for each channel where there are several."""
    if scene.channels > 1:
        yield from (_crosstalk(channel) for channel in range(1, scene.channels + 1))


def _crosstalk(channel: int) -> Candidate:
    """Coupling of either sign."""
    coordinate = Coordinate("coupling", -0.95, 0.95, (0.1, -0.1))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"coupling": values[0]}

    return Candidate(CROSSTALK.name, f"channel-{channel}", (coordinate,), parameters, units={"coupling": ""})


register(Vocabulary(CROSSTALK, "other channels couple into {}", of_segment=of_segment))
