"""The stated error rates and limits of a diagnosis. None of them was fitted to a recording."""

from dataclasses import dataclass

from diagnose.statistics.proportions import rate_for_promise


@dataclass(frozen=True)
class Rates:
    """Error rates and limits that decide on a name.

    level : chance per case of each kind of false alarm (proportions.rate_for_promise gives it from a promise).
    largest_group : number of models that may stay indistinguishable.
    """

    level: float
    largest_group: int


RATES = Rates(rate_for_promise(4, 400), largest_group=3)
"""At most 4 false names in 400 cases without effect, with 99 % confidence."""
LARGEST_FORM_SHARE = 0.1
"""Share of the excess that the model-form error may account for; an effect that nuisances cancel has none."""
MOST_FINALISTS = 6
"""Number of single mechanisms that are fitted with all that floats, after a first fit of all survivors."""
MOST_PAIRS_PER_FIRST = 4
"""Number of pairs that are fitted for each of those beside which a second mechanism is sought."""
