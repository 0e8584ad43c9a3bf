"""Two opinions on the choice: held-out presses, and the fit to all of them."""

from types import SimpleNamespace

import numpy as np

from diagnose.forward import Candidate, Coordinate
from diagnose.inference.choice import contradicted, implausible, likely


def model(score, evidence, p_left=1.0):
    system = SimpleNamespace(informative=np.ones(100, dtype=bool))
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


def test_a_faultless_model_that_is_right_once_in_twenty_is_likely():
    models = [model(5.0, 20.0), model(4.0, 20.0), model(4.0, 20.0, p_left=0.0), model(0.0, 20.0)]
    assert likely(models, np.array([0.8, 0.08, 0.1, 0.02])) == [1]


def at(value, levels_off=(False, False)):
    coordinate = Coordinate("log_time", -0.8, 0.8, (0.4,), levels_off=levels_off)
    law = Candidate("viscoelasticity", "medium2", (coordinate,), lambda _: {})
    return implausible(SimpleNamespace(candidates=(law,), values=np.array([value])))


def test_an_end_of_what_a_part_can_have_is_implausible():
    assert at(0.8) == ("log time = 0.8",)
    assert at(-0.8) == ("log time = −0.8",)
    assert at(0.79) == ()


def test_an_end_beyond_which_the_answer_stays_is_plausible():
    """Relaxation may be faster than what is looked for; slower than every run it is a guess."""
    assert at(-0.8, levels_off=(True, False)) == ()
    assert at(0.8, levels_off=(True, False)) == ("log time = 0.8",)
