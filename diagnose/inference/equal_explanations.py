"""Which explanations the recordings do not tell from the best one."""

from diagnose.inference.hypotheses import Compared, as_good


def explanations_as_good(found: Compared) -> list[int]:
    """Numbers of the explanations that are not excluded beside the best, which comes first.

    What holds all mechanisms of another one that is not excluded adds nothing to it.
    """
    every = range(len(found.explained))
    good = [n for n in every if n == 0 or as_good(found.judge, found.explained, found.probabilities, n)]
    names = [one.names for one in found.explained]
    return [n for n in good if n == 0 or not any(names[other] < names[n] for other in good)]
