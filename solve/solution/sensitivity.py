"""Derivatives of a whole press by any parameter, by direct differentiation along the march.

The state of a step obeys R(x, history, p) = 0. Differentiated, with the converged tangent K,
    K dx/dp = -(R(x, history + e dhistory, p + e) - R(x, history - e dhistory, p - e)) / 2e,
and the new memory follows from the terms' own advance at x +- e dx. Each parameter so carries two systems, at
p + e and p - e, whose states stay within first order of their equilibria; one factorisation serves all of them.
The difference quotient of the residual makes this the semi-analytical method (Tsay and Arora, Comput. Methods Appl.
Mech. Eng. 81, 1990, for path dependence; van Keulen, Haftka and Kim, ibid. 194, 2005): no law states derivatives of
its own.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

import numpy as np

from foundation.arrays import Floats
from geometry.dot_at_rest import resolve_dot
from mesh.morphing import morphed_mesh
from mesh.types import TetMesh
from solve.fem.tangent import Tangent
from solve.model import Model, Press
from solve.readout.course import PressCourse, common_readout_V, course
from solve.result import PressResult, Trace
from solve.setup import Setup, discretise, set_up
from solve.solution.linear import LinearSolveError, LinearSolver
from solve.solution.march import march, rest_state
from solve.system import Load, State
from solve.terms.solid import InvertedElementError


@dataclass(frozen=True)
class Variation:
    """A parameter by its models a little below and above, apart by span in the unit of the parameter."""

    below: Model
    above: Model
    span: float


@dataclass(frozen=True)
class Slopes:
    """Derivatives of a press by one parameter: of its trace, whose time_s holds the times themselves; of the
    open-circuit voltage (t,) of all electrodes in parallel; and of the voltage behind the amplifier (t,), None
    without one.
    """

    trace: Trace
    open_circuit_voltage_V: Floats
    readout_voltage_V: Floats | None


class VariedSystem:
    """A system at p + e or p - e, and the state that follows the base to first order."""

    def __init__(self, setup: Setup, drive_ratio: float) -> None:
        self.setup, self.drive_ratio = setup, drive_ratio
        self.state: State | None = None

    def load(self, base: Load) -> Load:
        """The load at this parameter."""
        return replace(base, drive=base.drive * self.drive_ratio)

    def start(self, base: State) -> None:
        """Begin at rest."""
        self.state = replace(base, load=self.load(base.load), histories=self.setup.system.at_rest(base.load).histories)
        self.setup.recorder.start(self.state)

    def ahead(self, other: "VariedSystem") -> Floats:
        """Difference (count,) of the unknowns of two systems."""
        assert self.state is not None
        assert other.state is not None
        return self.state.x - other.state.x

    def residual(self, x: Floats, base: State) -> Floats:
        """Residual (count,) of the base's unknowns under this parameter and this memory. LinearSolveError where an
        element is so nearly flat that it turns over a little beside them.
        """
        assert self.state is not None
        trial = self.setup.system.trial(x, self.load(base.load), base.time, self.state, base.is_damped)
        try:
            return self.setup.system.evaluate(trial, self.state.histories).residual
        except InvertedElementError as error:
            raise LinearSolveError(
                f"the press cannot be differentiated: {error} a little beside the solved state; smaller elements or a "
                "smaller press help"
            ) from None

    def history(self, base: PressCourse, press: Press) -> Slopes:
        """Histories at this parameter, not yet derivatives; the read-out on the times of the base's course.

        press : the base's, whose waveform gives the times.
        """
        model, recorder = self.setup.model, self.setup.recorder
        trace, capacitance = recorder.trace(model.press), float(recorder.capacitance_F.sum())
        open_circuit = trace.film_charge_C.sum(axis=1) / capacitance
        read = common_readout_V(trace, recorder.capacitance_F, press, model.amplifier, model.physics, base.time_s)
        if read is None:
            return Slopes(trace, open_circuit, None)
        return Slopes(trace, open_circuit, read[np.searchsorted(base.time_s, trace.time_s)])

    def follow(self, x: Floats, base: State) -> None:
        """Take the step to the unknowns x (count,)."""
        assert self.state is not None
        load = self.load(base.load)
        trial = self.setup.system.trial(x, load, base.time, self.state, base.is_damped)
        new = State(base.time, load, x, self.setup.system.advance(trial, self.state.histories))
        self.setup.recorder.record(new, self.state)
        self.state = new


def press_with_sensitivities(
    model: Model, variations: Mapping[str, Variation], tet_mesh: TetMesh
) -> tuple[PressResult, dict[str, Slopes]]:
    """Solve a press and its derivatives by every variation, along its waveform; tet_mesh : of the model's segment.

    Of a press that stops short they end where it does. ValueError for a parameter that changes the mesh or the number
    of unknowns; InputError as press_segment.
    """
    varied = [changed for variation in variations.values() for changed in (variation.below, variation.above)]
    base = discretise(model, tet_mesh, resolve_dot(model.dot, model.segment), varied)
    pairs = {name: varied_systems(name, variation, base) for name, variation in variations.items()}
    linear = LinearSolver(base.system.factorisation_shift)
    failure = _march(base, linear, pairs)
    linear.close()
    result = base.recorder.result(failure, linear.name, model.press, follows_time=True)
    along = course(result, model.press, model.amplifier, model.physics)
    slopes = {}
    for name, pair in pairs.items():
        low, high = (side.history(along, model.press) for side in pair)
        slopes[name] = _difference(low, high, variations[name].span)
    return result, slopes


def varied_systems(name: str, variation: Variation, base: Setup) -> tuple[VariedSystem, VariedSystem]:
    """Systems a little below and above, on the base's mesh moved to their sizes; ValueError as
    press_with_sensitivities.
    """
    pair = []
    for changed in (variation.below, variation.above):
        moved = morphed_mesh(base.tet_mesh, base.model.segment, changed.segment)
        setup = set_up(changed, resolve_dot(changed.dot, changed.segment), moved, base.opened, base.system)
        if setup.system.count != base.system.count:
            raise ValueError(f"{name}: this parameter switches something on or off at its present value")
        pair.append(VariedSystem(setup, setup.full_drive / base.full_drive))
    return pair[0], pair[1]


def _march(base: Setup, linear: LinearSolver, pairs: Mapping[str, tuple[VariedSystem, VariedSystem]]) -> str | None:
    """March along the schedule with the varied systems beside; why it stopped short, or None. NoEquilibriumError at
    rest.
    """
    targets = base.targets(follows_time=True)
    rest = rest_state(base.system, linear, targets[0])
    base.recorder.start(rest)
    for pair in pairs.values():
        for side in pair:
            side.start(rest)

    def on_state(state: State, before: State) -> None:
        base.recorder.record(state, before)
        _update_pairs(base, linear, pairs, state, before)

    past, kink, failure = [rest], targets[0].kink, None
    for target in targets[1:]:
        failure = march(base.system, linear, past, target, kink, on_state)
        if past[-1].time > base.recorder.steps[-1].time_s:
            base.recorder.report()
        if failure is not None:
            break
        kink = target.kink
    return failure


def _update_pairs(
    base: Setup,
    linear: LinearSolver,
    pairs: Mapping[str, tuple[VariedSystem, VariedSystem]],
    state: State,
    before: State,
) -> None:
    """Bring all varied systems to first order to a converged state of the base."""
    trial = base.system.trial(state.x, state.load, state.time, before, state.is_damped)
    tangent = base.system.evaluate(trial, before.histories).tangent
    for number, pair in enumerate(pairs.values()):
        update_pair(pair, linear, tangent, state, similar=number > 0)


def update_pair(
    pair: tuple[VariedSystem, VariedSystem], linear: LinearSolver, tangent: Tangent, state: State, similar: bool
) -> None:
    """Bring two varied systems to first order to a converged state of the base; similar : its tangent is factorised.

    From where they stand apart already: a dot that rests leaves them so, also where the base is at the very limit of
    friction and its tangent slips.
    """
    below, above = pair
    apart = 0.5 * above.ahead(below)
    change = above.residual(state.x + apart, state) - below.residual(state.x - apart, state)
    half = 0.5 * linear.solve_to_round_off(tangent, -change, similar=similar) + apart
    below.follow(state.x - half, state)
    above.follow(state.x + half, state)


def _difference(low: Slopes, high: Slopes, span: float) -> Slopes:
    """Central differences of the two histories; the times are the same."""
    trace = {f.name: (getattr(high.trace, f.name) - getattr(low.trace, f.name)) / span for f in fields(Trace)}
    amplified = None
    if low.readout_voltage_V is not None and high.readout_voltage_V is not None:
        amplified = (high.readout_voltage_V - low.readout_voltage_V) / span
    open_circuit = (high.open_circuit_voltage_V - low.open_circuit_voltage_V) / span
    return Slopes(Trace(**{**trace, "time_s": low.trace.time_s}), open_circuit, amplified)
