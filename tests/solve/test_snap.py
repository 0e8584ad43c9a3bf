"""Past a limit point: a shallow truss of two bars under a force, whose equilibria are the roots of a cubic.

Bars of half span 1 and of a small rise h: the apex, moved down by u, resists with f(u) = u (h - u) (2 h - u), as bars
of unit stiffness do (von Mises' truss, shallow: Crisfield, Non-linear Finite Element Analysis 1, 1991, section 1.2).
Its limit point is at u = h (1 - 1 / sqrt 3).
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp

import solve.solution.march as marching
from solve.convergence_warnings import convergence_warnings
from solve.fem.tangent import Tangent
from solve.solution.continuation import snap
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolver
from solve.solution.schedule import Target
from solve.system import Evaluation, Load, State, System
from solve.terms.solid import InvertedElementError

RISE = 0.3
LIMIT = RISE * (1.0 - 1.0 / np.sqrt(3.0))


def resistance(u):
    return u * (RISE - u) * (2.0 * RISE - u)


class Truss(System):
    """One displacement, the apex; the drive is the force. No bar may be deeper than `floor`."""

    floor = np.inf

    def __init__(self):
        object.__setattr__(self, "unknowns", SimpleNamespace(displacement=np.array([[0]]), approach=0))

    mechanical = np.array([0])
    force_driven = False
    terms = ()
    contact = SimpleNamespace(facets=np.zeros((0, 6), dtype=int))

    def trial(self, x, load, time, previous, damped=False):
        return x[0], load.drive

    def time_error(self, state, new, after_kink):
        return 0.0

    def evaluate(self, trial, histories):
        u, force = trial
        if u > self.floor:
            raise InvertedElementError("bar", np.array([0]))
        stiffness = 2.0 * RISE**2 - 6.0 * RISE * u + 3.0 * u**2
        tangent = Tangent(sp.csr_matrix([[stiffness]]))
        return Evaluation(np.array([resistance(u) - force]), tangent, abs(force), np.zeros(0, bool), True)


class Floored(Truss):
    floor = RISE


@pytest.fixture
def linear():
    solver = LinearSolver(np.zeros(1))
    yield solver
    solver.close()


def at(u):
    return State(0.0, Load((0.0, 0.0), resistance(u)), np.array([u]), (), force_scale=resistance(LIMIT))


def test_above_the_limit_load_the_apex_falls_to_the_far_equilibrium(linear):
    load = Load((0.0, 0.0), 1.01 * resistance(LIMIT))
    state = snap(Truss(), linear, load, 1.0, at(0.99 * LIMIT))
    far = max(np.roots([1.0, -3.0 * RISE, 2.0 * RISE**2, -load.drive]).real)
    assert state.snapped
    assert state.x[0] == pytest.approx(far, rel=1e-8)
    assert state.x[0] > 2.0 * RISE


def test_below_the_limit_load_it_stays_with_the_near_one(linear):
    load = Load((0.0, 0.0), 0.99 * resistance(LIMIT))
    state = snap(Truss(), linear, load, 1.0, at(0.8 * LIMIT))
    near = min(np.roots([1.0, -3.0 * RISE, 2.0 * RISE**2, -load.drive]).real)
    assert state.x[0] == pytest.approx(near, rel=1e-8)


def test_what_falls_where_nothing_can_hold_it_has_no_equilibrium(linear):
    load = Load((0.0, 0.0), 1.01 * resistance(LIMIT))
    with pytest.raises(NoEquilibriumError, match=r"no equilibrium in \d+ damped steps either"):
        snap(Floored(), linear, load, 1.0, at(0.99 * LIMIT))


def test_a_press_that_snapped_says_at_which_depths():
    step = SimpleNamespace(indentation_m=3e-4, fields=SimpleNamespace(gap_m=np.zeros(1)))
    records = [
        SimpleNamespace(
            indentation_m=depth, dot_path_m=depth, time_error=0.0, snapped=snap, time_s=depth, contact_area_m2=1e-8
        )
        for depth, snap in ((1e-4, False), (2e-4, True), (3e-4, True))
    ]
    (said,) = convergence_warnings([step], records)
    assert said.startswith("at 0.200, 0.300 mm something snapped: ")
    assert convergence_warnings([step], records[:1]) == ()


def test_a_press_may_snap_and_a_table_over_depth_may_not(monkeypatch):
    """Newton fails at every step; what it would fall into is the state it comes from."""

    def fails(*_):
        raise NoEquilibriumError("it does not want to", np.zeros(1), None)

    def falls(_system, _linear, load, time, last):
        return replace(last, time=time, load=load, snapped=True)

    monkeypatch.setattr(marching, "_equilibrate", fails)
    monkeypatch.setattr(marching, "snap", falls)
    monkeypatch.setattr(marching, "explain_failure", lambda *_: "no")
    monkeypatch.setattr(marching, "rim_met", lambda *_: None)
    monkeypatch.setattr(marching, "with_work", lambda *given: given[-1])
    target, arrived = Target(1.0, Load((0.0, 0.0), 1.0), True), list[State]()

    def on_state(*states):
        arrived.append(states[0])

    assert marching.march(Truss(), SimpleNamespace(), [at(0.0)], target, True, on_state).startswith(
        "sub-steps fell below 1/64"
    )
    assert arrived == []
    assert marching.march(Truss(), SimpleNamespace(), [at(0.0)], target, True, on_state, may_snap=True) is None
    assert arrived[-1].time == 1.0
    assert all(state.snapped for state in arrived)
