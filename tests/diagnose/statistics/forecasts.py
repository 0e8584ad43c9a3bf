"""Held-out forecasts of linear models in one line, for tests."""

import numpy as np
from scipy.stats import t as student

from diagnose.statistics.held_out import forecast, leave_press_out


def linear_forecast(residual, columns, prior_sigma, press):
    """With stated prior deviations (k,)."""
    return forecast(residual, columns, press, lambda _: prior_sigma)


def separation_by_press(one, other, press):
    """Distance in sigma (presses,) between two predictions (n,) of whitened samples."""
    return np.array([np.linalg.norm((one - other)[held]) for _, held in leave_press_out(press)])


def sure_gain(gains, level):
    """Lower bound of the mean of gains (presses,), presses being a sample of many alike: Student's t."""
    return gains.mean() - student.isf(level, len(gains) - 1) * gains.std(ddof=1) / np.sqrt(len(gains))
