"""The recording linearised about nuisances and mechanisms: a residual, its variance, and all that is excused."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from diagnose.forward import Setting
from diagnose.inference import discrepancy
from diagnose.inference.drive_noise import drive_noise
from diagnose.inference.observed_model import ObservedModel
from diagnose.inference.quadratic import Quadratic
from mesh.types import Bools, Floats


@dataclass(frozen=True)
class System:
    """residual = excused @ parameters + noise, each coefficient with its own variance.

    values : (p,) nuisances about which it is linear; the first p columns are their tangents, so that their prior stays
    centred at 0. residual : (n,) recorded - predicted + tangents @ values. variance : (n,) 1 plus what the model may be
    wrong by. excused : (n, k). sigma : (k,) prior deviations. effect : (n,) of the mechanisms, whitened.
    live : (n,) where fits look; elsewhere no sensitivity has any energy.
    """

    values: Floats
    residual: Floats
    numerical: Floats
    formal: Floats
    excused: Floats
    sigma_of_one: Floats
    laws: int
    effect: Floats
    form: float
    live: Bools

    @property
    def variance(self) -> Floats:
        """Of each coefficient, (n,)."""
        return np.asarray(self.numerical + self.form**2 * self.formal)

    @property
    def sigma(self) -> Floats:
        """Prior deviations (k,) of what is excused."""
        sigma = self.sigma_of_one.copy()
        sigma[len(sigma) - self.laws :] *= self.form
        return sigma

    @cached_property
    def weight(self) -> Floats:
        """One over the standard deviation of each coefficient, (n,)."""
        return np.asarray(1.0 / np.sqrt(self.variance))

    def weighted(self, vectors: Floats) -> Floats:
        """Live rows of (n, ...), or live rows themselves, in units of their standard deviation."""
        rows = vectors[self.live] if len(vectors) == len(self.live) else vectors
        weight = self.weight[self.live]
        return np.asarray(rows * (weight if rows.ndim == 1 else weight[:, None]))

    def reached(self, live: Bools) -> "System":
        """The same where only some of its live rows are looked at."""
        return replace(self, excused=self.excused[live[self.live]], live=live)

    def excusing(self, columns: Floats, sigma: Floats) -> "System":
        """The same with more columns (n, k) excused, of prior deviations (k,)."""
        place = len(self.sigma_of_one) - self.laws
        excused = np.hstack([self.excused[:, :place], columns[self.live], self.excused[:, place:]])
        return replace(self, excused=excused, sigma_of_one=np.insert(self.sigma_of_one, place, sigma))

    @cached_property
    def quadratic(self) -> Quadratic:
        """Inner products with all that is excused integrated out."""
        return Quadratic(self.weighted(self.excused), self.sigma)

    def nuisances(self, residual: Floats) -> Floats:
        """Best values (p,) for another residual (n,) of the same system."""
        return self.quadratic.mean(self.weighted(residual))[: len(self.values)]

    def closest(self) -> Floats:
        """Nuisances (p,) that come closest to the recording under their priors, were the model exact.

        What a prediction is made with: beside its stated errors, which predict nothing, gains would be shrunk.
        """
        own = slice(len(self.values))
        return Quadratic(self.weighted(self.excused[:, own]), self.sigma[own]).mean(self.weighted(self.residual))


def relative(model: ObservedModel) -> list[float]:
    """The engine's own error of each channel."""
    accuracy = model.engine.accuracy
    kinds = {"V": "voltage_V", "N": "force_N", "mm": "displacement_mm"}
    return [float(accuracy.get(kinds[name.rpartition("_")[2]], 0.0)) for name in model.samples.channels]


def linearised(
    model: ObservedModel, values: Floats, settings: Sequence[Setting] = (), form: float = 0.0, live: Bools | None = None
) -> System:
    """About nuisances (p,) and mechanisms; form : relative error of their effect."""
    samples, own = model.samples, relative(model)
    shown = model.signals(values, settings)
    predicted = samples.coefficients(shown)
    tangents = model.tangents(values, settings)
    numerical, numerical_sigma = discrepancy.columns(samples, shown, own)
    excused, sigma = [tangents, numerical], [model.sigma, numerical_sigma]
    effect, formal, laws = np.zeros(len(samples)), np.zeros(len(samples)), 0
    if settings:
        without = model.signals(values)
        effect = predicted - samples.coefficients(without)
        ones = [1.0] * len(samples.channels)
        change = [{name: a[name] - b[name] for name in a} for a, b in zip(shown, without, strict=True)]
        columns, deviations = discrepancy.columns(samples, change, ones)
        excused, sigma, laws = [*excused, columns], [*sigma, deviations], len(deviations)
        formal = discrepancy.allowance(samples, effect, ones)
    return System(
        values,
        samples.recorded - predicted + tangents @ values,
        1.0 + discrepancy.allowance(samples, predicted, own) + drive_noise(samples, shown),
        formal,
        np.column_stack([columns if live is None else columns[live] for columns in excused]),
        np.concatenate(sigma),
        laws,
        effect,
        form,
        np.ones(len(samples), dtype=bool) if live is None else live,
    )
