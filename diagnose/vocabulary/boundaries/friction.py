"""Friction of the dot: where nothing slips any more, more of it changes nothing."""

from collections.abc import Iterator, Sequence
from math import sinh
from typing import Any

from diagnose.forward import Candidate
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scales import growing
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.boundaries.friction import FRICTION

SLIPPERY, ROUGHEST = 0.1, 1.5  # dry rubber on plastic has 0.3 to 1


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any dot."""
    yield _friction()


def _friction() -> Candidate:
    coordinate = growing("coefficient", SLIPPERY, ROUGHEST, (0.1, 0.5), (0.15, 0.5, ROUGHEST))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"coefficient": SLIPPERY * sinh(values[0])}

    return Candidate(FRICTION.name, "dot", (coordinate,), parameters, units={"coefficient": ""})


register(Vocabulary(FRICTION, "{} rubs against the surface", of_segment=of_segment))
