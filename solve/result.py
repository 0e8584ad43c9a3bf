"""What a press gives back: load history and fields at each step, in SI units.

Film strain, stress and charge density: one definition for every number, picture and file.

The film is far thinner than wide, and its charge per area is the mean of d . S through its thickness (the electrodes
collect nothing else). So all film quantities are means through the thickness, which bending does not enter (of a
plate bent about its middle the mean strain vanishes: Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells,
1959, ch. 1). At a held rim the stress inside a bonded film is singular (Williams, J. Appl. Mech. 19, 1952, 526-528).
Its mean through the thickness is bounded, as it carries a finite force, but usual meshes do not resolve it there. The
largest value is therefore looked for at a stated distance from held rims, and the largest of all told beside it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from foundation.arrays import Floats, Ints
from geometry.parameters import Segment
from mesh.symmetry import Unfolded, in_plane
from mesh.types import Planes, TetMesh
from solve.fem.kinematics import deformation_gradient
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import linear
from solve.system import State, System
from solve.tensors import from_voigt, to_voigt
from solve.terms.base import History, Trial
from solve.terms.film import FilmRegion
from solve.terms.solid import SolidRegion


@dataclass(frozen=True)
class Fields:
    """Fields at one load step; cell arrays follow the mesh's tetrahedra.

    displacement_m : (n, 3)
    cauchy_stress_Pa : (m, 6) xx, yy, zz, xy, yz, xz (VTK's order of a symmetric tensor), mean over the element
    green_lagrange_strain : (m, 6) same order, mean over the element, shears are tensor components
    von_mises_Pa, pressure_Pa (positive in compression), max_stretch : (m,)
    film_tets : (k,) indices of the film's tetrahedra; the film arrays follow it, in the film's own axes (1 along
        the draw direction, 2 across, 3 normal):
    The film arrays are means through the film's thickness (solve.result), the same for all tetrahedra that
    stand over one another:
    film_strain : (k, 6) Green-Lagrange strain 11, 22, 33, 12, 23, 13
    film_stress_Pa : (k, 6) second Piola-Kirchhoff stress, same order
    charge_density_C_per_m2 : (k,) short-circuit charge per undeformed area
    contact_nodes : (c,) nodes of the facets "contact"; the contact arrays follow it
    gap_m : (c,) signed distance to the dot; contact_pressure_Pa : (c,) of the dot's normal, positive in compression;
    contact_traction_Pa : (c, 3) of the dot on the surface, friction included. Both per undeformed area; the traction,
    linear on the four quarters of a facet, integrates to the force of the dot
    """

    displacement_m: Floats
    cauchy_stress_Pa: Floats
    green_lagrange_strain: Floats
    von_mises_Pa: Floats
    pressure_Pa: Floats
    max_stretch: Floats
    film_tets: Ints
    film_strain: Floats
    film_stress_Pa: Floats
    charge_density_C_per_m2: Floats
    contact_nodes: Ints
    gap_m: Floats
    contact_pressure_Pa: Floats
    contact_traction_Pa: Floats


@dataclass(frozen=True)
class Step:
    """One converged load step. Charges and voltages: one per electrode, shape (e,).

    reaction_force_N is what the rig's force sensor reads, dot_force_N (3,) what the segment does to the dot.
    dot_position_m : (3,) origin of the dot's frame (see geometry.dot) in the segment's frame.
    """

    time_s: float
    indentation_m: float
    reaction_force_N: float
    film_charge_C: Floats
    open_circuit_voltage_V: Floats
    newton_iterations: int
    relative_residual: float
    dot_position_m: Floats
    dot_force_N: Floats
    fields: Fields


@dataclass(frozen=True)
class Record:
    """One converged state without its fields; names as in Trace, time_error and snapped as in State."""

    time_s: float
    indentation_m: float
    dot_path_m: float
    contact_force_N: Floats
    rig_force_N: float
    film_charge_C: Floats
    contact_area_m2: float
    newton_iterations: int
    relative_residual: float
    time_error: float
    snapped: bool


@dataclass(frozen=True)
class Trace:
    """Every converged state of a press, sub-steps included.

    time_s (t,); indentation_m (t,) as the displacement sensor reads it; dot_path_m (t,) of the dot itself;
    reaction_force_N (t,) of the force sensor; contact_force_N (t, 3) of the segment on the dot;
    film_charge_C (t, e) since the rest; contact_area_m2 (t,), undeformed.
    """

    time_s: Floats
    indentation_m: Floats
    dot_path_m: Floats
    reaction_force_N: Floats
    contact_force_N: Floats
    film_charge_C: Floats
    contact_area_m2: Floats


@dataclass(frozen=True)
class FilmPeak:
    """The largest film quantities of a press, each a mean through the thickness; principal values.

    strain, stress_Pa, charge_density_C_per_m2 (least and largest) : at least rim_distance_m away from held sides; so is
        compression_Pa, the largest in any direction, 0 where there is none.
    rim_strain, rim_stress_Pa : anywhere, held sides included, where they depend on the mesh.
    """

    strain: float
    stress_Pa: float
    charge_density_C_per_m2: tuple[float, float]
    rim_distance_m: float
    rim_strain: float
    rim_stress_Pa: float
    compression_Pa: float = 0.0


@dataclass(frozen=True)
class PressResult:
    """The history of a press. steps[0] is the unloaded state, trace has every sub-step too.

    follows_time : the press followed its waveform; else only loads were solved, whose order matters but not their time.
    tet_mesh : the mesh of the fields and of the whole segment, its nodes doubled where an interface opens.
    progress : (t,) of the states of the trace where time does not count: shares of the full drive, then 1 + the legs of
        the slide that are done; their times are those at which the waveform first comes there. Else the times.
    planes : mirror planes at which the mesh that was solved ends (mesh.symmetry).

    converged is False when the last asked depth was not reached; failure then says where and why.
    Forces and charges are those of the whole segment (a plane-strain slice is scaled to width_mm).
    """

    steps: tuple[Step, ...]
    trace: Trace
    follows_time: bool
    tet_mesh: TetMesh
    converged: bool
    failure: str | None
    electrode_names: tuple[str, ...]
    capacitance_F: Floats
    unknowns: int
    linear_solver: str
    max_relative_residual: float
    film_peak: FilmPeak
    warnings: tuple[str, ...] = field(default=())
    planes: Planes = ()
    progress: Floats = field(default_factory=lambda: np.zeros(0))


RIM_THICKNESSES = 5.0
"""Distance from a held rim in film thicknesses. On a clamped slice the largest strain that far in changes by 0.2 % over
elements of 0.3 to 0.02 mm (docs/verification.md)."""


@dataclass(frozen=True)
class FilmColumns:
    """The film's tetrahedra gathered through the thickness: column (k,) of each, volume (k,)."""

    column: Ints
    volume: Floats

    def mean(self, values: Floats) -> Floats:
        """The values (k, ...) of the tetrahedra with each column's mean, by volume, in their place."""
        flat = values.reshape(len(values), -1)
        total = np.bincount(self.column, self.volume)
        sums = [np.bincount(self.column, self.volume * part) for part in flat.T]
        return np.asarray((np.column_stack(sums) / total[:, None])[self.column].reshape(values.shape))


def film_columns(tet_mesh: TetMesh) -> FilmColumns:
    """Columns of the film: tetrahedra over one triangle of its plane, or in a slice over one interval of x.

    The film is extruded along z, so the corners of a tetrahedron stand over those of its triangle.
    """
    corners = tet_mesh.tets[tet_mesh.region_tets("film"), :4]
    points = tet_mesh.points_mm[corners]
    is_slice = bool(np.any(tet_mesh.twin != np.arange(len(tet_mesh.twin))))
    place = np.round(points[..., : 1 if is_slice else 2], 9).reshape(-1, 1 if is_slice else 2)
    number = np.sort(np.unique(place, axis=0, return_inverse=True)[1].reshape(corners.shape), axis=1)
    middle = np.where(number[:, 1] != number[:, 0], number[:, 1], number[:, 2])
    over = np.column_stack([number[:, 0], number[:, 3], np.zeros_like(middle) if is_slice else middle])
    edges = points[:, 1:] - points[:, :1]
    return FilmColumns(np.unique(over, axis=0, return_inverse=True)[1].ravel(), np.abs(np.linalg.det(edges)) / 6.0)


def film_peak(steps: Sequence[Step], tet_mesh: TetMesh, segment: Segment) -> FilmPeak:
    """The largest film quantities of all steps, away from held rims and anywhere."""
    tets = tet_mesh.region_tets("film")
    distance_mm = _from_held_rim(tet_mesh.points_mm[tet_mesh.tets[tets, :4]].mean(axis=1), segment)
    wanted_mm = RIM_THICKNESSES * 1e-3 * segment.film.thickness_um
    held = bool(np.isfinite(distance_mm).any())
    wanted_mm = min(wanted_mm, 0.5 * float(distance_mm.max())) if held else 0.0  # a tiny film: at least its middle
    inside = distance_mm >= wanted_mm
    strain = np.max([_largest_principal(step.fields.film_strain) for step in steps], axis=0)
    stress = np.max([_largest_principal(step.fields.film_stress_Pa) for step in steps], axis=0)
    pressed = [_largest_principal(-step.fields.film_stress_Pa[inside]).max() for step in steps]
    density = np.array([step.fields.charge_density_C_per_m2[inside] for step in steps])
    return FilmPeak(
        strain=float(strain[inside].max()),
        stress_Pa=float(stress[inside].max()),
        charge_density_C_per_m2=(float(density.min()), float(density.max())),
        rim_distance_m=1e-3 * wanted_mm,
        rim_strain=float(strain.max()),
        rim_stress_Pa=float(stress.max()),
        compression_Pa=max(0.0, float(np.max(pressed))),
    )


def _from_held_rim(points_mm: Floats, segment: Segment) -> Floats:
    """Distance (k,) of points (k, 3) from the nearest held side of the film, infinite where none is held."""
    if segment.boundary == "free" or "film" not in segment.held_layers:
        return np.full(len(points_mm), np.inf)
    distance = 0.5 * segment.length_mm - np.abs(points_mm[:, 0])
    if segment.section == "solid":
        distance = np.minimum(distance, 0.5 * segment.width_mm - np.abs(points_mm[:, 1]))
    return np.asarray(distance)


def _largest_principal(voigt: Floats) -> Floats:
    """Largest principal value (k,) of symmetric tensors (k, 6)."""
    return np.asarray(np.linalg.eigvalsh(from_voigt(voigt))[:, -1])


def fields(system: System, tet_mesh: TetMesh, whole: Unfolded, state: State, before: State) -> Fields:
    """All fields of the whole segment in a converged state.

    tet_mesh : what is solved, whole : its images; before : the state that its step started from.
    """
    trial, units = system.trial(state.x, state.load, state.time, before), system.units
    cauchy, right_cauchy_green, strain, stress = map(whole.tensors, _means(system, tet_mesh, trial, before))
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
        gap_m=_gap(system, trial, touched),
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


def _means(system: System, tet_mesh: TetMesh, trial: Trial, before: State) -> Floats:
    """Means over each element in segment axes, (4, m, 3, 3): Cauchy stress, right Cauchy-Green tensor, and of the film
    its strain and second Piola-Kirchhoff stress, 0 elsewhere.
    """
    means = np.zeros((4, len(tet_mesh.tets), 3, 3))
    for solid in system.solids:
        means[:2, tet_mesh.region_tets(solid.name)] = _medium(solid, trial, system.history_of(solid, before))
    means[:, tet_mesh.region_tets("film")] = _film(system.film, trial, system.history_of(system.film, before))
    return means


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


def _film(film: FilmRegion, trial: Trial, history: History) -> tuple[Floats, ...]:
    """Means (k, 3, 3) of Cauchy stress, right Cauchy-Green tensor, strain and stress in segment axes."""
    strain, stress = film.strain_and_stress(trial, history)
    f = deformation_gradient(film.gradient, trial.displacement[film.tets])
    sigma = f @ from_voigt(stress) @ f.swapaxes(-1, -2) / np.linalg.det(f)[..., None, None]
    tensors = sigma, f.swapaxes(-1, -2) @ f, from_voigt(strain, 2.0), from_voigt(stress)
    return tuple(_mean(each, film.weight) for each in tensors)


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
