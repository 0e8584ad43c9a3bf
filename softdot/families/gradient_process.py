"""A Gaussian process of several outputs from values and slopes: gradient-enhanced kriging.

The covariance is a polynomial (a trend whose size is fitted) and a squared exponential with a length along each axis;
its derivatives are the covariances of slopes (Solak et al., NIPS 15, 2003; Laurent et al., Arch. Comput. Methods Eng.
26, 2019). The outputs share lengths and noise, found by the largest likelihood, and each has a variance of its own. A
point left out with its slopes is predicted from the same factorisation (Dubrule, Math. Geol. 15, 1983).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve, solve_triangular
from scipy.optimize import minimize

from foundation.arrays import Floats

MOST_ITERATIONS = 60


class Prior(NamedTuple):
    """What is assumed before any data. power : of the trend, 1 a line, 2 a quadratic polynomial. The others: least,
    first guess and largest value of each hyperparameter, lengths in the unit of the places, others over the variance.
    """

    power: int = 2
    length: tuple[float, float, float] = (0.3, 3.0, 30.0)
    trend: tuple[float, float, float] = (1e-3, 1.0, 1e3)
    noise: tuple[float, float, float] = (1e-9, 1e-6, 1e-2)
    slope_noise: tuple[float, float, float] = (1e-9, 1e-5, 1e-1)


SMOOTH = Prior()
"""Of presses on one mesh, at places from -1 to 1."""


class Prediction(NamedTuple):
    """Mean and standard deviation (q, m) of every output, and slopes (q, d, m) of the mean by the place."""

    mean: Floats
    deviation: Floats
    slopes: Floats


class LeftOut(NamedTuple):
    """Values (n, m) less their predictions without the point, and the standard deviations of those predictions."""

    error: Floats
    deviation: Floats


@dataclass(frozen=True)
class Scales:
    """Hyperparameters. lengths : (d,); trend, noise, slope_noise : variances over that of the output."""

    lengths: Floats
    trend: float
    noise: float
    slope_noise: float

    @classmethod
    def of(cls, logs: Floats) -> "Scales":
        """From their logarithms (d + 3,)."""
        *lengths, trend, noise, slope_noise = np.exp(logs)
        return cls(np.array(lengths), float(trend), float(noise), float(slope_noise))

    @property
    def logs(self) -> Floats:
        """Their logarithms (d + 3,)."""
        return np.log([*self.lengths, self.trend, self.noise, self.slope_noise])


class GradientProcess:
    """The process through values (n, m) and slopes (n, d, m), None without, at places (n, d).

    scales : hyperparameters where they are known; else they are fitted, from start where that is given, within prior.
    """

    def __init__(
        self,
        places: Floats,
        values: Floats,
        slopes: Floats | None,
        scales: Scales | None = None,
        start: Scales | None = None,
        prior: Prior = SMOOTH,
    ) -> None:
        self.places, self.prior, self.with_slopes = places, prior, slopes is not None
        self._middle = values.mean(axis=0)
        count, axes = places.shape
        self._data = values - self._middle
        if slopes is not None:
            self._data = np.vstack([self._data, slopes.transpose(1, 0, 2).reshape(axes * count, -1)])
        self._is_slope = np.arange(len(self._data)) >= count
        self.scales = scales if scales is not None else self._fitted(start)
        self._factor = cho_factor(self._covariance(self.scales), lower=True)
        self._weights = cho_solve(self._factor, self._data)
        self.variances = np.maximum((self._data * self._weights).sum(axis=0) / len(self._data), 1e-30)

    def predict(self, places: Floats) -> Prediction:
        """Mean, deviation and slopes of the mean at places (q, d)."""
        count = len(places)
        across = self._across(places, slopes=True)
        mean = across @ self._weights
        slopes = mean[count:].reshape(places.shape[1], count, -1).transpose(1, 0, 2)
        return Prediction(self._middle + mean[:count], self._deviation(places, across[:count]), slopes)

    def mean(self, places: Floats) -> Floats:
        """Mean (q, m) alone at places (q, d)."""
        return np.asarray(self._middle + self._across(places) @ self._weights)

    def deviation(self, places: Floats) -> Floats:
        """Standard deviation (q, m) alone at places (q, d)."""
        return self._deviation(places, self._across(places))

    def _across(self, places: Floats, slopes: bool = False) -> Floats:
        """Covariance of values at places (q, d), and of slopes there, with the data."""
        return cross_covariance(places, self.places, self.scales, slopes, self.with_slopes, self.prior.power)

    def _deviation(self, places: Floats, across: Floats) -> Floats:
        """Standard deviation (q, m) from the covariance (q, n) with the data."""
        solved = solve_triangular(self._factor[0], across.T, lower=True)
        share = np.maximum(self._own_variance(places) - np.einsum("ij,ij->j", solved, solved), 0.0)
        return np.asarray(np.sqrt(share[:, None] * self.variances))

    def left_out(self) -> LeftOut:
        """Each point predicted from all others, its slopes left out with it."""
        inverse, count = cho_solve(self._factor, np.eye(len(self._data))), len(self.places)
        errors, shares = [], []
        for point in range(count):
            block = np.arange(point, len(self._data), count)
            covariance = np.linalg.inv(inverse[np.ix_(block, block)])
            errors.append((covariance @ self._weights[block])[0])
            shares.append(covariance[0, 0] - self.scales.noise)
        spread = np.sqrt(np.maximum(shares, 0.0))[:, None] * np.sqrt(self.variances)
        return LeftOut(np.array(errors), spread)

    def _own_variance(self, places: Floats) -> Floats:
        """Variance (q,) of the values before any data, over that of the output."""
        return np.asarray(1.0 + self.scales.trend * (1.0 + (places**2).sum(axis=1)) ** self.prior.power)

    def _covariance(self, scales: Scales) -> Floats:
        """Covariance of the data with noise, over the variance of the output."""
        with_slopes = self.with_slopes
        found = cross_covariance(self.places, self.places, scales, with_slopes, with_slopes, self.prior.power)
        noise = np.where(self._is_slope, scales.slope_noise, scales.noise)
        found[np.diag_indices_from(found)] += noise + 1e-10 * found.diagonal()
        return found

    def _fitted(self, start: Scales | None) -> Scales:
        """Hyperparameters of the largest likelihood."""
        prior = self.prior
        lengths = [prior.length] * self.places.shape[1]
        least, guess, largest = np.log([*lengths, prior.trend, prior.noise, prior.slope_noise]).T
        first = guess if start is None else start.logs
        bounds = np.column_stack([least, largest])
        options = {"maxiter": MOST_ITERATIONS, "maxfun": 100 * MOST_ITERATIONS}
        found = minimize(self._unlikelihood, first, method="L-BFGS-B", bounds=bounds, options=options)
        return Scales.of(np.clip(found.x, least, largest))

    def _unlikelihood(self, logs: Floats) -> float:
        """Negative logarithm of the likelihood over the number of data, the variances profiled out."""
        try:
            factor = cho_factor(self._covariance(Scales.of(logs)), lower=True)
        except np.linalg.LinAlgError:
            return 1e6
        variances = (self._data * cho_solve(factor, self._data)).sum(axis=0) / len(self._data)
        volume = 2.0 * np.log(factor[0].diagonal()).mean()
        return float(0.5 * (volume + np.log(np.maximum(variances, 1e-30)).mean()))


def cross_covariance(
    places: Floats, others: Floats, scales: Scales, slopes: bool, other_slopes: bool, power: int = 2
) -> Floats:
    """Covariance of values at places (q, d), followed by slopes along each axis, with those at others (n, d).

    Over the variance of the output; shape (q or (1 + d) q, n or (1 + d) n). power : of the trend (1 + x . x')^power.
    """
    (count, axes), (other_count, _) = places.shape, others.shape
    inverse = scales.lengths**-2.0
    bent = ((places[:, None] - others[None]) * inverse).transpose(2, 0, 1)  # (d, q, n): less the slope of the exponent
    smooth = np.exp(-0.5 * np.einsum("dqn,dqn,d->qn", bent, bent, scales.lengths**2))
    inner = 1.0 + places @ others.T
    found = np.empty((1 + axes * slopes, count, 1 + axes * other_slopes, other_count))
    found[0, :, 0] = smooth + scales.trend * inner**power
    rising = power * scales.trend * inner ** (power - 1)
    if other_slopes:
        found[0, :, 1:] = (smooth * bent + rising * places.T[:, :, None]).transpose(1, 0, 2)
    if slopes:
        found[1:, :, 0] = rising * others.T[:, None, :] - smooth * bent
    if slopes and other_slopes:
        both = found[1:, :, 1:]
        both[:] = -(smooth * bent)[:, :, None] * bent.transpose(1, 0, 2)[None]
        bending = power * (power - 1) * scales.trend * inner ** max(power - 2, 0)
        both += bending[None, :, None, :] * others.T[:, None, None, :] * places[None, :, :, None]
        for axis in range(axes):
            both[axis, :, axis] += smooth * inverse[axis] + rising
    return found.reshape(found.shape[0] * count, -1)
