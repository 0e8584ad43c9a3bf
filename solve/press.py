"""Press the dot into the segment and, where a path is given, slide it: load steps that adapt to convergence."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from geometry.dot_shape import DotShape
from geometry.parameters import Segment
from mesh.types import Floats, TetMesh
from solve.fields import fields
from solve.linear import LinearSolver
from solve.materials.parameters import Material
from solve.materials.voigt import from_voigt
from solve.newton import Equilibrium, NoEquilibriumError, equilibrate
from solve.parameters import Press
from solve.problem import build_system, scale_of_section
from solve.result import PressResult, Step
from solve.system import Load, System

SMALLEST_SUBSTEP = 1.0 / 64.0
DEFAULT_INDENTATION_MM = 0.3
PENETRATION_LIMIT = 0.05  # of the depth; contact holds in weighted means, so a coarse surface can overlap at points


@dataclass(frozen=True)
class _State:
    """A converged state at a time that counts load steps."""

    time: float
    load: Load
    equilibrium: Equilibrium


def press_segment(
    segment: Segment,
    materials: Mapping[str, Material],
    dot: DotShape,
    press: Press,
    tet_mesh: TetMesh,
    on_step: Callable[[Step, int, int], None] | None = None,
) -> PressResult:
    """Solve a press; materials : region name -> material. on_step(step, number, count) follows the progress.

    Want of convergence raises nothing: the result then holds what converged and says where and why it ended.
    """
    system = build_system(segment, materials, dot, tet_mesh, press.force_N is not None)
    linear = LinearSolver(system.factorisation_shift)
    force_scale, charge_scale = scale_of_section(segment, tet_mesh)
    targets = load_path(press, system, force_scale)
    rest = np.zeros(system.unknowns.count)
    history = [_State(0.0, targets[0], Equilibrium(rest, 0, 0.0))]
    steps = [_report(system, tet_mesh, history[-1], force_scale, charge_scale)]
    failure = None
    for number in range(1, len(targets)):
        failure = _advance(system, linear, history, targets[number], float(number))
        if history[-1].time > number - 1:
            steps.append(_report(system, tet_mesh, history[-1], force_scale, charge_scale))
            if on_step is not None:
                on_step(steps[-1], number, len(targets) - 1)
        if failure is not None:
            failure = f"step {number} of {len(targets) - 1} stopped at {_depth_text(steps[-1])}: {failure}"
            break
    linear.close()
    return _result(system, linear, segment, steps, failure, charge_scale)


def load_path(press: Press, system: System, force_scale: float) -> list[Load]:
    """Targets of the load steps in solver units: the press, then the legs of the slide at full depth."""
    fraction = np.linspace(0.0, 1.0, press.load_steps + 1)
    if press.force_N is not None:
        full = press.force_N / force_scale / system.units.force
        path = [Load((0.0, 0.0), force=full * f) for f in fraction]
    else:
        depth = 1e-3 * (press.indentation_mm or DEFAULT_INDENTATION_MM) / system.units.length
        path = [Load((0.0, 0.0), approach=depth * f) for f in fraction]
    here = np.zeros(2)
    for point in press.path_xy_mm:
        there = np.array(point) * (1e-3 / system.units.length)
        legs = here + fraction[1:, None] * (there - here)
        path += [Load((leg[0], leg[1]), path[-1].approach, path[-1].force) for leg in legs]
        here = there
    return path


def _between(a: Load, b: Load, fraction: float) -> Load:
    """The load a fraction of the way from a to b."""
    lateral = (1.0 - fraction) * np.array(a.lateral) + fraction * np.array(b.lateral)
    force = None if a.force is None or b.force is None else a.force + fraction * (b.force - a.force)
    return Load((lateral[0], lateral[1]), a.approach + fraction * (b.approach - a.approach), force)


def _advance(system: System, linear: LinearSolver, history: list[_State], target: Load, time: float) -> str | None:
    """Walk to the target, halving the step where Newton fails; appends to history, returns why it stopped."""
    start, fraction, size = history[-1], 0.0, 1.0
    while fraction < 1.0:
        size = min(size, 1.0 - fraction)
        load = _between(start.load, target, fraction + size)
        now = start.time + (fraction + size) * (time - start.time)
        try:
            equilibrium = _equilibrate(system, linear, history, load, now)
        except NoEquilibriumError as error:
            size *= 0.5
            if size < SMALLEST_SUBSTEP:
                return f"{error}{_place(system, error.worst)}"
        else:
            fraction += size
            size *= 2.0
            history.append(_State(now, load, equilibrium))
            del history[:-3]
    return None


def _equilibrate(
    system: System, linear: LinearSolver, history: list[_State], load: Load, time: float
) -> Equilibrium:
    """Newton from the extrapolated history and, where that fails, from the last state."""
    last = history[-1]
    if len(history) > 1:
        try:
            return equilibrate(system, linear, _extrapolate(history, time), load)
        except NoEquilibriumError:
            pass
    return equilibrate(system, linear, _touching(system, last.equilibrium.x, load), load)


def _extrapolate(history: list[_State], time: float) -> Floats:
    """The polynomial through the last two or three states, at a later time (Lagrange)."""
    guess = np.zeros_like(history[-1].equilibrium.x)
    for state in history:
        others = [(time - other.time) / (state.time - other.time) for other in history if other is not state]
        guess += float(np.prod(others)) * state.equilibrium.x
    return guess


def _touching(system: System, x: Floats, load: Load) -> Floats:
    """A force needs contact to start from: move the dot until it overlaps some nodes."""
    if load.force is None or system.active_nodes(x, load).any():
        return x
    x = x.copy()
    gap = system.contact.weighted_gap(system.displacement(x), system.move(x, load)) / system.contact.nodal_area
    x[system.unknowns.approach] += 1.01 * np.sort(gap)[min(3, len(gap) - 1)]
    return x


def _place(system: System, worst: int | None) -> str:
    """Where the worst residual is, in mm."""
    if worst is None:
        return ""
    nodes = np.flatnonzero((system.unknowns.displacement == worst).any(axis=1))
    if len(nodes) == 0:
        nodes = np.flatnonzero(system.unknowns.contact == worst)
    if len(nodes) == 0:
        return ""
    x, y, z = 1e3 * system.units.length * system.points[nodes[0]]
    return f", worst at x = {x:.2f}, y = {y:.2f}, z = {z:.2f} mm"


def _depth_text(step: Step) -> str:
    return f"{1e3 * step.indentation_m:.3f} mm and {step.reaction_force_N:.3g} N"


def _report(
    system: System, tet_mesh: TetMesh, state: _State, force_scale: float, charge_scale: Floats
) -> Step:
    x, load, units = state.equilibrium.x, state.load, system.units
    displacement, voltage, move = system.displacement(x), system.voltage(x), system.move(x, load)
    charge = system.film.charge(displacement, voltage)
    resultant = system.contact.force(displacement, move, x[system.contact.pressure_dofs])
    return Step(
        indentation_m=-float(move[2]) * units.length,
        reaction_force_N=-float(resultant[2]) * units.force * force_scale,
        film_charge_C=charge * charge_scale * units.force * units.length / units.voltage,
        open_circuit_voltage_V=charge / system.film.capacitance() * units.voltage,
        newton_iterations=state.equilibrium.iterations,
        relative_residual=state.equilibrium.relative_residual,
        dot_position_m=1e-3 * system.contact.dot.shape.origin_mm + move * units.length,
        fields=fields(system, tet_mesh, x, load),
    )


def _result(
    system: System,
    linear: LinearSolver,
    segment: Segment,
    steps: list[Step],
    failure: str | None,
    charge_scale: Floats,
) -> PressResult:
    units, last = system.units, steps[-1].fields
    capacitance = system.film.capacitance() * units.force * units.length / units.voltage**2
    return PressResult(
        steps=tuple(steps),
        converged=failure is None,
        failure=failure,
        electrode_names=tuple(e.name for e in segment.film.electrodes) or ("film",),
        capacitance_F=capacitance * charge_scale,
        unknowns=system.unknowns.count,
        linear_solver=linear.name,
        max_relative_residual=max(step.relative_residual for step in steps),
        max_principal_film_strain=_largest_principal(last.film_strain),
        max_principal_film_stress_Pa=_largest_principal(last.film_stress_Pa),
        warnings=_penetration(steps[-1]),
    )


def _penetration(step: Step) -> tuple[str, ...]:
    """A warning where the dot overlaps the surface by more than a share of the depth."""
    overlap = -float(step.fields.gap_m.min())
    if overlap <= PENETRATION_LIMIT * step.indentation_m:
        return ()
    return (
        f"the dot overlaps the surface by up to {1e3 * overlap:.2g} mm at single points: "
        "a smaller mesh.contact_element_size_mm is needed",
    )


def _largest_principal(voigt: Floats) -> float:
    """Largest principal value of symmetric tensors (k, 6)."""
    return float(np.linalg.eigvalsh(from_voigt(voigt))[:, -1].max())
