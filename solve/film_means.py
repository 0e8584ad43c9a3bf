"""Film strain, stress and charge density: one definition for every number, picture and file.

The film is far thinner than wide, and its charge per area is the mean of d . S through its thickness (the electrodes
collect nothing else). So all film quantities are means through the thickness, which bending does not enter (of a
plate bent about its middle the mean strain vanishes: Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells,
1959, ch. 1). At a held rim the stress inside a bonded film is singular (Williams, J. Appl. Mech. 19, 1952, 526-528).
Its mean through the thickness is bounded, as it carries a finite force, but usual meshes do not resolve it there. The
largest value is therefore looked for at a stated distance from held rims, and the largest of all told beside it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from geometry.parameters import Segment
from mesh.types import TetMesh
from solve.result import FilmPeak, Step
from solve.tensors import from_voigt

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
    distance_mm = _distance_to_held_rim_mm(tet_mesh.points_mm[tet_mesh.tets[tets, :4]].mean(axis=1), segment)
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


def _distance_to_held_rim_mm(points_mm: Floats, segment: Segment) -> Floats:
    """Distance (k,) in mm of points (k, 3) from the nearest held side of the film, infinite where none is held."""
    if segment.boundary == "free" or "film" not in segment.held_layers:
        return np.full(len(points_mm), np.inf)
    distance = 0.5 * segment.length_mm - np.abs(points_mm[:, 0])
    if segment.section == "solid":
        distance = np.minimum(distance, 0.5 * segment.width_mm - np.abs(points_mm[:, 1]))
    return np.asarray(distance)


def _largest_principal(voigt: Floats) -> Floats:
    """Largest principal value (k,) of symmetric tensors (k, 6)."""
    return np.asarray(np.linalg.eigvalsh(from_voigt(voigt))[:, -1])
