"""A seeded source of plausible numbers, with few digits so that a failing design can be read."""

import numpy as np


class Draw:
    """Random choices of one design."""

    def __init__(self, *seed: int) -> None:
        self._random = np.random.default_rng(seed)

    def between(self, low: float, high: float) -> float:
        """A number from low to high."""
        return float(f"{self._random.uniform(low, high):.4g}")

    def log(self, low: float, high: float) -> float:
        """A positive number whose logarithm is even from low to high."""
        return float(f"{np.exp(self._random.uniform(np.log(low), np.log(high))):.4g}")

    def sign(self, low: float, high: float) -> float:
        """A number of either sign whose size is from low to high, so never near zero."""
        return self.among((-1, 1)) * self.log(low, high)

    def whole(self, low: int, high: int) -> int:
        """An integer from low to high."""
        return int(self._random.integers(low, high + 1))

    def among(self, things):
        """One of them."""
        return things[int(self._random.integers(len(things)))]

    def some(self, things):
        """Each of them or not."""
        return [one for one in things if self.perhaps(0.6)]

    def perhaps(self, share: float) -> bool:
        """True in this share of cases."""
        return bool(self._random.random() < share)
