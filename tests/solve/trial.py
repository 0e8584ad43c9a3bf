"""A trial state made by hand, for terms that are tested alone."""

import numpy as np

from solve.terms.base import Trial


def trial(displacement, x=(), time_step=1.0, **others) -> Trial:
    """A state after rest; displacement (n, 3), x (count,)."""
    values = {
        "move": np.zeros(3),
        "drive": 0.0,
        "previous_displacement": np.zeros_like(displacement),
        "previous_move": np.zeros(3),
        "previous_drive": 0.0,
        "time": time_step,
    }
    return Trial(x=np.asarray(x, float), displacement=displacement, time_step=time_step, **{**values, **others})
