"""The judge: how well a model predicts a press that it was not fitted to.

The score of a press is the logarithm of the predictive density at its samples (Good, J. R. Stat. Soc. B 14 (1952) 107;
Gneiting and Raftery, J. Am. Stat. Assoc. 102 (2007) 359), in nats. Gains are differences to a rival on the same press.

A linear Gaussian model in sums: residual = columns @ parameters + white noise, parameters ~ N(0, prior_sigma^2).

Sums over presses add, so that every leave-one-out fit costs one small factorisation (Bishop, Pattern Recognition and
Machine Learning, 2006, sections 3.3 and 3.5).

A second opinion on the choice: Schwarz's criterion, and probabilities of the models.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import Self

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.special import softmax
from scipy.stats import norm

from geometry.arrays import Floats, Ints


@dataclass(frozen=True)
class Sums:
    """gram : (k, k) columns' columns. moment : (k,) columns' residual. square : residual' residual. samples : n."""

    gram: Floats
    moment: Floats
    square: float
    samples: int

    @classmethod
    def of(cls, columns: Floats, residual: Floats) -> Self:
        """From whitened columns (n, k) and residual (n,)."""
        return cls(columns.T @ columns, columns.T @ residual, float(residual @ residual), len(residual))

    def __add__(self, other: "Sums") -> "Sums":
        return Sums(
            self.gram + other.gram, self.moment + other.moment, self.square + other.square, self.samples + other.samples
        )

    def log_evidence(self, prior_sigma: Floats) -> float:
        """Logarithm of the density of the residual with the parameters integrated out.

        prior_sigma : (k,), inf for a parameter without a prior: a flat one of density 1, which cancels in differences.
        ValueError where such a parameter leaves no trace.
        """
        free = np.isinf(prior_sigma)
        factor, scale = self._factor(prior_sigma)
        moment = scale * self.moment
        explained = float(moment @ cho_solve((factor, True), moment))
        log_scale = float(np.log(np.diag(factor)).sum())
        count = self.samples - int(free.sum())
        return -0.5 * (self.square - explained + count * float(np.log(2.0 * np.pi))) - log_scale

    def mean(self, prior_sigma: Floats) -> Floats:
        """Posterior mean (k,) of the parameters; prior_sigma and errors as in log_evidence."""
        factor, scale = self._factor(prior_sigma)
        return np.asarray(scale * cho_solve((factor, True), scale * self.moment))

    def _factor(self, prior_sigma: Floats) -> tuple[Floats, Floats]:
        """Cholesky factor (k, k) of 1 + D X'X D, and the diagonal (k,) of D; no 1 for a parameter without a prior."""
        free = np.isinf(prior_sigma)
        scale = np.where(free, 1.0, prior_sigma)
        precision = np.diag(np.where(free, 0.0, 1.0)) + scale[:, None] * self.gram * scale
        try:
            return np.tril(cho_factor(precision, lower=True)[0]), scale
        except np.linalg.LinAlgError:
            raise ValueError("a parameter without a prior is not determined by these presses") from None


@dataclass(frozen=True)
class Forecast:
    """Every press predicted from the others. log_scores : (presses,). predictions : (n,) expected whitened residual."""

    log_scores: Floats
    predictions: Floats


@dataclass(frozen=True)
class Gain:
    """Nats per press. lower : one-sided confidence bound, corrected for the number of candidates."""

    mean: float
    standard_error: float
    lower: float


def leave_press_out(press: Ints) -> tuple[tuple[Ints, Ints], ...]:
    """(samples to fit, samples held out) for every press; press : (n,) label of each sample."""
    return tuple((np.flatnonzero(press != label), np.flatnonzero(press == label)) for label in np.unique(press))


def sums_by_press(residual: Floats, columns: Floats, press: Ints) -> tuple[Sums, ...]:
    """Sums of each press, in ascending order of its label."""
    return tuple(Sums.of(columns[held], residual[held]) for _, held in leave_press_out(press))


def forecast(residual: Floats, columns: Floats, press: Ints, prior: Callable[[Sums], Floats]) -> Forecast:
    """Predict every press of a residual (n,) by a linear model on columns (n, k) fitted to the others, all whitened.

    prior : deviations (k,) of the parameters, inf for none, from the sums of the fitted presses. ValueError for fewer
    than two presses or where a parameter without a prior shows in one press only.
    """
    folds, parts = leave_press_out(press), sums_by_press(residual, columns, press)
    if len(folds) < 2:
        raise ValueError("one press cannot be held out: at least two are needed")
    scores, predictions = np.empty(len(folds)), np.empty(len(residual))
    for n, (_, held) in enumerate(folds):
        others = reduce(add, parts[:n] + parts[n + 1 :])
        sigma = prior(others)
        scores[n] = (others + parts[n]).log_evidence(sigma) - others.log_evidence(sigma)
        predictions[held] = columns[held] @ others.mean(sigma)
    return Forecast(scores, predictions)


def gain_over_noise(gains: Floats, separations: Floats, level: float, candidates: int = 1) -> Gain:
    """The mean of gains (presses,) on just these presses: what could the noise alone have done to it?

    separations : (presses,) distance in sigma between the two predictions of each press. With predictions a and b and
    white noise the gain |r - b|^2 / 2 - |r - a|^2 / 2 has the variance |a - b|^2, known before the press. For few
    presses of unlike depth and speed, where the scatter over presses is no error.
    """
    error = float(np.linalg.norm(separations)) / len(gains)
    mean = float(gains.mean())
    return Gain(mean, error, mean - float(norm.isf(level / candidates)) * error)


def bic(log_likelihood: float, parameters: int, samples: int) -> float:
    """q ln n - 2 ln L (Schwarz, Ann. Stat. 6 (1978) 461). samples : whitened ones, which are independent."""
    return parameters * float(np.log(samples)) - 2.0 * log_likelihood


def held_out_probabilities(scores: Floats, rng: np.random.Generator, draws: int = 1000) -> Floats:
    """Probabilities (m,) from held-out log-scores (m, presses): pseudo-BMA+ (Yao, Vehtari, Simpson and Gelman 2018).

    A Bayesian bootstrap over presses keeps a lucky press from deciding (Bayesian Analysis 13, 917).
    """
    share = rng.dirichlet(np.ones(scores.shape[1]), draws)
    return np.asarray(softmax(scores.shape[1] * share @ scores.T, axis=1).mean(axis=0))
