"""A round dot that was modelled as a ridge, or the reverse: from 0 to 1, and only the ends exist."""

from collections.abc import Iterator

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scene import Scene
from geometry.parameters import SIZED_DOTS
from solve.mechanisms.boundaries.dimension_reduction import DIMENSION_REDUCTION


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for caps and ridges."""
    if scene.model.dot.shape in SIZED_DOTS:
        yield _dimension()


def _dimension() -> Candidate:
    """The dimension, from the declared shape at 0 to the other one at 1; only the ends exist."""
    coordinate = Coordinate("other_shape", 0.0, 1.0, (1.0,), (1.0,))
    return Candidate(DIMENSION_REDUCTION.name, "dot", (coordinate,), lambda _: {})


register(
    Vocabulary(DIMENSION_REDUCTION, "{} is round but was modelled as a ridge, or the reverse", of_segment=of_segment)
)
