"""A solved press, and everything that shows a 'converged' result to be wrong, computed apart from the solver's kernels.

Nodal forces are summed here from the stress at the quadrature points, the gaps from the positions in the result:
    f_a = sum_q w_q F S grad N_a   with S of the law, + p J C^-1 where the medium has a pressure p.
"""

from dataclasses import dataclass
from unittest.mock import patch

import numpy as np

from softdot.arrays.case import ArrayCase
from softdot.case import Case
from softdot.config.loading import config_from
from solve import press as press_module
from solve.fem.kinematics import deformation_gradient
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import linear, quadratic
from solve.readout.course import course
from solve.tensors import from_voigt
from solve.terms.contact import HATS, SHAPES, facet_area
from solve.terms.unilateral_interface import UnilateralInterface

SMALL = 1e-6  # of the largest force so far; Newton stops at 1e-9
SMALLEST_FORCE = 1e-3  # solver units; of less than this round-off leaves too much to judge


@dataclass
class Pressed:
    """What a press gave, and the discrete problem behind it, on its mesh: that of a part where all is symmetric."""

    model: object
    dot: object
    result: object
    voltage: object
    system: object
    mesh: object
    last: tuple


def solved(tables) -> Pressed:
    """From tables to the result as softdot run goes, without its files; of an array the press of its first segment.

    InputError, MeshingError.
    """
    config = config_from(tables)
    case = Case(config) if config.array is None else first_press(config)
    _ = case.solved_mesh  # sizes for an accuracy are found by presses of their own
    kept = []
    discretise = press_module.discretise
    with patch.object(press_module, "discretise", lambda *given: kept.append(discretise(*given)) or kept[0]):
        result = case.solve()
    voltage = amplified(case, result)
    return Pressed(case.model, case.dot, result, voltage, kept[0].system, kept[0].tet_mesh, kept[0].recorder._last)


def amplified(case, result):
    """Voltages at the steps: of all electrodes together (s,), of each (e, s); None without an amplifier."""
    along = course(result, case.model.press, case.model.amplifier, case.model.physics)
    if along.together_V is None:
        return None
    return along.together_V[along.solved], along.channels_V[along.solved].T


def first_press(config):
    """As Case has it, of an array."""
    array = ArrayCase(config)
    _ = array.warnings
    return array.press_over(array.layout.places[0])


def wrong(pressed) -> list[str]:
    """Sentences on what contradicts mechanics in a converged press; empty for a good one."""
    checks = (numbers, target, contact, patches, equilibrium, work)
    return [said for check in checks for said in check(pressed)]


def numbers(pressed):
    result = pressed.result
    arrays = [*vars(result.trace).items()]
    for step in result.steps:
        arrays += [*vars(step).items(), *vars(step.fields).items()]
    for name, values in [*arrays, ("voltage", np.array([]) if pressed.voltage is None else pressed.voltage[1])]:
        if name != "fields" and not np.isfinite(np.asarray(values, float)).all():
            yield f"{name} is not finite"


def target(pressed):
    """The last depth or force is the one asked for."""
    press, last = pressed.model.press, pressed.result.trace
    shape = press.waveform.shape if press.waveform is not None else "ramp"
    asked = 0.0 if pressed.result.follows_time and shape in ("half-sine", "trapezoid") else 1.0
    if press.force_N is not None and not np.isclose(last.reaction_force_N[-1], asked * press.force_N, atol=1e-9):
        yield f"the force is {last.reaction_force_N[-1]:g} N"
    if press.indentation_mm is not None:
        depth_mm = 1e3 * last.indentation_m[-1]
        if not np.isclose(depth_mm, asked * press.indentation_mm, atol=1e-9):
            yield f"the depth is {depth_mm:g} mm"


def contact(pressed):
    """lambda >= 0, weighted gap >= 0, one of them zero at every node."""
    step, system = pressed.result.steps[-1], pressed.system
    mesh, fields = pressed.result.tet_mesh, step.fields
    facets = mesh.facets["contact"]
    nodes, index = np.unique(mesh.twin[facets], return_inverse=True)
    index = index.reshape(-1, 6)
    x = (1e-3 * mesh.points_mm + fields.displacement_m)[facets]
    points = np.einsum("qn,kni->kqi", SHAPES, x)
    gap = distance_m(pressed.dot, points.reshape(-1, 3), step.dot_position_m).reshape(points.shape[:2])
    area = facet_area(1e-3 * mesh.points_mm, facets)
    shared = [np.einsum("kq,qi->ki", values, HATS).ravel() for values in (area * gap, area)]
    weighted, whole = (np.bincount(index.ravel(), values, len(nodes)) for values in shared)
    mean_gap = weighted / whole / system.units.length
    at = np.searchsorted(fields.contact_nodes, nodes)
    pressure = fields.contact_pressure_Pa[at] / system.units.stress
    if pressure.min() < -1e-9 * max(1.0, pressure.max()):
        yield f"the dot pulls with {pressure.min():.2e}"
    if mean_gap.min() < -1e-7:
        yield f"the dot overlaps the surface by {mean_gap.min():.2e} of the length"
    if (np.abs(pressure * mean_gap) > 1e-7 * max(1.0, pressure.max())).any():
        yield "a pressure acts across a gap"


def distance_m(dot, points, position):
    """Signed distance (n,) of points (n, 3) to the dots on their plate, the origin of their frame at position (3,)."""
    local = (points - position) @ dot.rotation
    plate = 1e-3 * dot.height_mm - local[:, 2]
    if dot.kind == "plate":
        return plate
    radius = 1e-3 * dot.radius_mm
    nearest = plate
    for x, y, z in 1e-3 * dot.tips_mm:
        up = local[:, 2] - z - radius
        if dot.height_mm - 1e3 * z > dot.radius_mm:
            up = np.minimum(up, 0.0)
        across = local[:, 0] - x if dot.kind == "ridge" else np.hypot(local[:, 0] - x, local[:, 1] - y)
        nearest = np.minimum(nearest, np.hypot(across, up) - radius)
    return nearest


def patches(pressed):
    """The faces of a delaminated patch neither pull nor pass through each other."""
    state, before = pressed.last
    trial = pressed.system.trial(state.x, state.load, state.time, before)
    for term in pressed.system.terms:
        if isinstance(term, UnilateralInterface):
            opening = term.weighted_opening(trial.displacement) / term.nodal_area
            pressure = trial.x[term.multipliers]
            if opening.min() < -1e-7 or pressure.min() < -1e-9:
                yield f"a delaminated patch: opening {opening.min():.2e}, pressure {pressure.min():.2e}"


def equilibrium(pressed):
    """Nodal forces vanish where nothing acts, and what the segment carries is what the dot pushes."""
    system, mesh, state = pressed.system, pressed.mesh, pressed.last[0]
    force = np.zeros_like(system.points)
    np.add.at(force, mesh.twin, nodal_forces(pressed))
    free = (system.unknowns.displacement >= 0) & (mesh.twin == np.arange(len(force)))[:, None]
    outer = _on_springs(pressed)
    free[outer] = False
    force[~free] = 0.0
    scale = SMALL * max(state.force_scale, SMALLEST_FORCE)
    inner = np.setdiff1d(np.arange(len(force)), mesh.twin[mesh.facets["contact"]])
    if not _opened(pressed) and np.linalg.norm(force[inner]) > scale:
        yield f"a force of {np.linalg.norm(force[inner]):.1e} at nodes where nothing acts"
    if _opened(pressed) and pressed.model.segment.boundary != "free":  # a held face of a bond carries a part unseen
        return
    dot = system.dot_force(system.trial(state.x, state.load, state.time, pressed.last[1]))
    if not _edge_pressed(pressed, ~free[:, 2]) and abs(force.sum(axis=0)[2] - dot[2]) > np.sqrt(len(force)) * scale:
        yield f"the segment carries {-force.sum(axis=0)[2]:g} of the dot's {-dot[2]:g}"


def _edge_pressed(pressed, outer):
    """Whether the dot presses on facets with a held node, which carries a part of the force unseen."""
    facets, unknowns = pressed.mesh.facets["contact"], pressed.system.unknowns
    facets = pressed.mesh.twin[facets]
    beside = facets[outer[facets].any(axis=1)]
    return bool((pressed.last[0].x[unknowns.contact[beside]] > 0.0).any())


def _on_springs(pressed):
    """Nodes of elastic sides, and of the base with what is bonded there."""
    mesh, segment = pressed.mesh, pressed.model.segment
    names = [f"side-{name}" for name in segment.held_layers] if segment.boundary == "elastic" else []
    nodes = [mesh.facets[name].ravel() for name in names if name in mesh.facets]
    nodes.append(np.flatnonzero(mesh.points_mm[:, 2] < 1e-9))
    return np.unique(mesh.twin[np.concatenate(nodes)])


def _opened(pressed):
    return [patch.bond for patch in pressed.model.physics.delaminations] + list(pressed.model.physics.bonds)


def nodal_forces(pressed):
    """Internal forces (n, 3) of media and film at the last state, solver units."""
    system = pressed.system
    state, before = pressed.last
    trial = system.trial(state.x, state.load, state.time, before)
    force = np.zeros_like(system.points)
    reference = tetrahedron()[0]
    assert len(quadratic(reference)[1]) == len(reference)
    for solid in system.solids:
        f = deformation_gradient(solid.gradient, trial.displacement[solid.tets])
        stress = solid.respond(f, system.history_of(solid, before), trial.time_step)[0].stress
        second = from_voigt(stress.reshape(*f.shape[:2], 6))
        if not solid.law.compressible:
            pressure = np.einsum("qa,ma->mq", linear(reference), trial.x[solid.dofs[:, 30:]])
            inverse = np.linalg.inv(f.swapaxes(-1, -2) @ f)
            second = second + (pressure * np.linalg.det(f))[..., None, None] * inverse
        _scatter(force, solid, f @ second)
    film = system.film
    f = deformation_gradient(film.gradient, trial.displacement[film.tets])
    stress = film.strain_and_stress(trial, system.history_of(film, before))[1]
    _scatter(force, film, f @ from_voigt(stress))
    return force


def _scatter(force, region, first):
    """Add the nodal forces of first Piola-Kirchhoff stress (m, q, 3, 3)."""
    np.add.at(force, region.tets, np.einsum("mq,mqij,mqnj->mni", region.weight, first, region.gradient))


def work(pressed):
    """Without a slide the dot never gains energy from a segment at rest, and is never pulled.

    The work is a sum over sub-steps: it is judged where the result does not call them too coarse.
    """
    trace, press = pressed.result.trace, pressed.model.press
    force, path = trace.contact_force_N[:, 2], trace.dot_path_m
    if press.path_xy_mm:
        return
    rubs = any(term.is_contact for term in pressed.model.physics.terms)
    if not rubs and force.min() < -1e-6 * max(force.max(), 1e-9):
        yield f"the dot is pulled with {force.min():g} N"
    done = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(path))])
    if any("time integration" in said for said in pressed.result.warnings):  # a rebound within one sub-step
        return
    if done.min() < -0.05 * done.max() - 1e-15:
        yield f"the dot gains {-done.min():.2e} J, after {done.max():.2e} J were put in"
