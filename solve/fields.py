"""Fields of a converged state, by the elements that carry them."""

import numpy as np

from foundation.arrays import Floats, Ints
from mesh.symmetry import MirroredMesh, in_plane
from mesh.types import TetMesh
from solve.fem.kinematics import deformation_gradient
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import linear
from solve.film_means import film_columns
from solve.result import Fields
from solve.system import State, System
from solve.tensors import from_voigt, to_voigt
from solve.terms.base import History, Trial
from solve.terms.film import FilmRegion
from solve.terms.solid import SolidRegion


def fields(system: System, tet_mesh: TetMesh, whole: MirroredMesh, state: State, before: State) -> Fields:
    """All fields of the whole segment in a converged state.

    tet_mesh : what is solved, whole : its images; before : the state that its step started from.
    """
    trial, units = system.trial(state.x, state.load, state.time, before), system.units
    cauchy, right_cauchy_green, strain, stress = map(whole.tensors, _element_means(system, tet_mesh, trial, before))
    film, columns, law = whole.tet_mesh.region_tets("film"), film_columns(whole.tet_mesh), system.film.law
    film_strain = columns.mean(to_voigt(strain[film], 2.0))
    film_stress = columns.mean(to_voigt(stress[film]))
    deviator = cauchy - np.einsum("mii->m", cauchy)[:, None, None] / 3.0 * np.eye(3)
    contact_nodes = np.unique(whole.tet_mesh.facets["contact"])
    touched = whole.node[contact_nodes]
    return Fields(
        displacement_m=trial.displacement[whole.node] * whole.node_sign * units.length,
        cauchy_stress_Pa=to_voigt(cauchy) * units.stress,
        green_lagrange_strain=to_voigt(0.5 * (right_cauchy_green - np.eye(3))),
        von_mises_Pa=np.sqrt(1.5 * np.einsum("mij,mij->m", deviator, deviator)) * units.stress,
        pressure_Pa=-np.einsum("mii->m", cauchy) / 3.0 * units.stress,
        max_stretch=_largest_stretch(right_cauchy_green),
        film_tets=film,
        film_strain=film_strain @ law.to_film_axes.T * [1, 1, 1, 0.5, 0.5, 0.5],
        film_stress_Pa=_in_film_axes(law.to_film_axes, film_stress) * units.stress,
        charge_density_C_per_m2=film_stress @ law.coupling * (units.stress * units.length / units.voltage),
        contact_nodes=contact_nodes,
        gap_m=_gaps_m(system, trial, touched),
        contact_pressure_Pa=trial.x[system.unknowns.contact[touched]] * units.stress,
        contact_traction_Pa=_traction(system, tet_mesh, trial)[touched] * whole.node_sign[contact_nodes] * units.stress,
    )


def _traction(system: System, tet_mesh: TetMesh, trial: Trial) -> Floats:
    """Contact traction (n, 3) at the nodes of the part. On a mirror plane the images cancel across it."""
    traction = np.zeros((len(tet_mesh.points_mm), 3))
    nodes = tet_mesh.facets["contact"].ravel()
    traction[nodes] = system.contact_traction(trial)[system.contact.index.ravel()]
    for axis in tet_mesh.planes:
        traction[in_plane(tet_mesh.points_mm, axis), axis] = 0.0
    return traction


def _element_means(system: System, tet_mesh: TetMesh, trial: Trial, before: State) -> Floats:
    """Means over each element in segment axes, (4, m, 3, 3): Cauchy stress, right Cauchy-Green tensor, and of the film
    its strain and second Piola-Kirchhoff stress, 0 elsewhere.
    """
    means = np.zeros((4, len(tet_mesh.tets), 3, 3))
    for solid in system.solids:
        means[:2, tet_mesh.region_tets(solid.name)] = _medium_means(solid, trial, system.history_of(solid, before))
    means[:, tet_mesh.region_tets("film")] = _film_means(system.film, trial, system.history_of(system.film, before))
    return means


def _medium_means(solid: SolidRegion, trial: Trial, history: History) -> tuple[Floats, Floats]:
    """Mean Cauchy stress and mean right Cauchy-Green tensor, (m, 3, 3) each, J sigma = F S F^t."""
    f = deformation_gradient(solid.gradient, trial.displacement[solid.tets])
    c = f.swapaxes(-1, -2) @ f
    stress = solid.respond(f, history, trial.time_step)[0].stress.reshape(*f.shape[:2], 6)
    jacobian = np.linalg.det(f)[..., None, None]
    sigma = f @ from_voigt(stress) @ f.swapaxes(-1, -2) / jacobian
    if not solid.law.compressible:
        pressure = np.einsum("qa,ma->mq", linear(tetrahedron()[0]), trial.x[solid.dofs[:, 30:]])
        sigma += pressure[..., None, None] * np.eye(3)
    return _volume_mean(sigma, solid.weight), _volume_mean(c, solid.weight)


def _film_means(film: FilmRegion, trial: Trial, history: History) -> tuple[Floats, ...]:
    """Means (k, 3, 3) of Cauchy stress, right Cauchy-Green tensor, strain and stress in segment axes."""
    strain, stress = film.strain_and_stress(trial, history)
    f = deformation_gradient(film.gradient, trial.displacement[film.tets])
    sigma = f @ from_voigt(stress) @ f.swapaxes(-1, -2) / np.linalg.det(f)[..., None, None]
    tensors = sigma, f.swapaxes(-1, -2) @ f, from_voigt(strain, 2.0), from_voigt(stress)
    return tuple(_volume_mean(each, film.weight) for each in tensors)


def _volume_mean(values: Floats, weight: Floats) -> Floats:
    """Mean (m, ...) over each element of values (m, q, ...) at quadrature points with weights (m, q)."""
    mean: Floats = np.einsum("mq...,mq->m...", values, weight / weight.sum(axis=1, keepdims=True))
    return mean


def _largest_stretch(cauchy_green: Floats) -> Floats:
    """Largest principal stretch (m,) of right Cauchy-Green tensors (m, 3, 3)."""
    stretch: Floats = np.sqrt(np.linalg.eigvalsh(cauchy_green)[:, -1])
    return stretch


def _in_film_axes(turn: Floats, stress: Floats) -> Floats:
    """Stress (k, 6) in the film's axes: strain turns by T, so stress by T^-t."""
    return np.asarray(np.linalg.solve(turn.T, stress.T).T, dtype=np.float64)


def _gaps_m(system: System, trial: Trial, nodes: Ints) -> Floats:
    """Signed distance (c,) in m of nodes (c,) to the dot, negative where they overlap."""
    gap = system.contact.dot.distance((system.points + trial.displacement)[nodes], trial.move)[0]
    return gap * system.units.length
