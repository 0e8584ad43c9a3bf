"""What every package shares: the one exception for bad input, and what a mistyped name was probably meant to be."""

import difflib
from collections.abc import Callable, Iterable


class InputError(ValueError):
    """One clear sentence: the field, its value and what is allowed. The command line exits with 2."""


def nearest(word: str, known: Iterable[str]) -> str:
    """The sentence end "did you mean 'x'?" where something is near, else the list of what is known.

    >>> nearest("thicknes_mm", ["thickness_mm", "material"])
    "did you mean 'thickness_mm'?"
    """
    names = sorted(known)
    near = difflib.get_close_matches(word, names, n=1, cutoff=0.5)
    return f"did you mean '{near[0]}'?" if near else f"known are {', '.join(names)}"


Report = Callable[[str, int, int], None]
"""Told of long work: what, done, of how many."""
