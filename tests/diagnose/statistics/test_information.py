"""Probabilities of models."""

import numpy as np
import pytest

from diagnose.statistics.model_criteria import held_out_probabilities


def test_one_lucky_press_does_not_decide():
    """The same total gain: even over presses it is nearly certain, from one press alone it is not."""
    even, lucky = np.full(10, 1.5), np.zeros(10)
    lucky[0] = 15.0
    sure = held_out_probabilities(np.array([even, np.zeros(10)]), np.random.default_rng(72))
    unsure = held_out_probabilities(np.array([lucky, np.zeros(10)]), np.random.default_rng(72))
    assert sure[0] > 0.999
    assert 0.8 < unsure[0] < 0.99
    assert unsure.sum() == pytest.approx(1.0)
