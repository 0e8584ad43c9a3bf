"""From parameters and a mesh to the discrete problem in solver units."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from geometry.dot import DotShape
from geometry.electrode_outlines import electrode_outlines
from geometry.parameters import Segment
from mesh.types import TetMesh
from solve.fem.numbering import Numbers, Unknowns, number
from solve.fem.pattern import build_pattern
from solve.materials.film import FilmLaw, film_law
from solve.materials.inelastic import Inelastic, sort_laws
from solve.materials.laws import MediumLaw
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.model import Readout
from solve.open_interfaces import OpenInterface
from solve.physics import Physics
from solve.readout.channel_parts import capacitances_F, conductances_uS
from solve.symmetry import electrode_orbits
from solve.system import System
from solve.terms.base import Term
from solve.terms.bond import bond
from solve.terms.builder import Builder
from solve.terms.circuit import Circuit, TiedInputs
from solve.terms.contact import contact_facets
from solve.terms.definition import TermDefinition
from solve.terms.elastic_sides import side_springs
from solve.terms.film import FilmRegion, film_region
from solve.terms.rig import RigTerm
from solve.terms.rigid_dot import RigidDot
from solve.terms.solid import SolidRegion, solid_region
from solve.terms.unilateral_interface import opening_nodes, unilateral_interface
from solve.units import solver_units
from solve.whole_segment import meshed_share, whole_charge


def refuse_unresolved_electrodes(segment: Segment, tet_mesh: TetMesh, film: FilmRegion) -> None:
    """InputError for an electrode whose voltage acts back on the film and that is over no middle of an element."""
    if (film.voltage_dofs < 0).all():
        return
    elements = np.array([np.count_nonzero(film.electrode == number) for number in range(film.electrodes)])
    whole = whole_charge(segment, tet_mesh) @ elements
    for electrode, covered in zip(segment.film.electrodes, whole, strict=False):
        if covered == 0.0:
            raise InputError(
                f"segment.film.electrodes: '{electrode.name}' is smaller than the elements of the film; "
                "reduce mesh.film_element_size_mm"
            )


def build_system(
    segment: Segment,
    materials: Mapping[str, Material],
    dot: DotShape,
    tet_mesh: TetMesh,
    force_driven: bool = False,
    physics: Physics | None = None,
    readout: Readout | None = None,
    opened: tuple[OpenInterface, ...] = (),
    like: System | None = None,
    separate_channels: bool = False,
) -> System:
    """Discretise a press. materials : region name -> material, one for each region of the mesh.

    tet_mesh and opened as solve.open_interfaces.open_interfaces gives them; like : a system on the same mesh before it
    was moved, whose units and numbers are shared; separate_channels : as of a Model.
    """
    physics = physics or Physics()
    laws = {name: materials[name].law.scale_moduli(1e6) for name in tet_mesh.region_names if name != "film"}
    numbers, parallel = Numbers(), readout is not None and not separate_channels
    units = solver_units(segment, laws, materials) if like is None else like.units
    points = tet_mesh.points_mm * (1e-3 / units.length)
    places = points if like is None else like.points
    unknowns = _number_unknowns(
        segment, materials, laws, tet_mesh, places, physics, readout, parallel, force_driven, numbers
    )
    contact = contact_facets(points, tet_mesh.facets["contact"], unknowns, RigidDot(dot, 1e3 * units.length))
    share = meshed_share(segment, tet_mesh)
    make = Builder(segment, materials, tet_mesh, points, unknowns, numbers, units, contact, share, force_driven)
    film = _film_region(make, physics)
    terms: list[Term] = [_solid_region(make, physics, name, law) for name, law in laws.items()]
    terms += [film, *_side_springs(make), *_interface_terms(make, physics, opened)]
    terms += _circuit_terms(make, film, physics, readout, separate_channels)
    terms += _dot_terms(make, physics.terms)
    pattern = build_pattern([group for term in terms for group in term.groups], numbers.count)
    return System(points, unknowns, numbers.count, units, tuple(terms), contact, pattern)


def _number_unknowns(
    segment: Segment,
    materials: Mapping[str, Material],
    laws: Mapping[str, MediumLaw],
    tet_mesh: TetMesh,
    places: Floats,
    physics: Physics,
    readout: Readout | None,
    parallel: bool,
    force_driven: bool,
    numbers: Numbers,
) -> Unknowns:
    """Number the unknowns of a press. places : nodes (n, 3) by whose order unknowns are numbered; parallel : one
    amplifier has all electrodes; numbers : hands the numbers out.
    """
    film = materials["film"]
    two_way = isinstance(film, PiezoelectricFilm) and film.coupling == "two-way"
    virtual_ground = readout is not None and readout.mode == "charge"
    return number(
        tet_mesh,
        places,
        numbers,
        held_regions=segment.held_layers if segment.boundary == "clamped" else (),
        plane_strain=segment.section == "plane-strain",
        without_pressure=("film", *(name for name, law in laws.items() if law.compressible)),
        electrodes=electrode_orbits(electrode_outlines(segment), tet_mesh.planes),
        two_way=two_way and not virtual_ground,
        parallel=parallel,
        approach=force_driven or any(one.frees_dot for one in physics.terms),
        freed=tuple(name for one in physics.terms for name in one.frees),
    )


def _solid_region(make: Builder, physics: Physics, name: str, law: MediumLaw) -> SolidRegion:
    """The medium of a region with its laws, in solver units."""
    index = make.tet_mesh.region_tets(name)
    tets = make.tet_mesh.tets[index]
    dofs = make.unknowns.displacement[tets].reshape(-1, 30)
    if not law.compressible:
        dofs = np.concatenate([dofs, make.unknowns.pressure[index]], axis=1)
    scaled = law.scale_moduli(1.0 / make.units.stress)
    return solid_region(name, scaled, make.points, tets, dofs, _laws_around(make, physics, name, scaled))


def _film_region(make: Builder, physics: Physics) -> FilmRegion:
    """The film with its electrodes and laws, in solver units."""
    units, film = make.units, make.film_material
    law = film_law(film, make.segment.film.draw_angle_deg)
    scaled = FilmLaw(
        stiffness=law.stiffness / units.stress,
        coupling=law.coupling * (units.voltage / units.length),
        permittivity=law.permittivity * units.voltage**2 / (units.length**2 * units.stress),
        to_film_axes=law.to_film_axes,
    )
    return film_region(
        scaled,
        make.points,
        make.tet_mesh.tets[make.tet_mesh.region_tets("film")],
        make.unknowns.displacement,
        make.unknowns.voltage,
        [1e-3 / units.length * np.asarray(outline) for outline in electrode_outlines(make.segment)],
        1e-6 * make.segment.film.thickness_um / units.length,
        physics.prestretch,
        _laws_around(make, physics, "film", scaled),
    )


def _side_springs(make: Builder) -> Iterator[Term]:
    """Springs at the sides of the held layers, where the boundary is elastic."""
    segment, facets = make.segment, make.tet_mesh.facets
    if segment.boundary != "elastic":
        return
    stiffness = make.per_area(segment.side_stiffness_N_per_mm3)
    for name in segment.held_layers:
        if f"side-{name}" in facets:
            yield side_springs(make.points, facets[f"side-{name}"], make.unknowns.displacement, stiffness)


def _interface_terms(make: Builder, physics: Physics, opened: tuple[OpenInterface, ...]) -> Iterator[Term]:
    """Bonds and delaminated patches of the interfaces that open."""
    dofs = make.unknowns.displacement
    for face in opened:
        line, glued = physics.bonds.get(face.name), ~face.delaminated
        if line is not None and glued.any():
            normal = make.per_area(line.normal_stiffness_N_per_mm3)
            shear = make.per_area(line.shear_stiffness_N_per_mm3)
            laws = _laws_around(make, physics, face.name, None)
            yield bond(make.points, face.lower[glued], face.upper[glued], dofs, normal, shear, laws)
        if face.delaminated.any():
            lower, upper = face.lower[face.delaminated], face.upper[face.delaminated]
            multipliers = make.numbers.take(opening_nodes(lower, upper, dofs)[1])
            yield unilateral_interface(make.points, lower, upper, dofs, multipliers)


def _circuit_terms(
    make: Builder, film: FilmRegion, physics: Physics, readout: Readout | None, separate_channels: bool
) -> Iterator[Term]:
    """Terms of the amplifiers' inputs, where their voltages act back on the film.

    Electrodes of one voltage, in parallel or images of each other, have the inputs of all of them: one in parallel, one
    for each image.
    """
    units, dofs = make.units, make.unknowns.voltage
    if readout is None or dofs[0] < 0:
        return
    farad, parts = units.charge / units.voltage, physics.channels if separate_channels else ()
    leak_uS, mutual_F = conductances_uS(parts, len(dofs)), capacitances_F(parts, len(dofs))
    for dof in np.unique(dofs):
        joined = dofs == dof
        share = make.share * (int(joined.sum()) if separate_channels else 1)
        own_uS = float(leak_uS[np.flatnonzero(joined)[0]])  # its images have the same
        conductance_uS = 1.0 / (readout.input_resistance_MOhm or np.inf) + own_uS
        resistance = (1e6 / conductance_uS if conductance_uS else np.inf) * farad / share
        input_capacitance = 1e-12 * readout.whole_input_pF / farad * share
        yield Circuit(int(dof), float(film.capacitance()[joined].sum()), input_capacitance, resistance)
    if mutual_F.any():
        known, of = np.unique(dofs, return_inverse=True)
        joined_by = np.eye(len(known))[of]
        matrix = joined_by.T @ mutual_F @ joined_by
        yield TiedInputs(known, make.share / farad * matrix)


def _dot_terms(make: Builder, stated: tuple[TermDefinition, ...]) -> Iterator[Term]:
    """Terms of the contact, of the mechanisms, and of the force that drives."""
    if not any(one.is_contact for one in stated):
        yield make.contact
    for one in stated:
        yield from one.build(make)
    if make.force_driven:
        yield RigTerm(make.unknowns.approach, None, alone=not any(one.resists for one in stated))


def _laws_around(make: Builder, physics: Physics, place: str, elastic: Any) -> tuple[Inelastic, ...]:
    """Laws with memory around the elastic one of a layer, in solver units, or around that of a bond."""
    return tuple(law.around(elastic, make.MPa) for law in sort_laws(physics.inelastic.get(place, ())))
