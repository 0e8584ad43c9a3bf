"""Which explanations the recordings do not tell from the best one."""

from diagnose.inference.hypotheses import Compared, Hypothesis, as_good


def explanations_as_good(found: Compared) -> list[int]:
    """Numbers of the explanations that are not excluded beside the best, which comes first.

    What holds all mechanisms of another one that is not excluded adds nothing to it.
    """
    every = range(len(found.explained))
    good = [n for n in every if n == 0 or as_good(found.judge, found.explained, found.probabilities, n)]
    return [n for n in good if n == 0 or not _holds_another(found, n, good)]


def _holds_another(found: Compared, number: int, good: list[int]) -> bool:
    own = _names(found.explained[number])
    return any(_names(found.explained[n]) < own for n in good if n != number)


def _names(one: Hypothesis) -> set[tuple[str, str]]:
    return {candidate.name for candidate in one.candidates}
