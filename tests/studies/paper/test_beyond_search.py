"""The search finds what it should where the answer is known, and the comparison is strict."""

from dataclasses import replace

import numpy as np
import pytest

from foundation.executor import HERE
from softdot.progress import Logged
from softdot.studies.paper.beyond import search as searching
from softdot.studies.paper.beyond.comparison import beats
from softdot.studies.paper.beyond.designs import PAPERS, coordinates, sample
from softdot.studies.paper.beyond.search import GOALS, capacitance_pF, limits_of, to_beat
from softdot.studies.paper.beyond.surrogate import Surrogate
from softdot.studies.paper.beyond.trials import DesignPress, DesignTrial
from tests.cases import for_each
from tests.studies.paper import stand_in_beyond as stand_in


def trial(free_V, clamped_V, force_N=1.0, stress_MPa=10.0, capacitance_pF=25.0):
    free, clamped = (
        DesignPress(force_N, volts, volts * capacitance_pF, capacitance_pF, stress_MPa) for volts in (free_V, clamped_V)
    )
    return DesignTrial(PAPERS, free, clamped)


def test_the_worse_boundary_counts():
    assert trial(5.0, 80.0).worse_V() == 5.0
    assert trial(50.0, 8.0).worse_V() == 8.0


def test_a_cable_shares_out_the_charge():
    assert trial(5.0, 80.0, capacitance_pF=25.0).worse_V(75.0) == pytest.approx(5.0 / 4.0)


def test_a_better_design_must_keep_force_and_film_stress():
    papers = trial(5.0, 80.0)
    assert beats(trial(6.0, 70.0), papers)
    assert not beats(trial(5.0, 90.0), papers)
    assert not beats(trial(6.0, 70.0, force_N=1.01), papers)
    assert not beats(trial(6.0, 70.0, stress_MPa=10.1), papers)


def test_the_best_design_keeps_the_limits():
    papers = trial(5.0, 80.0)
    within, beyond = trial(6.0, 70.0, 0.8, 8.0), trial(60.0, 70.0, 1.0, 10.1)
    assert to_beat([papers, beyond, within], limits_of(papers), 0.0) is within


def test_the_paper_s_design_stands_until_it_is_beaten():
    papers = trial(5.0, 80.0)
    assert to_beat([papers, trial(4.9, 90.0, 0.8, 8.0)], limits_of(papers), 0.0) is papers


def test_yield_is_a_limit_of_its_own():
    assert limits_of(trial(5.0, 80.0, stress_MPa=500.0)).film_stress_MPa < 50.0


def test_the_surrogate_knows_what_it_was_told():
    known = stand_in.trials(sample(5, 7))
    surrogate = Surrogate(known, stand_in.CONSTANTS)
    guess = surrogate.draw([each.design for each in known], 200, seed=0)
    volts = np.median(guess.charge_pC, axis=1) / capacitance_pF([each.design for each in known])
    assert volts[0] == pytest.approx([each.free.voltage_V for each in known], rel=0.15)
    assert volts[1] == pytest.approx([each.clamped.voltage_V for each in known], rel=0.15)


def test_the_surrogate_is_less_sure_far_from_what_it_knows():
    known = stand_in.trials([design for design in sample(5, 7) if design.h1_mm < 0.8])
    surrogate = Surrogate(known, stand_in.CONSTANTS)
    near, far = known[0].design, replace(known[0].design, h1_mm=4.0)
    spread = np.log(surrogate.draw([near, far], 200, seed=0).force_N).std(axis=1)
    assert np.all(spread[:, 1] > spread[:, 0])


@pytest.fixture(scope="module")
def found():
    """A search in which the corrected parameters play the solver."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(searching, "solve_trials", lambda designs, *_: stand_in.trials(designs))
        return searching.search(Logged(), HERE, stand_in.CONSTANTS)


@pytest.mark.evidence
@for_each("goal", GOALS)
def test_the_search_finds_what_many_times_as_many_random_designs_find(found, goal):
    best, crowd = found.best(goal), stand_in.trials(sample(11, 99))
    assert best is found.papers or found.limits.allow(best)
    assert best.worse_V(GOALS[goal]) > 0.95 * to_beat([found.papers, *crowd], found.limits, GOALS[goal]).worse_V(
        GOALS[goal]
    )


@pytest.mark.evidence
def test_no_design_is_tried_twice(found):
    points = coordinates([each.design for each in found.trials])
    apart = np.linalg.norm(points[:, None] - points[None], axis=2) + 10 * np.eye(len(points))
    assert apart.min() > 0.9 * searching.APART
