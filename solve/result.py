"""What a press gives back: load history and fields at each step, in SI units."""

from dataclasses import dataclass, field

import numpy as np

from foundation.arrays import Floats, Ints
from mesh.types import Planes, TetMesh


@dataclass(frozen=True)
class Fields:
    """Fields at one load step; cell arrays follow the mesh's tetrahedra.

    displacement_m : (n, 3)
    cauchy_stress_Pa : (m, 6) xx, yy, zz, xy, yz, xz (VTK's order of a symmetric tensor), mean over the element
    green_lagrange_strain : (m, 6) same order, mean over the element, shears are tensor components
    von_mises_Pa, pressure_Pa (positive in compression), max_stretch : (m,)
    film_tets : (k,) indices of the film's tetrahedra; the film arrays follow it, in the film's own axes (1 along
        the draw direction, 2 across, 3 normal):
    The film arrays are means through the film's thickness (solve.film_means), the same for all tetrahedra that
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
