"""Relaxation as a spectrum: two Prony branches a decade of time, as far as the recording can show it.

The coordinates are the branches' moduli over the long-term one, E_i / E_inf = t_i, so that g_i = t_i / (1 + sum t):
any values that are not negative make a valid series. A material with one time that lies between two branches is met
by their sum within 2 % of what relaxes, root mean square over a hold (5 to 8 % with one branch a decade), so that the
times need not be fitted.
"""

from math import ceil

import numpy as np

from diagnose.signals.time_scales import TimeScales
from diagnose.statistics.chi_bar_square import MOST_NON_NEGATIVE

LARGEST_MODULUS_RATIO = 20.0  # of E_i / E_inf: a tape or a gel may relax by 95 % within a decade
SPACING_DECADES = 0.5  # between branches
QUICKEST_SHARE = 0.1  # of a loading: what relaxes faster is gone before it shows


def shortest_time_s(scales: TimeScales, samples: float) -> float:
    """Shortest time of relaxation that shows: a share of the quickest loading, and some samples while it moves."""
    return max(QUICKEST_SHARE * scales.loading_s, samples * scales.step_s)


def relaxation_times(scales: TimeScales, others: int = 0) -> tuple[float, ...]:
    """Relaxation times in s of the branches, from a tenth of the quickest loading to three times the longest run.

    They lie half a decade apart, or farther where the score test takes fewer: others is the number of parameters that
    the candidate has besides. What has not come to rest when the longest run ends would else have to relax within it,
    and what flows already while it is loaded as slowly as that.
    """
    shortest, longest = shortest_time_s(scales, 2.0), 3.0 * scales.lasting_s
    decades = np.log10(longest / shortest)
    count = int(np.clip(ceil(decades / SPACING_DECADES), 1, MOST_NON_NEGATIVE - others))
    spacing = max(SPACING_DECADES, decades / count)
    first = 0.5 * (decades - spacing * (count - 1))
    return tuple(float(shortest * 10.0 ** (first + spacing * n)) for n in range(count))
