"""Semismooth Newton iteration at fixed load.

Where a press stopped and what a user can do about it.
"""

import logging
from dataclasses import replace

import numpy as np

from geometry.arrays import Bools, Floats, Ints
from solve.fem.kinematics import deformation_gradient, smallest_jacobian
from solve.solution.linear import LinearSolveError, LinearSolver
from solve.system import Evaluation, Load, State, System
from solve.terms.film import FilmRegion
from solve.terms.solid import InvertedElementError, SolidRegion

LOG = logging.getLogger(__name__)
TOLERANCE = 1e-10  # of the load: differences of presses, such as a diagnosis takes, are to tell 1e-6 of a parameter
ROUND_OFF = 1e-12  # of the largest displacement: a smaller correction changes nothing
ROUNDED_TOLERANCE = 1e-6  # a stiff film on a soft foam: its own round-off may exceed TOLERANCE of a small load
LEAST_LOAD = 1e-5  # solver units: what is less, the first touch of a moving mass, counts as this much
MAX_ITERATIONS = 25
MAX_HALVINGS = 6
SAME = 1e-3  # relative: a residual that comes back with the same discrete states runs in a circle
MAX_CIRCLES = 3
NEAR = 1.0  # relative residual from which constraints settle within a step: farther away they settle to the wrong ones
NEAR_FORESEEN = 10.0  # from a start that the past foretold: what it gets wrong is most of all where contact ends
MAX_SETTLING = 10  # of the constraints in one step
LITTLE = 0.1  # what a linear solution gains at least
FORCING = 0.03  # residual of a linear solution over the square of that of Newton's iteration, which falls with it
LAST = 0.3  # of TOLERANCE: what the last linear solution is to leave
LOOSEST = 1e-2  # residual of a linear solution, far from the end, relative to the residual and to the load


class NoEquilibriumError(RuntimeError):
    """Newton did not converge; says why, and at which node the forces are least in balance."""

    def __init__(self, reason: str, x: Floats, worst: int | None) -> None:
        super().__init__(reason)
        self.x, self.worst = x, worst


class LostContactError(NoEquilibriumError):
    """A force pushes the dot, and nothing pushes back."""


def equilibrate(
    system: System, linear: LinearSolver, x: Floats, load: Load, time: float, previous: State, damped: bool = False,
    near: float = NEAR,
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
            exact = correction <= ROUND_OFF and relative <= ROUNDED_TOLERANCE
            if (relative <= TOLERANCE or exact) and settled:
                converged = State(time, load, x, previous.histories, scale, iteration, relative)
                if rim_met(system, converged, load, OVERLAP) is not None:
                    raise NoEquilibriumError("the dot overlaps the held rim", x, None)
                trial = system.trial(x, load, time, previous, damped)
                return replace(converged, histories=system.advance(trial, previous.histories))
            if not np.isfinite(norm):
                break
            similar = linear.may_reuse(now.tangent, None if status is None else int(np.sum(status != now.status)))
            # inexact Newton: the linear residual need fall neither faster than the nonlinear one nor below its goal
            loosest = min(FORCING * relative, LOOSEST / max(relative, 1.0))
            tolerance = min(max(loosest, LAST * TOLERANCE / max(relative, 1e-300)), LOOSEST)
            step = linear.solve(now.tangent, -now.residual, tolerance, similar)
            share, before = circles.share(now.status, norm), x
            if circles.count > MAX_CIRCLES:
                break
            status = now.status
            if relative <= near:
                step, status = _settled(system, linear, now, x, step, tolerance, load, time, previous)
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
        """How much of the next step to take from an iterate with these discrete states and norm of the residual."""
        norms = self._visited.setdefault(status.tobytes(), [])
        if not any(abs(norm - other) <= SAME * norm for other in norms):
            norms.append(norm)
            return 1.0
        self.count += 1
        self._visited.clear()
        return float(0.5**self.count)


def _settled(
    system: System, linear: LinearSolver, now: Evaluation, x: Floats, step: Floats, tolerance: float,
    load: Load, time: float, previous: State,
) -> tuple[Floats, Bools]:  # fmt: skip
    """The step, solved again as long as constraints open and close in it, and their states in the end.

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
        other = system.switched(now, here, histories, there)
        if other is None or not linear.may_reuse(other.tangent, None):
            break
        left = -other.residual - other.tangent @ step
        wanted = min(tolerance * size / max(float(np.linalg.norm(left)), 1e-300), LITTLE)
        step, held = step + linear.solve(other.tangent, left, wanted, similar=True), there
    return step, held


def _relative_change(system: System, before: Floats, x: Floats) -> float:
    """Largest change of a displacement, against the largest displacement."""
    largest = float(np.abs(system.displacement(x)).max())
    return float(np.abs(system.displacement(x - before)).max()) / largest if largest > 0.0 else np.inf


def _worst_node(system: System, now: Evaluation) -> int:
    """The node with the largest unbalanced force."""
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


FINER = (
    "try more load steps (press.load_steps), a finer mesh (mesh.contact_element_size_mm), or a smaller depth or force"
)
HELD = (
    "something can move freely, or the dot presses on a part that the case holds: change "
    "segment.held_layers, stiffen the bonds, or move the dot"
)
RIM = (
    "move the dot (dot.offset_mm, dot.tilt_deg), enlarge the segment, hold fewer layers (segment.held_layers) or press "
    "less deep"
)
NEAR_RIM = 0.01  # of the segment's length: a force stops a dot just short of the rim
OVERLAP = -1e-6  # of the segment's length: contact does not act on nodes that are held, so none may be overlapped
CRUSHED = 0.3  # det F: below it the element is to blame, whatever ended the iteration
TIE = 1e-6  # of det F: round-off must not choose between two elements
OVER = "keep the dot over the segment (dot.offset_mm, press.path_xy_mm), or prescribe the depth (press.indentation_mm)"


def explained(system: System, failure: NoEquilibriumError, last: State, load: Load) -> str:
    """The reason, the part and the place (undeformed, mm), and advice.

    last : the last converged state; load : the one for which there is no equilibrium.

    Of an inversion the part and the place are those of the element that was nearest to it there: which one a diverging
    iteration inverts first is round-off.
    """
    rim = rim_met(system, last, load)
    if rim is not None:
        part = _part(system, rim)
        at = _at(system, system.points[[rim]])
        return f"the dot meets the rim of {part} that the case holds{at}, and neither can deform; {RIM}"
    cause, (volume, crushed) = failure.__cause__, _nearest_to_inversion(system, last)
    if crushed is not None and volume < CRUSHED:
        to = f"{100.0 * volume:.0f} % of its volume"
        said = f"an element of {crushed.region} is crushed to {to} and turned inside out"
        return f"{said}{_at(system, system.points[crushed.nodes])}; {_advice(system, failure)}"
    if isinstance(cause, InvertedElementError):
        inverted = crushed or cause
        return f"{inverted}{_at(system, system.points[inverted.nodes])}; {_advice(system, failure)}"
    return f"{failure}{_place(system, failure)}; {_advice(system, failure)}"


def rim_met(system: System, last: State, load: Load, gap_left: float | None = None) -> int | None:
    """The node of the held rim that the dot would overlap most under a load after a state; None where it is clear.

    gap_left : from which gap on it counts as met; none: 0, and a little more where a force stops short of it.
    """
    if gap_left is None:
        gap_left = NEAR_RIM if system.force_driven else 0.0
    nodes = np.unique(system.contact.facets)
    held = nodes[(system.unknowns.displacement[nodes] < 0).all(axis=1)]
    if len(held) == 0:
        return None
    gap = system.contact.dot.distance(system.points[held], system.move(last.x, load))[0]
    deepest = int(np.argmin(gap))
    return int(held[deepest]) if gap[deepest] < gap_left else None


def smallest_volumes(region: SolidRegion | FilmRegion, displacement: Floats) -> Floats:
    """Smallest det F of each element (m,) of a region at displacements (n, 3)."""
    return smallest_jacobian(deformation_gradient(region.gradient, displacement[region.tets]))


def _nearest_to_inversion(system: System, state: State) -> tuple[float, InvertedElementError | None]:
    """The smallest det F and its element, of equal ones the first; None in a state that squeezes none."""
    displacement = system.displacement(state.x)
    least: list[tuple[float, str, Ints]] = []
    for name, region in ({solid.name: solid for solid in system.solids} | {"film": system.film}).items():
        smallest = smallest_volumes(region, displacement)
        first = int(np.argmax(smallest <= (1.0 + TIE) * smallest.min()))
        least.append((float(smallest[first]), name, region.tets[first]))
    bound = (1.0 + TIE) * min(volume for volume, _, _ in least)
    volume, name, nodes = next(one for one in least if one[0] <= bound)
    return volume, InvertedElementError(name, nodes) if volume < 1.0 - TIE else None


def _advice(system: System, failure: NoEquilibriumError) -> str:
    if isinstance(failure, LostContactError):
        return OVER
    advice = HELD if isinstance(failure.__cause__, LinearSolveError) else FINER
    return f"{advice}; under a force, {OVER}" if system.force_driven else advice


def _place(system: System, failure: NoEquilibriumError) -> str:
    """In which part and where; empty where nothing is known."""
    if isinstance(failure, LostContactError):
        contact = system.contact
        return f" over {_part(system, int(contact.facets[0, 0]))}{_at(system, system.points[contact.facets.ravel()])}"
    if failure.worst is None:
        return ""
    return f", worst in {_part(system, failure.worst)}{_at(system, system.points[[failure.worst]])}"


def _part(system: System, node: int) -> str:
    """A part that the node belongs to."""
    regions = {solid.name: solid.tets for solid in system.solids} | {"film": system.film.tets}
    return next(name for name, tets in regions.items() if (tets == node).any())


def _at(system: System, points: Floats) -> str:
    """The mean of points (n, 3)."""
    x, y, z = 1e3 * system.units.length * np.mean(points, axis=0)
    return f" at x = {x:.2f}, y = {y:.2f}, z = {z:.2f} mm"
