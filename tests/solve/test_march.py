"""The march from target to target: how it cuts its steps, and what it says when it cannot go on."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from solve.physics import Physics
from solve.setup import set_up
from solve.solution import crushing
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolver
from solve.solution.march import _extrapolate, march, rest_state
from solve.solution.schedule import Target
from solve.system import Load, State
from tests.solve.segments import ridge
from tests.verification.slices import STACK, mesh_of, setup_of, waved


@pytest.fixture(scope="module")
def elastic():
    return setup_of(waved("ramp"), Physics())


@pytest.fixture
def walk(elastic):
    """Walks to 0.2 mm in a second; gives the failure and the times of the converged states."""
    system = elastic.system
    solver = LinearSolver(system.factorisation_shift)

    def go(kink=True):
        start = Target(0.0, Load((0.0, 0.0), 0.0), True)
        past, times = [rest_state(system, solver, start)], []
        failure = march(
            system,
            solver,
            past,
            Target(1.0, Load((0.0, 0.0), elastic.full_drive), True),
            kink,
            lambda state, before: times.append((before.time, state.time)),
        )
        return failure, times, past

    yield go
    solver.close()


def refuse(monkeypatch, longest):
    """Newton fails for steps longer than that."""
    import solve.solution.march as module

    real = module._equilibrate

    def equilibrate(system, linear, past, load, time):
        if time - past[-1].time > longest:
            raise NoEquilibriumError("it does not want to", past[-1].x, None)
        return real(system, linear, past, load, time)

    monkeypatch.setattr(module, "_equilibrate", equilibrate)


def test_an_elastic_step_that_converges_is_one_step(walk):
    failure, times, past = walk()
    assert failure is None
    assert times == [(0.0, 1.0)]
    assert past[-1].load.drive > 0.0


def test_a_step_that_does_not_converge_is_cut_and_still_arrives(walk, monkeypatch):
    refuse(monkeypatch, 0.3)
    failure, times, past = walk()
    assert failure is None
    assert times[0] == (0.0, 0.25)
    assert past[-1].time == pytest.approx(1.0)
    assert all(a == b for (_, a), (b, _) in pairwise(times))


def test_a_long_step_to_an_equilibrium_with_a_folded_element_is_cut(walk, elastic, monkeypatch):
    import solve.solution.march as module

    real, system = module._equilibrate, elastic.system
    top = next(solid for solid in system.solids if solid.name == "effector")
    fold = np.zeros(system.count)
    free = (system.unknowns.displacement[top.tets[:, 0]] >= 0).sum(axis=1)
    nodes = top.tets[int(np.argmax(free))]
    dofs = system.unknowns.displacement[nodes[0]]
    fold[dofs[dofs >= 0]] = 1.6 * (system.points[nodes].mean(axis=0) - system.points[nodes[0]])[dofs >= 0]

    def equilibrate(system, linear, past, load, time):
        state = real(system, linear, past, load, time)
        return replace(state, x=state.x + fold) if time - past[-1].time > 0.3 else state

    monkeypatch.setattr(module, "_equilibrate", equilibrate)
    failure, times, past = walk()
    assert failure is None
    assert max(after - before for before, after in times) <= 0.3
    assert crushing._least_volume(system, past[-1].x) > 0.5
    assert module.crushes(system, past[-1].x, past[-1].x + fold)


def test_it_gives_up_below_the_smallest_sub_step_and_says_why(walk, monkeypatch):
    refuse(monkeypatch, 0.0)
    failure, times, _ = walk()
    assert failure.startswith("sub-steps fell below 1/64 of it: it does not want to; try more load steps")
    assert times == []


def test_what_converged_before_a_failure_is_kept(walk, monkeypatch):
    import solve.solution.march as module

    real = module._equilibrate

    def until_half(system, linear, past, load, time):
        if time > 0.5:
            raise NoEquilibriumError("no further", past[-1].x, None)
        return real(system, linear, past, load, time)

    monkeypatch.setattr(module, "_equilibrate", until_half)
    failure, _, past = walk()
    assert failure.startswith("sub-steps fell below 1/64 of it: no further;")
    assert past[-1].time == 0.5


def test_the_guess_for_the_next_state_is_exact_on_a_line():
    def state(t):
        return State(t, Load((0.0, 0.0), 0.0), np.array([1.0 + t, 3.0 - 2.0 * t]), ())

    np.testing.assert_allclose(_extrapolate(state(0.3), state(0.4), 0.9), state(0.9).x, rtol=1e-13)


@pytest.mark.press
def test_a_dot_that_is_lifted_clear_takes_no_work_that_the_segment_never_held(elastic):
    """Down in eight steps across a gap of 0.07 mm, up in three, the last of which leaves the surface."""
    rest = ridge(STACK)
    away = replace(rest, origin_mm=rest.origin_mm + np.array([0.0, 0.0, 0.07]))
    setup = set_up(elastic.model, away, mesh_of(False), ())
    solver = LinearSolver(setup.system.factorisation_shift)
    shares = [*np.linspace(0.0, 1.0, 9), 0.8, 0.6, 0.0]
    targets = [Target(float(n), Load((0.0, 0.0), share * setup.full_drive), True) for n, share in enumerate(shares)]
    past = [rest_state(setup.system, solver, targets[0])]
    setup.recorder.start(past[0])
    for target in targets[1:]:
        assert march(setup.system, solver, past, target, True, setup.recorder.record) is None
    solver.close()
    trace = setup.recorder.trace(elastic.model.press)
    force, path = trace.contact_force_N[:, 2], trace.dot_path_m
    done = np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(path))
    assert len(path) < 20
    assert done.max() > 0.0
    assert done.min() > -0.05 * done.max()
