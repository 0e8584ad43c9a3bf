"""A plane-strain slice: the x-z section extruded once in y and split into tetrahedra."""

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.film_layers import section_with_film
from mesh.layered import layer_heights, refuse_dome
from mesh.options import MeshOptions
from mesh.outline import StackOutline, stack_outline
from mesh.section import MeshedSection, structured_section
from mesh.sizing import sizing_field
from mesh.tetwild import mesh_without_film
from mesh.types import TET_FACES, LinearMesh, Planes, boundary_faces, orient_tets, split_prisms, without_unused

SLAB_PER_SLICE_THICKNESS = 2.0  # thickness of the slab that pytetwild meshes against that of the slice


def layered_slice(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> LinearMesh:
    """The slice of a structured graded section, as thick as the contact element size. InputError for a dome."""
    refuse_dome(segment)
    thickness_mm = options.contact_element_size_mm
    stack = stack_outline(segment, slice_mm=thickness_mm, planes=planes)
    field = sizing_field(stack, dot, options)
    half, foot = stack.half_x, stack.effector_half_x
    edges = [-half, -foot, 0.0, foot, half] if 0.0 < foot < half * (1 - 1e-9) else [-half, 0.0, half]

    def holds(layer: str, x: Floats, _height: float) -> Bools:
        return np.abs(x) < (foot if layer == "effector" else half)

    section = structured_section(field, *layer_heights(stack, field, options.film_layers), edges, holds)
    return extrude_section(section, thickness_mm)


def tetwild_slice(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> LinearMesh:
    """The slice of an unstructured section: the y face of a slab that pytetwild has meshed. MeshingError."""
    thickness_mm = options.contact_element_size_mm
    stack = stack_outline(
        segment, film_thickness_mm=0.0, slice_mm=SLAB_PER_SLICE_THICKNESS * thickness_mm, planes=planes
    )
    bare = slab_face(mesh_without_film(segment, stack, dot, options), stack)
    section = section_with_film(bare, segment.film.thickness_um * 1e-3, options.film_layers)
    return extrude_section(section, thickness_mm)


def slab_face(slab: LinearMesh, stack: StackOutline) -> MeshedSection:
    """The triangulation of a slab's face at the smallest y."""
    owner, face = boundary_faces(slab.tets)
    facets = slab.tets[owner[:, None], TET_FACES[face, :3]]
    chosen = (np.abs(slab.points_mm[facets, 1] + stack.half_y) < 1e-9).all(axis=1)
    used, number = np.unique(facets[chosen], return_inverse=True)
    region = slab.region[owner[chosen]]
    triangles = number.reshape(-1, 3).astype(np.int64)
    return MeshedSection(slab.points_mm[used][:, [0, 2]], triangles, region, slab.region_names)


def extrude_section(section: MeshedSection, thickness_mm: float) -> LinearMesh:
    """Extrude a section into one layer of prisms, y = -thickness/2 to +thickness/2, of three tetrahedra each."""
    count = len(section.points_mm)
    x, z = np.tile(section.points_mm, (2, 1)).T
    points = np.column_stack([x, np.repeat([-thickness_mm / 2, thickness_mm / 2], count), z])
    tets = split_prisms(section.triangles, section.triangles + count)
    region = np.repeat(section.region, 3)
    return without_unused(LinearMesh(points, orient_tets(points, tets), region, section.region_names))


def node_twins(points_mm: Floats) -> Ints:
    """For each node (n, 3) the lowest number of a node of equal x and z, shape (n,)."""
    _, first, number = np.unique(np.round(points_mm[:, [0, 2]] * 1e7), axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[number.ravel()], dtype=np.int64)
