"""The known name that a mistyped one was probably meant to be."""

import difflib
import re
from collections.abc import Iterable


def nearest_name_hint(word: str, known: Iterable[str]) -> str:
    """Return "did you mean 'x'?" where a known name is near the word, else the list of known names.

    >>> nearest_name_hint("thicknes_mm", ["thickness_mm", "material"])
    "did you mean 'thickness_mm'?"
    """
    names = sorted(known)
    best = max(names, key=lambda name: (_likeness(word, name), name), default="")
    return f"did you mean '{best}'?" if _likeness(word, best) >= 0.5 else f"known are {', '.join(names)}"


def _likeness(word: str, name: str) -> float:
    """Return how alike two names are, 0 to 1.5: the larger of the share of equal letters and a score of common words.

    >>> typed = "feedback_capacitance_pF"
    >>> _likeness(typed, "feedback_pF") > _likeness(typed, "input_capacitance_pF")
    True
    """
    letters = difflib.SequenceMatcher(None, name, word).ratio()
    mine, theirs = set(re.split("[_-]", word)), set(re.split("[_-]", name))
    words = len(mine & theirs) / len(mine | theirs)
    return max(letters, words) + 0.5 * words if len(mine & theirs) > 1 else letters
