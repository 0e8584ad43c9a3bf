"""Which explanations the recordings do not tell from the best one."""

import numpy as np

from diagnose.inference.grades import THRESHOLDS
from diagnose.inference.hypotheses import Compared, Hypothesis

ALIKE = 0.05
"""Share of its own effect by which the forecast of another explanation may differ to be physically the same."""


def explanations_as_good(found: Compared) -> list[int]:
    """Numbers of the explanations that are as good as the best, which comes first.

    One is not excluded where its probability against the best is more than THRESHOLDS.unsure. What holds all mechanisms
    of another one that is not excluded adds nothing to it.
    """
    if not found.explained:
        return []
    chance = found.probabilities[: len(found.explained)]
    good = [n for n in range(len(chance)) if n == 0 or chance[n] > THRESHOLDS.unsure * (chance[0] + chance[n])]
    return [n for n in good if n == 0 or not _holds_another(found, n, good)]


def _holds_another(found: Compared, number: int, good: list[int]) -> bool:
    own = _names(found.explained[number])
    return any(_names(found.explained[n]) < own for n in good if n != number)


def _names(one: Hypothesis) -> set[tuple[str, str]]:
    return {candidate.name for candidate in one.candidates}


def alike(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether two explanations say the same of what was left out, by ALIKE of what they change."""
    apart = float(np.linalg.norm(one.scored.missed - other.scored.missed))
    assert one.fit is not None
    return apart <= ALIKE * float(np.linalg.norm(one.fit.system.effect))
