"""The default mesher: pytetwild (fTetWild) on the merged surfaces of the parts."""

import logging

import numpy as np

from geometry.dot_shape import DotShape
from geometry.parameters import Segment
from geometry.stack import layers
from mesh.background import background
from mesh.child import tetrahedralize
from mesh.errors import MeshingError
from mesh.film import with_film
from mesh.linear import LinearMesh, oriented, shape, without_unused
from mesh.outline import Outline, outline
from mesh.parameters import MeshOptions
from mesh.part_surfaces import merged_surface
from mesh.sizing import sizing
from mesh.snap import snapped
from mesh.types import Floats, Ints

STOP_ENERGY = 7.0
WEDGE_ENERGY = 60.0
SHALLOW = 0.7  # twice the height over the radius of a dome: it then meets medium 1 at less than 40 degrees
FLAT = 2e-3  # a tetrahedron of this shape or less counts as flat
ENVELOPE = 1e-3  # of the diagonal: how far pytetwild may leave the surface
LOOSER = 0.04  # the same of an element under the dot or the thinnest part, where that is more
LOG = logging.getLogger(__name__)
ATTEMPTS = 3  # pytetwild is not repeatable: another attempt gives another mesh


def tetwild(segment: Segment, dot: DotShape, options: MeshOptions) -> LinearMesh:
    """Mesh a solid segment. Raises MeshingError when pytetwild fails, hangs or leaves an inverted element."""
    stack = outline(segment, film_thickness_mm=0.0)
    bare = bare_stack(segment, stack, dot, options)
    return with_film(bare, segment.film.thickness_um * 1e-3, options.film_layers)


def bare_stack(segment: Segment, stack: Outline, dot: DotShape, options: MeshOptions) -> LinearMesh:
    """The stack without its film: regions 0 medium2, 1 medium1, 2 effector."""
    thicknesses_mm = (layer.thickness_mm for layer in layers(segment) if layer.name != "film")
    detail_mm = min(options.contact_element_size_mm, *thicknesses_mm)
    vertices, faces = merged_surface(segment, stack, detail_mm)
    diagonal_mm = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    bg_vertices, bg_tets, bg_values = background(stack, sizing(stack, dot, options))
    for attempt in range(ATTEMPTS):
        points, tets = tetrahedralize(
            options.timeout_s,
            vertices=vertices,
            faces=faces,
            bg_vertices=bg_vertices,
            bg_tets=bg_tets,
            bg_values=bg_values,
            edge_length=options.element_size_mm,
            epsilon=max(ENVELOPE, LOOSER * detail_mm / diagonal_mm),
            stop_energy=stop_energy(stack, options) * 1.5**attempt,
            coarsen=options.coarsen,
        )
        bare = _labelled(points, oriented(points, tets), stack)
        flat = int((shape(bare.points_mm, bare.tets) <= FLAT).sum())
        LOG.debug("pytetwild, attempt %d: %d tetrahedra, %d of them flat", attempt + 1, len(tets), flat)
        if not flat:
            return bare
    raise MeshingError(
        f"pytetwild left {flat} flat elements in each of {ATTEMPTS} attempts: change mesh.element_size_mm or "
        "mesh.contact_element_size_mm a little"
    )


def stop_energy(stack: Outline, options: MeshOptions) -> float:
    """The distortion at which pytetwild stops: low, but not where the shape itself has a narrow wedge.

    A flat dome meets medium 1 at a small angle, and a round foot may touch the side of the segment: there no
    element can be good, and the mesher would refine without end. Coarsening makes every element as distorted as
    this allows, and undoes the refinement.
    """
    if options.coarsen or stack.shape not in ("cylinder", "dome") or (stack.shape == "cylinder" and stack.is_slice):
        return STOP_ENERGY
    narrow = min(stack.half_x, stack.half_y) - stack.effector_half_x < options.contact_element_size_mm
    shallow = stack.shape == "dome" and 2 * (stack.top - stack.medium1_top) < SHALLOW * stack.effector_half_x
    return WEDGE_ENERGY if (narrow and not stack.is_slice) or shallow else STOP_ENERGY


def _labelled(points: Floats, tets: Ints, stack: Outline) -> LinearMesh:
    """Keep the tetrahedra inside the parts, label them and put nodes onto exact surfaces."""
    region = region_of(points[tets].mean(axis=1), stack)
    inside = region >= 0
    names = ("medium2", "medium1", "effector")[: 2 if stack.shape == "none" else 3]
    kept = without_unused(LinearMesh(points, tets[inside], region[inside], names))
    exact = snapped(kept.points_mm, kept.tets, kept.region, stack)
    return LinearMesh(exact, kept.tets, kept.region, kept.region_names)


def region_of(points: Floats, stack: Outline) -> Ints:
    """Part of each point (n, 3): 0 medium2, 1 medium1, 2 effector, -1 outside."""
    x, y, z = np.abs(points[:, 0]), np.abs(points[:, 1]), points[:, 2]
    foot = (x < stack.half_x) & (y < stack.half_y)
    result = np.full(len(points), -1, dtype=np.int64)
    result[foot & (z > 0) & (z < stack.film_bottom)] = 0
    result[foot & (z > stack.film_top) & (z < stack.medium1_top)] = 1
    effector = stack.inside_effector(points[:, :2]) & (z > stack.medium1_top) & (z < stack.top)
    if stack.shape == "dome":
        across = x if stack.is_slice else np.hypot(x, y)
        effector &= np.hypot(across, z - stack.dome_centre_z) < stack.dome_radius
    result[effector] = 2
    return result
