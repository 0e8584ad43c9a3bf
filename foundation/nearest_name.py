"""What a mistyped name was probably meant to be."""

import difflib
import re
from collections.abc import Iterable


def nearest(word: str, known: Iterable[str]) -> str:
    """The sentence end "did you mean 'x'?" where something is near, else the list of what is known.

    >>> nearest("thicknes_mm", ["thickness_mm", "material"])
    "did you mean 'thickness_mm'?"
    """
    names = sorted(known)
    best = max(names, key=lambda name: (_likeness(word, name), name), default="")
    return f"did you mean '{best}'?" if _likeness(word, best) >= 0.5 else f"known are {', '.join(names)}"


def _likeness(word: str, name: str) -> float:
    """How alike two names are: letter by letter and by the words that they are made of, whichever is more.

    >>> typed = "feedback_capacitance_pF"
    >>> _likeness(typed, "feedback_pF") > _likeness(typed, "input_capacitance_pF")
    True
    """
    letters = difflib.SequenceMatcher(None, name, word).ratio()
    mine, theirs = set(re.split("[_-]", word)), set(re.split("[_-]", name))
    words = len(mine & theirs) / len(mine | theirs)
    return max(letters, words) + 0.5 * words if len(mine & theirs) > 1 else letters
