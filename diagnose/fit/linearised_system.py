"""The recording linearised about nuisances and mechanisms: a residual, its variance, a design matrix."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from diagnose.fit import discrepancy
from diagnose.fit.drive_noise import drive_noise_variance
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.observed_model import ObservedModel
from diagnose.forward import Setting
from foundation.arrays import Bools, Floats


@dataclass(frozen=True)
class LinearisedSystem:
    """residual = nuisance_design @ parameters + noise, each of n coefficients with its own variance.

    values : (p,) nuisances about which it is linear; the first p columns are their tangents, so that their prior stays
    centred at 0. residual : (n,) recorded - predicted + tangents @ values. numerical : (n,) variance of noise and of
    the engine's own error. unit_form_variance : (n,) variance for a model-form error of 1. nuisance_design : (n, k).
    sigma_of_one : (k,) prior deviations for a model-form error of 1, which scales the last `laws` of them. effect :
    (n,) of the mechanisms, whitened. form_error : relative error of their effect. informative : (n,) flags of
    coefficients at which fits look; elsewhere no sensitivity has any energy.
    """

    values: Floats
    residual: Floats
    numerical: Floats
    unit_form_variance: Floats
    nuisance_design: Floats
    sigma_of_one: Floats
    laws: int
    effect: Floats
    form_error: float
    informative: Bools

    @property
    def variance(self) -> Floats:
        """Variance (n,) of each coefficient, 1 for noise alone."""
        return np.asarray(self.numerical + self.form_error**2 * self.unit_form_variance)

    @property
    def sigma(self) -> Floats:
        """Prior deviations (k,) of the nuisance parameters."""
        sigma = self.sigma_of_one.copy()
        sigma[len(sigma) - self.laws :] *= self.form_error
        return sigma

    @cached_property
    def weight(self) -> Floats:
        """Inverse standard deviation (n,) of each coefficient."""
        return np.asarray(1.0 / np.sqrt(self.variance))

    def weighted_rows(self, vectors: Floats) -> Floats:
        """Informative rows of vectors (n, ...) in units of their standard deviation.

        Vectors may also have the informative rows alone.
        """
        rows = vectors[self.informative] if len(vectors) == len(self.informative) else vectors
        weight = self.weight[self.informative]
        return np.asarray(rows * (weight if rows.ndim == 1 else weight[:, None]))

    def restricted_to(self, informative: Bools) -> "LinearisedSystem":
        """This system where only some of its informative rows, (n,) flags, are looked at."""
        return replace(
            self, nuisance_design=self.nuisance_design[informative[self.informative]], informative=informative
        )

    def with_nuisance_columns(self, columns: Floats, sigma: Floats) -> "LinearisedSystem":
        """This system with more nuisance columns (n, k), of prior deviations (k,)."""
        place = len(self.sigma_of_one) - self.laws
        nuisance_design = np.hstack(
            [self.nuisance_design[:, :place], columns[self.informative], self.nuisance_design[:, place:]]
        )
        return replace(self, nuisance_design=nuisance_design, sigma_of_one=np.insert(self.sigma_of_one, place, sigma))

    @cached_property
    def quadratic(self) -> Quadratic:
        """Inner products on the informative rows, with all nuisance parameters integrated out."""
        return Quadratic(self.weighted_rows(self.nuisance_design), self.sigma)

    def best_nuisances(self, residual: Floats) -> Floats:
        """Best nuisances (p,) for another residual (n,) of the same system."""
        return self.quadratic.mean(self.weighted_rows(residual))[: len(self.values)]

    def closest_nuisances(self) -> Floats:
        """Nuisances (p,) that come closest to the recording under their priors, were the model exact.

        Predictions are made with them: beside the stated errors of the model, which predict nothing, gains would be
        shrunk.
        """
        own = slice(len(self.values))
        return Quadratic(self.weighted_rows(self.nuisance_design[:, own]), self.sigma[own]).mean(
            self.weighted_rows(self.residual)
        )


def engine_errors(model: ObservedModel) -> list[float]:
    """Relative error of the engine in each channel, one sigma, in the order of the samples' channels."""
    accuracy = model.engine.accuracy
    kinds = {"V": "voltage_V", "N": "force_N", "mm": "displacement_mm"}
    return [float(accuracy.get(kinds[name.rpartition("_")[2]], 0.0)) for name in model.samples.channels]


def linearise(
    model: ObservedModel,
    values: Floats,
    settings: Sequence[Setting] = (),
    form_error: float = 0.0,
    informative: Bools | None = None,
) -> LinearisedSystem:
    """System linear about nuisances (p,) and mechanisms. form_error : relative error of the mechanisms' effect.

    informative : (n,) flags of rows to look at, all if None. ValueError where the engine has no answer.
    """
    samples, own = model.samples, engine_errors(model)
    shown = model.signals(values, settings)
    predicted = samples.coefficients(shown)
    tangents = model.tangents(values, settings)
    film = discrepancy.error_scale_signals(shown)
    numerical, numerical_sigma = discrepancy.smooth_columns(samples, film, own)
    own_error = discrepancy.rough_variance(samples, samples.coefficients(film), own)
    nuisance_design, sigma = [tangents, numerical], [model.sigma, numerical_sigma]
    effect, unit_form_variance, laws = np.zeros(len(samples)), np.zeros(len(samples)), 0
    if settings:
        without = model.signals(model.answerable_nuisances(np.zeros(len(values)), values, ()))
        effect = predicted - samples.coefficients(without)
        ones = [1.0] * len(samples.channels)
        change = [{name: a[name] - b[name] for name in a} for a, b in zip(shown, without, strict=True)]
        columns, deviations = discrepancy.smooth_columns(samples, change, ones)
        nuisance_design, sigma, laws = [*nuisance_design, columns], [*sigma, deviations], len(deviations)
        unit_form_variance = discrepancy.rough_variance(samples, effect, ones)
    return LinearisedSystem(
        values,
        samples.recorded_vector - predicted + tangents @ values,
        1.0 + own_error + drive_noise_variance(samples, shown) + model.tolerance,
        unit_form_variance,
        np.column_stack([columns if informative is None else columns[informative] for columns in nuisance_design]),
        np.concatenate(sigma),
        laws,
        effect,
        form_error,
        np.ones(len(samples), dtype=bool) if informative is None else informative,
    )
