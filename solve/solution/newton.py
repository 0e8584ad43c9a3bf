"""Semismooth Newton iteration at fixed load."""

import logging
from dataclasses import replace

import numpy as np

from foundation.arrays import Bools, Floats
from solve.solution.errors import LostContactError, NoEquilibriumError
from solve.solution.held_rim import ALLOWED_OVERLAP, rim_met
from solve.solution.linear import LinearSolveError, LinearSolver
from solve.system import Evaluation, Load, State, System
from solve.terms.solid import InvertedElementError

LOG = logging.getLogger(__name__)
RESIDUAL_TOLERANCE = 1e-10
"""Of the load: differences of presses, such as a diagnosis takes, are to tell 1e-6 of a parameter."""
CORRECTION_ROUND_OFF = 1e-12  # of the largest displacement: a smaller correction changes nothing
ROUNDED_TOLERANCE = 1e-6  # a stiff film on a soft foam: its own round-off may exceed RESIDUAL_TOLERANCE of a small load
LEAST_LOAD = 1e-5  # solver units: what is less, the first touch of a moving mass, counts as this much
MAX_ITERATIONS = 25
MAX_HALVINGS = 6
SAME_RESIDUAL = 1e-3  # relative: a residual that comes back with the same discrete states runs in a circle
MAX_CIRCLES = 3
SETTLING_RESIDUAL, SETTLING_RESIDUAL_FORESEEN = 1.0, 10.0
"""Relative residual from which constraints settle within a step: farther away they settle to the wrong ones. The second
one from a start that the past foretold, which is wrong most of all in where contact ends."""
MAX_SETTLING = 10  # of the constraints in one step
LEAST_LINEAR_GAIN = 0.1  # what a linear solution gains at least
FORCING = 0.03  # residual of a linear solution over the square of that of Newton's iteration, which falls with it
LAST_LINEAR_SHARE = 0.3  # of RESIDUAL_TOLERANCE: what the last linear solution is to leave
LOOSEST_LINEAR_RESIDUAL = 1e-2  # far from the end, relative to Newton's residual and to the load


def equilibrate(
    system: System, linear: LinearSolver, x: Floats, load: Load, time: float, previous: State, damped: bool = False,
    near: float = SETTLING_RESIDUAL,
) -> State:  # fmt: skip
    """Find the equilibrium near x (count,) at a time after a converged state; damped : see Trial.

    near : relative residual from which constraints settle within a step.
    NoEquilibriumError when there is none within the iterations.
    """
    x, lost, correction = x.copy(), False, np.inf
    try:
        now = _evaluate(system, x, load, time, previous, damped)
        lost = system.force_driven and not now.touching
        status: Bools | None = None
        circles = Circles()
        for iteration in range(MAX_ITERATIONS):
            with np.errstate(over="ignore"):  # an exponential law is beyond all numbers at a wild strain
                norm = float(np.linalg.norm(now.residual))
            scale = max(now.load_norm, previous.force_scale)
            relative = norm / max(scale, LEAST_LOAD)
            LOG.debug("Newton iteration %d at time %.4g: relative residual %.2g", iteration, time, relative)
            settled = status is None or np.array_equal(status, now.status)
            exact = correction <= CORRECTION_ROUND_OFF and relative <= ROUNDED_TOLERANCE
            if (relative <= RESIDUAL_TOLERANCE or exact) and settled:
                converged = State(time, load, x, previous.histories, scale, iteration, relative)
                if rim_met(system, converged, load, ALLOWED_OVERLAP) is not None:
                    raise NoEquilibriumError("the dot overlaps the held rim", x, None)
                trial = system.trial(x, load, time, previous, damped)
                return replace(converged, histories=system.advance(trial, previous.histories))
            if not np.isfinite(norm):
                break
            similar = linear.may_reuse(now.tangent, None if status is None else int(np.sum(status != now.status)))
            # inexact Newton: the linear residual need fall neither faster than the nonlinear one nor below its goal
            loosest = min(FORCING * relative, LOOSEST_LINEAR_RESIDUAL / max(relative, 1.0))
            last = LAST_LINEAR_SHARE * RESIDUAL_TOLERANCE / max(relative, 1e-300)
            tolerance = min(max(loosest, last), LOOSEST_LINEAR_RESIDUAL)
            step = linear.solve(now.tangent, -now.residual, tolerance, similar)
            share, before = circles.share(now.status, norm), x
            if circles.count > MAX_CIRCLES:
                break
            status = now.status
            if relative <= near:
                step, status = _settle_constraints(system, linear, now, x, step, tolerance, load, time, previous)
            x, now = _advance(system, x, share * step, load, time, previous, damped)
            correction = _relative_change(system, before, x)
            lost = lost or (system.force_driven and not now.touching)
    except LinearSolveError as error:
        if lost:
            raise LostContactError("the dot that a force pushes loses contact", x, None) from error
        raise NoEquilibriumError(f"the tangent is singular ({error})", x, _worst_node(system, now)) from error
    except InvertedElementError as error:
        raise NoEquilibriumError(str(error), x, None) from error
    if lost:
        raise LostContactError("the dot that a force pushes loses contact", x, None)
    raise NoEquilibriumError(f"no convergence in {MAX_ITERATIONS} Newton iterations", x, _worst_node(system, now))


class Circles:
    """Finds iterations that run in a circle: the same nodes open and close again and again, and full steps repeat it.

    A shorter step leaves the circle, each time half as long.
    """

    def __init__(self) -> None:
        self.count = 0
        self._visited: dict[bytes, list[float]] = {}

    def share(self, status: Bools, norm: float) -> float:
        """Share of the next step to take from an iterate with these discrete states and norm of the residual."""
        norms = self._visited.setdefault(status.tobytes(), [])
        if not any(abs(norm - other) <= SAME_RESIDUAL * norm for other in norms):
            norms.append(norm)
            return 1.0
        self.count += 1
        self._visited.clear()
        return float(0.5**self.count)


def _settle_constraints(
    system: System, linear: LinearSolver, now: Evaluation, x: Floats, step: Floats, tolerance: float,
    load: Load, time: float, previous: State,
) -> tuple[Floats, Bools]:  # fmt: skip
    """Solve the step again as long as constraints open and close in it; the step, and their states in the end.

    The linearised problem with its inequalities is solved, not only its equations: contact settles while the media are
    as they are, which spares evaluations and wild pressures on the way.
    """
    if len(now.status) == 0 or not system.symmetric:
        return step, now.status
    here, histories, held = system.trial(x, load, time, previous), previous.histories, now.status
    size, seen = float(np.linalg.norm(now.residual)), {held.tobytes()}
    for _ in range(MAX_SETTLING):
        there = system.states(system.trial(x + step, load, time, previous), histories)
        if there.tobytes() in seen:
            break
        seen.add(there.tobytes())
        other = system.with_status(now, here, histories, there)
        if other is None or not linear.may_reuse(other.tangent, None):
            break
        left = -other.residual - other.tangent @ step
        wanted = min(tolerance * size / max(float(np.linalg.norm(left)), 1e-300), LEAST_LINEAR_GAIN)
        step, held = step + linear.solve(other.tangent, left, wanted, similar=True), there
    return step, held


def _relative_change(system: System, before: Floats, x: Floats) -> float:
    """Largest change of a displacement, against the largest displacement."""
    largest = float(np.abs(system.displacement(x)).max())
    return float(np.abs(system.displacement(x - before)).max()) / largest if largest > 0.0 else np.inf


def _worst_node(system: System, now: Evaluation) -> int:
    """Node with the largest unbalanced force."""
    force = np.nan_to_num(np.abs(np.append(now.residual, 0.0)[system.unknowns.displacement]), nan=np.inf)
    return int(np.argmax(force.max(axis=1)))


def _evaluate(system: System, x: Floats, load: Load, time: float, previous: State, damped: bool) -> Evaluation:
    return system.evaluate(system.trial(x, load, time, previous, damped), previous.histories)


def _advance(
    system: System, x: Floats, step: Floats, load: Load, time: float, previous: State, damped: bool
) -> tuple[Floats, Evaluation]:
    """The full Newton step, halved while it turns an element inside out."""
    for _ in range(MAX_HALVINGS):
        trial = x + step
        try:
            return trial, _evaluate(system, trial, load, time, previous, damped)
        except InvertedElementError as error:
            failure = error
            step = 0.5 * step
    raise failure
