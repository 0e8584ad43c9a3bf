"""White noise of a curve that has neither rest nor repeats, to be stated in rig.toml."""

import numpy as np

from mesh.types import Floats


def white_noise(values: Floats) -> float:
    """One sigma from third differences of (t,), which a curve that is smooth over four samples hardly has.

    von Neumann, Annals of Mathematical Statistics 12 (1941) 367, for the first difference; the third has the weights
    1, -3, 3, -1 and 20 times the variance. It knows nothing of slow noise.
    """
    return float(np.sqrt(np.mean(np.diff(values, 3) ** 2) / 20.0))
