"""The deterministic mesher: triangulate the footprint, extrude it layer by layer, split the prisms.

A plane-strain slice: the x-z section extruded once in y and split into tetrahedra.
"""

import numpy as np

from geometry.arrays import Floats, Ints
from geometry.base import InputError
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.film import MeshedSection, section_with_film, structured
from mesh.footprint import Triangulation, refine, start_triangulation
from mesh.outline import StackOutline, outline
from mesh.parameters import MeshOptions
from mesh.sizing import Sizing, graded, sizing
from mesh.tetwild import bare_stack
from mesh.types import TET_FACES, LinearMesh, boundary_faces, oriented, split_prisms, without_unused


def layered(segment: Segment, dot: DotShape, options: MeshOptions) -> LinearMesh:
    """Mesh a solid segment by extrusion. Raises InputError for a dome."""
    refuse_dome(segment)
    stack = outline(segment)
    field = sizing(stack, dot, options)
    foot = _triangulate(stack, field)
    heights, layer_region, names = levels(stack, field, options.film_layers)
    return _extrude(foot, heights, layer_region, names)


def refuse_dome(segment: Segment) -> None:
    """Raise InputError when the effector is a dome."""
    if segment.effector is not None and segment.effector.shape == "dome":
        raise InputError("mesh.mesher = layered cannot mesh segment.effector.shape = dome: use pytetwild")


def levels(stack: StackOutline, field: Sizing, film_layers: int) -> tuple[Floats, Ints, tuple[str, ...]]:
    """Heights (k + 1,), the part of each of the k layers, and the names of the parts."""
    x, y = field.centers_mm[0] if len(field.centers_mm) else (0.0, 0.0)
    x, y = np.clip(x, -stack.half_x, stack.half_x), np.clip(y, -stack.half_y, stack.half_y)

    def size(z: Floats) -> Floats:
        under_dot = field.at(np.column_stack([np.full_like(z, x), np.full_like(z, y), z]))
        if not stack.is_slice:  # resolving the held side over the whole footprint is too dear in a solid
            return under_dot
        at_side = field.at(np.column_stack([np.full_like(z, stack.half_x), np.zeros_like(z), z]))
        return np.minimum(under_dot, at_side)

    pieces = [
        ("medium2", graded(0.0, stack.film_bottom, size)),
        ("film", np.linspace(stack.film_bottom, stack.film_top, film_layers + 1)),
        ("medium1", graded(stack.film_top, stack.medium1_top, size)),
    ]
    if stack.shape != "none":
        pieces.append(("effector", graded(stack.medium1_top, stack.top, size)))
    heights = np.concatenate([[0.0], *[z[1:] for _, z in pieces]])
    part = np.concatenate([np.full(len(z) - 1, i, dtype=np.int64) for i, (_, z) in enumerate(pieces)])
    return heights, part, tuple(name for name, _ in pieces)


def _triangulate(stack: StackOutline, field: Sizing) -> Triangulation:
    """The footprint, as fine at each place as the finest of skin and film above it."""

    def size(xy: Floats) -> Floats:
        at = [np.column_stack([xy, np.full(len(xy), z)]) for z in (stack.film_top, stack.top)]
        return 1.6 * np.minimum(field.at(at[0]), field.at(at[1]))  # right triangles: hypotenuse to mean edge

    start = start_triangulation(stack, field.coarse_mm)
    return refine(start, size, stack.effector_half_x if stack.shape == "cylinder" else None)


def _extrude(foot: Triangulation, heights: Floats, layer_region: Ints, names: tuple[str, ...]) -> LinearMesh:
    """All prisms of all layers; the effector stands only on the triangles of its foot."""
    count = len(foot.points)
    points = np.column_stack([np.tile(foot.points, (len(heights), 1)), np.repeat(heights, count)])
    tets, region = [], []
    for layer, part in enumerate(layer_region):
        base = foot.triangles[foot.part == 1] if names[part] == "effector" else foot.triangles
        tets.append(split_prisms(base + layer * count, base + (layer + 1) * count))
        region.append(np.full(len(tets[-1]), part, dtype=np.int64))
    all_tets = np.concatenate(tets)
    return without_unused(LinearMesh(points, oriented(points, all_tets), np.concatenate(region), names))


SLAB = 2.0  # thickness of the slab that pytetwild meshes against that of the slice


def layered_slice(segment: Segment, dot: DotShape, options: MeshOptions) -> LinearMesh:
    """The slice from a structured graded section; its thickness is the contact element size."""
    refuse_dome(segment)
    thickness_mm = options.contact_element_size_mm
    stack = outline(segment, slice_mm=thickness_mm)
    field = sizing(stack, dot, options)
    return extruded(structured(stack, field, *levels(stack, field, options.film_layers)), thickness_mm)


def tetwild_slice(segment: Segment, dot: DotShape, options: MeshOptions) -> LinearMesh:
    """The slice from an unstructured section: the y face of a slab that pytetwild has meshed."""
    thickness_mm = options.contact_element_size_mm
    stack = outline(segment, film_thickness_mm=0.0, slice_mm=SLAB * thickness_mm)
    bare = y_face(bare_stack(segment, stack, dot, options), stack)
    section = section_with_film(bare, segment.film.thickness_um * 1e-3, options.film_layers)
    return extruded(section, thickness_mm)


def y_face(slab: LinearMesh, stack: StackOutline) -> MeshedSection:
    """The triangulation of a slab's face at the smallest y."""
    owner, face = boundary_faces(slab.tets)
    facets = slab.tets[owner[:, None], TET_FACES[face, :3]]
    chosen = (np.abs(slab.points_mm[facets, 1] + stack.half_y) < 1e-9).all(axis=1)
    used, number = np.unique(facets[chosen], return_inverse=True)
    region = slab.region[owner[chosen]]
    triangles = number.reshape(-1, 3).astype(np.int64)
    return MeshedSection(slab.points_mm[used][:, [0, 2]], triangles, region, slab.region_names)


def extruded(section: MeshedSection, thickness_mm: float) -> LinearMesh:
    """One layer of prisms from y = -thickness/2 to +thickness/2, each split into three tetrahedra."""
    count = len(section.points_mm)
    x, z = np.tile(section.points_mm, (2, 1)).T
    points = np.column_stack([x, np.repeat([-thickness_mm / 2, thickness_mm / 2], count), z])
    tets = split_prisms(section.triangles, section.triangles + count)
    region = np.repeat(section.region, 3)
    return without_unused(LinearMesh(points, oriented(points, tets), region, section.region_names))


def twins(points_mm: Floats) -> Ints:
    """For each node (n, 3) the lowest node of equal x and z, shape (n,)."""
    _, first, number = np.unique(np.round(points_mm[:, [0, 2]] * 1e7), axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[number.ravel()], dtype=np.int64)
