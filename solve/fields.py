"""Fields of a converged state in SI units: means over the element, and through the thickness of the film."""

import numpy as np

from mesh.types import Floats, Ints, TetMesh
from solve.film_average import film_columns
from solve.kinematics import deformation_gradient
from solve.materials.voigt import from_voigt, to_voigt
from solve.quadrature import tetrahedron
from solve.result import Fields
from solve.shape_functions import linear
from solve.solid import SolidRegion
from solve.system import State, System
from solve.term import History, Trial


def fields(system: System, tet_mesh: TetMesh, state: State, before: State) -> Fields:
    """All fields in a converged state; before : the state that its step started from."""
    x = state.x
    trial = system.trial(x, state.load, state.time, before)
    displacement = trial.displacement
    cauchy, right_cauchy_green = np.zeros((2, len(tet_mesh.tets), 3, 3))
    for solid in system.solids:
        index = tet_mesh.region_tets(solid.name)
        cauchy[index], right_cauchy_green[index] = _medium(solid, trial, system.history_of(solid, before))
    film = tet_mesh.region_tets("film")
    history = system.history_of(system.film, before)
    strain, stress, cauchy[film], right_cauchy_green[film] = _film(system, trial, history)
    columns = film_columns(tet_mesh)
    strain, stress = columns.mean(strain), columns.mean(stress)
    density = stress @ system.film.law.coupling
    turn = system.film.law.to_film_axes
    deviator = cauchy - np.einsum("mii->m", cauchy)[:, None, None] / 3.0 * np.eye(3)
    contact_nodes = np.unique(tet_mesh.facets["contact"])
    pressure_dofs = system.unknowns.contact[contact_nodes]
    return Fields(
        displacement_m=displacement * system.units.length,
        cauchy_stress_Pa=to_voigt(cauchy) * system.units.stress,
        green_lagrange_strain=to_voigt(0.5 * (right_cauchy_green - np.eye(3))),
        von_mises_Pa=np.sqrt(1.5 * np.einsum("mij,mij->m", deviator, deviator)) * system.units.stress,
        pressure_Pa=-np.einsum("mii->m", cauchy) / 3.0 * system.units.stress,
        max_stretch=_largest_stretch(right_cauchy_green),
        film_tets=film,
        film_strain=strain @ turn.T * [1, 1, 1, 0.5, 0.5, 0.5],
        film_stress_Pa=_in_film_axes(turn, stress) * system.units.stress,
        charge_density_C_per_m2=density * system.units.stress * system.units.length / system.units.voltage,
        contact_nodes=contact_nodes,
        gap_m=_gap(system, trial, contact_nodes),
        contact_pressure_Pa=x[pressure_dofs] * system.units.stress,
    )


def _medium(solid: SolidRegion, trial: Trial, history: History) -> tuple[Floats, Floats]:
    """Mean Cauchy stress and mean right Cauchy-Green tensor, (m, 3, 3) each, J sigma = F S F^t."""
    f = deformation_gradient(solid.gradient, trial.displacement[solid.tets])
    c = f.swapaxes(-1, -2) @ f
    stress = solid.respond(f, history, trial.time_step)[0].stress.reshape(*f.shape[:2], 6)
    jacobian = np.linalg.det(f)[..., None, None]
    sigma = f @ from_voigt(stress) @ f.swapaxes(-1, -2) / jacobian
    if not solid.law.compressible:
        pressure = np.einsum("qa,ma->mq", linear(tetrahedron()[0]), trial.x[solid.dofs[:, 30:]])
        sigma += pressure[..., None, None] * np.eye(3)
    return _mean(sigma, solid.weight), _mean(c, solid.weight)


def _film(system: System, trial: Trial, history: History) -> tuple[Floats, Floats, Floats, Floats]:
    """Mean strain and stress (k, 6) in segment axes, mean Cauchy stress and right Cauchy-Green tensor (k, 3, 3)."""
    film = system.film
    strain, stress = film.strain_and_stress(trial, history)
    f = deformation_gradient(film.gradient, trial.displacement[film.tets])
    sigma = f @ from_voigt(stress) @ f.swapaxes(-1, -2) / np.linalg.det(f)[..., None, None]
    c = _mean(f.swapaxes(-1, -2) @ f, film.weight)
    return _mean(strain, film.weight), _mean(stress, film.weight), _mean(sigma, film.weight), c


def _mean(values: Floats, weight: Floats) -> Floats:
    mean: Floats = np.einsum("mq...,mq->m...", values, weight / weight.sum(axis=1, keepdims=True))
    return mean


def _largest_stretch(cauchy_green: Floats) -> Floats:
    stretch: Floats = np.sqrt(np.linalg.eigvalsh(cauchy_green)[:, -1])
    return stretch


def _in_film_axes(turn: Floats, stress: Floats) -> Floats:
    """Stress (k, 6) in the film's axes: strain turns by T, so stress by T^-t."""
    return np.asarray(np.linalg.solve(turn.T, stress.T).T, dtype=np.float64)


def _gap(system: System, trial: Trial, nodes: Ints) -> Floats:
    gap = system.contact.dot.distance((system.points + trial.displacement)[nodes], trial.move)[0]
    return gap * system.units.length
