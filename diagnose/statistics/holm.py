"""Many candidates: p-values that hold for all of them together, whatever their dependence."""

import numpy as np

from mesh.types import Floats


def holm(p_values: Floats) -> Floats:
    """Step-down Bonferroni p-values (k,) of p-values (k,) (Holm, Scand. J. Stat. 6 (1979) 65)."""
    count = len(p_values)
    order = np.argsort(p_values)
    stepped = np.maximum.accumulate(p_values[order] * np.arange(count, 0, -1))
    adjusted = np.empty(count)
    adjusted[order] = np.minimum(stepped, 1.0)
    return adjusted
