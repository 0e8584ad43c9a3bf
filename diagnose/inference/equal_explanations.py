"""Which explanations the recordings do not tell from the best one."""

from diagnose.inference.grades import THRESHOLDS
from diagnose.inference.held_out_scores import USUAL_SHAPE
from diagnose.inference.hypotheses import Compared, Hypothesis


def explanations_as_good(found: Compared) -> list[int]:
    """Numbers of the explanations that are as good as the best, which comes first.

    One is not excluded where its probability against the best is more than THRESHOLDS.rival, nor where its forecast
    differs by no more than those of two good codes. What holds all mechanisms of another one that is not excluded adds
    nothing to it.
    """
    good = [n for n in range(len(found.explained)) if n == 0 or _is_as_good(found, n)]
    return [n for n in good if n == 0 or not _holds_another(found, n, good)]


def _is_as_good(found: Compared, number: int) -> bool:
    best, one = found.explained[0], found.explained[number]
    chance, rival = float(found.probabilities[0]), float(found.probabilities[number])
    return rival > THRESHOLDS.rival * (chance + rival) or found.judge.apart(best, one) < USUAL_SHAPE


def _holds_another(found: Compared, number: int, good: list[int]) -> bool:
    own = _names(found.explained[number])
    return any(_names(found.explained[n]) < own for n in good if n != number)


def _names(one: Hypothesis) -> set[tuple[str, str]]:
    return {candidate.name for candidate in one.candidates}
