"""From parameters and a mesh to the discrete problem in solver units."""

from collections.abc import Mapping

import numpy as np

from geometry.dot_shape import DotShape
from geometry.parameters import Segment
from mesh.types import Floats, TetMesh
from solve.contact import contact_facets
from solve.dot_distance import RigidDot
from solve.film import FilmRegion, film_region
from solve.materials.laws import MediumLaw, medium_law
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.materials.piezoelectric import FilmLaw, film_law
from solve.sides import SideSprings, side_springs
from solve.solid import SolidRegion, solid_region
from solve.sparsity import build_pattern
from solve.system import System, Units
from solve.unknowns import Unknowns, number


def build_system(
    segment: Segment,
    materials: Mapping[str, Material],
    dot: DotShape,
    tet_mesh: TetMesh,
    force_driven: bool = False,
) -> System:
    """Discretise a press. materials : region name -> material, one for each region of the mesh."""
    laws = {name: medium_law(materials[name]) for name in tet_mesh.region_names if name != "film"}
    film = materials["film"]
    if not isinstance(film, PiezoelectricFilm):
        raise TypeError(f"the film needs a piezoelectric-film material, not {film.model}")
    units = _units(segment, laws, film)
    points = tet_mesh.points_mm * (1e-3 / units.length)
    held = segment.held_layers if segment.boundary == "clamped" else ()
    unknowns = number(
        tet_mesh, held, segment.section == "plane-strain", max(1, len(segment.film.electrodes)),
        film.coupling == "two-way", force_driven,
    )
    solids = tuple(_solid(name, law, points, tet_mesh, unknowns, units) for name, law in laws.items())
    piezo = _film(segment, film, points, tet_mesh, unknowns, units)
    sides = _sides(segment, points, tet_mesh, unknowns, units)
    contact = contact_facets(points, tet_mesh.facets["contact"], unknowns, RigidDot(dot, 1e3 * units.length))
    groups = [*(s.dofs for s in solids), piezo.dofs, *(s.dofs for s in sides), contact.dofs]
    pattern = build_pattern(groups, unknowns.count)
    return System(points, unknowns, units, solids, piezo, sides, contact, pattern)


def _units(segment: Segment, laws: Mapping[str, MediumLaw], film: PiezoelectricFilm) -> Units:
    length = 1e-3 * segment.length_mm
    coupling = 1e-12 * max(abs(film.d31_pC_per_N), abs(film.d33_pC_per_N), 1e-3)
    return Units(length, max(law.shear_modulus for law in laws.values()), length / coupling)


def _solid(
    name: str, law: MediumLaw, points: Floats, tet_mesh: TetMesh, unknowns: Unknowns, units: Units
) -> SolidRegion:
    index = tet_mesh.region_tets(name)
    tets = tet_mesh.tets[index]
    dofs = np.concatenate([unknowns.displacement[tets].reshape(-1, 30), unknowns.pressure[index]], axis=1)
    return solid_region(name, law.scaled(1.0 / units.stress), points, tets, dofs)


def _film(
    segment: Segment, film: PiezoelectricFilm, points: Floats, tet_mesh: TetMesh, unknowns: Unknowns, units: Units
) -> FilmRegion:
    law = film_law(film, segment.film.draw_angle_deg)
    scaled = FilmLaw(
        stiffness=law.stiffness / units.stress,
        coupling=law.coupling * (units.voltage / units.length),
        permittivity=law.permittivity * units.voltage**2 / (units.length**2 * units.stress),
        to_film_axes=law.to_film_axes,
    )
    tets = tet_mesh.tets[tet_mesh.region_tets("film")]
    thickness = 1e-6 * segment.film.thickness_um / units.length
    rectangles = electrode_rectangles(segment) * (1e-3 / units.length)
    return film_region(scaled, points, tets, unknowns.displacement, unknowns.voltage, rectangles, thickness)


def electrode_rectangles(segment: Segment) -> Floats:
    """Electrodes as (e, 4) x0, x1, y0, y1 in mm; without any, one over everything.

    In a plane-strain slice nothing varies over y: the electrodes then reach over the whole slice, and their
    share of the width is applied with the width (see scale_of_section).
    """
    if not segment.film.electrodes:
        return np.array([[-np.inf, np.inf, -np.inf, np.inf]])
    centre = np.array([e.center_mm for e in segment.film.electrodes])
    half = 0.5 * np.array([e.size_mm for e in segment.film.electrodes])
    rectangles = np.column_stack([centre - half, centre + half])[:, [0, 2, 1, 3]]
    if segment.section == "plane-strain":
        rectangles[:, 2:] = -np.inf, np.inf
    return rectangles


def scale_of_section(segment: Segment, tet_mesh: TetMesh) -> tuple[float, Floats]:
    """Factors from what is meshed to the whole segment: for the force, and for each electrode's charge (e,)."""
    count = max(1, len(segment.film.electrodes))
    if segment.section == "solid":
        return 1.0, np.ones(count)
    force = segment.width_mm / tet_mesh.thickness_mm
    if not segment.film.electrodes:
        return force, np.array([force])
    widths = np.array([e.size_mm[1] for e in segment.film.electrodes])
    return force, np.minimum(widths, segment.width_mm) / tet_mesh.thickness_mm


def _sides(
    segment: Segment, points: Floats, tet_mesh: TetMesh, unknowns: Unknowns, units: Units
) -> tuple[SideSprings, ...]:
    if segment.boundary != "elastic":
        return ()
    stiffness = 1e9 * segment.side_stiffness_N_per_mm3 * units.length / units.stress
    names = [f"side-{name}" for name in segment.held_layers if f"side-{name}" in tet_mesh.facets]
    return tuple(side_springs(points, tet_mesh.facets[name], unknowns.displacement, stiffness) for name in names)


