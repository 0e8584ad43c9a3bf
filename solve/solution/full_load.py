"""A press at its full load where the path there does not matter: its answer, derivatives of it, and similar presses.

Without memory an equilibrium depends on the load alone. All derivatives then follow from the tangent at full load,
one linear solution each (see solve.solution.sensitivity), and a press that differs a little is a few Newton steps away.
"""

from collections.abc import Mapping
from itertools import pairwise
from typing import NamedTuple

from foundation.arrays import Floats
from geometry.dot_at_rest import resolve_dot
from mesh.morphing import morphed_mesh
from mesh.types import TetMesh
from solve.model import Model
from solve.recorder import Recorder
from solve.setup import Setup, discretise, set_up
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolver
from solve.solution.march import march, rest_state
from solve.solution.schedule import Target
from solve.solution.sensitivity import Variation, update_pair, varied_systems
from solve.solution.similar_press import Equilibria, reach
from solve.symmetry import planes_of
from solve.system import State


class StoppedShortError(RuntimeError):
    """A press did not reach its full load."""


class FullResponse(NamedTuple):
    """Force in N and open-circuit voltage in V of all electrodes in parallel and (e,) of each alone, or derivatives."""

    force: float
    voltage: float
    electrode_voltages: Floats


class FullLoad:
    """A press under its full load, before any slide; answer : what it gives.

    ValueError for a model whose path matters, InputError as press_segment, StoppedShortError.
    """

    def __init__(self, model: Model, tet_mesh: TetMesh) -> None:
        if model.follows_time:
            raise ValueError("the path of this press matters")
        self._tet_mesh = tet_mesh
        self._base = discretise(model, tet_mesh, resolve_dot(model.dot, model.segment))
        self._linear = LinearSolver(self._base.system.factorisation_shift)
        self._rest_state = _rest_state(self._base, self._linear)
        past, system, recorder = [self._rest_state], self._base.system, self._base.recorder
        for before, target in pairwise(_targets(self._base)):
            _raise_if_stopped(march(system, self._linear, past, target, before.kink, recorder.record))
        self._state = past[-1]
        self.answer = _last_response(self._base)

    def derivatives(self, variations: Mapping[str, Variation]) -> dict[str, FullResponse]:
        """Derivatives of the answer by each parameter. ValueError for one that changes the mesh or the unknowns."""
        base, system, found = self._base, self._base.system, {}
        trial = system.trial(self._state.x, self._state.load, self._state.time, self._rest_state)
        tangent = system.evaluate(trial, self._rest_state.histories).tangent
        for number, (name, variation) in enumerate(variations.items()):
            pair = varied_systems(name, variation, base)
            for side in pair:
                side.start(self._rest_state)
            update_pair(pair, self._linear, tangent, self._state, similar=number > 0)
            below, above = (_last_response(side.setup) for side in pair)
            found[name] = FullResponse(
                (above.force - below.force) / variation.span,
                (above.voltage - below.voltage) / variation.span,
                (above.electrode_voltages - below.electrode_voltages) / variation.span,
            )
        return found

    def similar_answer(self, model: Model) -> FullResponse:
        """Answer of a similar model on the same mesh, moved to its sizes; solved from rest where that is too far.

        ValueError, StoppedShortError.
        """
        if model.follows_time:
            raise ValueError("the path of this press matters")
        dot, base = resolve_dot(model.dot, model.segment), self._base
        if set(base.tet_mesh.planes) <= set(planes_of(model, dot)):
            moved = morphed_mesh(base.tet_mesh, base.model.segment, model.segment)
            setup = set_up(model, dot, moved, base.opened, base.system)
            guess = self._state.x if setup.system.count == base.system.count else None
        else:
            setup = discretise(model, morphed_mesh(self._tet_mesh, base.model.segment, model.segment), dot)
            found = Equilibria.of(base.system, base.tet_mesh, [(1.0, self._state.x)])
            course = found.unfold(setup.unfolded).course(setup.system, setup.tet_mesh)
            guess = None if course is None else course.unknowns[0]
        linear = LinearSolver(setup.system.factorisation_shift)
        past, last = [_rest_state(setup, linear)], _targets(setup)[-1]
        rest = past[0]
        _raise_if_stopped(reach(setup.system, linear, past, last, True, guess))
        linear.close()
        setup.recorder.record(past[-1], rest)
        return _last_response(setup)

    def close(self) -> None:
        """Give the memory of the factorisation back."""
        self._linear.close()


def _targets(setup: Setup) -> list[Target]:
    """Loads from rest to the full load."""
    return setup.targets(follows_time=False)[: setup.model.press.load_steps + 1]


def _rest_state(setup: Setup, linear: LinearSolver) -> State:
    try:
        rest = rest_state(setup.system, linear, _targets(setup)[0])
    except NoEquilibriumError as error:
        raise StoppedShortError(f"the prestretched film at rest has no equilibrium: {error}") from error
    setup.recorder.start(rest)
    return rest


def _raise_if_stopped(failure: str | None) -> None:
    if failure is not None:
        raise StoppedShortError(failure)


def _last_response(setup: Setup) -> FullResponse:
    """Force and open-circuit voltages in the last recorded state."""
    recorder: Recorder = setup.recorder
    trace = recorder.trace(setup.model.press)
    charge, capacitance = trace.film_charge_C[-1], recorder.capacitance_F
    together = float(charge.sum()) / float(capacitance.sum())
    return FullResponse(float(trace.reaction_force_N[-1]), together, charge / capacitance)
