"""Two opinions on the choice: held-out presses, and the fit to all of them."""

from types import SimpleNamespace

import numpy as np

from diagnose.inference.choice import contradicted


def model(score, evidence, p_left=1.0):
    system = SimpleNamespace(live=np.ones(100, dtype=bool))
    fit = SimpleNamespace(candidates=(), values=np.zeros(0), system=system, evidence=evidence)
    forecast = SimpleNamespace(log_scores=np.array([score, score]))
    return SimpleNamespace(fit=fit, forecast=forecast, p_left=p_left, p_strained=1.0)


def test_opinions_that_agree_contradict_nowhere():
    assert not contradicted([model(5.0, 30.0), model(4.0, 20.0), model(1.0, 10.0)]).any()


def test_a_model_that_fits_all_presses_better_than_the_one_that_predicts_best_contradicts_it():
    found = contradicted([model(5.0, 20.0), model(4.0, 30.0), model(1.0, 10.0)])
    assert found.tolist() == [[False, True, False], [True, False, False], [False, False, False]]


def test_a_model_that_leaves_too_much_has_no_say():
    assert not contradicted([model(5.0, 20.0), model(4.0, 30.0, p_left=0.0)]).any()
