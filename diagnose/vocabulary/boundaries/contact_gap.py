"""Lost motion before the touch: up to half the deepest press."""

from collections.abc import Iterator, Sequence
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import GIVES_WAY, Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.boundaries.contact_gap import CONTACT_GAP

FIRST_TOUCH_MM = 2e-3  # by which a moulded surface gives way before it bears (rule of thumb)


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any dot whose path was recorded: a force that drives closes the gap first."""
    if scene.path_shown:
        yield _gap(scene)


def _gap(scene: Scene) -> Candidate:
    """Up to half the deepest press."""
    deepest = scene.depth_mm
    coordinate = Coordinate("gap_mm", 0.0, 0.5 * deepest, (0.03 * deepest, 0.15 * deepest))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"gap_mm": values[0]}

    return Candidate(
        CONTACT_GAP.name,
        "dot",
        (coordinate,),
        parameters,
        units={"gap_mm": "mm"},
        everyday={"gap_mm": FIRST_TOUCH_MM},
        stated_as="offset_mm",
    )


register(Vocabulary(CONTACT_GAP, "there is a gap before {} touches", of_segment=of_segment, kind=GIVES_WAY))
