"""The deterministic mesher: triangulate the footprint, extrude it layer by layer, split the prisms."""

from collections.abc import Iterable

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.bisection import Triangulation, refine
from mesh.footprint import start_triangulation
from mesh.options import MeshOptions
from mesh.outline import StackOutline, stack_outline
from mesh.sizing import Sizing, graded_points_through, sizing_field
from mesh.types import LinearMesh, Planes, orient_tets, split_prisms, without_unused

SAME_HEIGHT_MM = 1e-9


def layered_mesh(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> LinearMesh:
    """Mesh a solid segment by extrusion, as far as its mirror planes. InputError for a dome."""
    refuse_dome(segment)
    stack = stack_outline(segment, planes=planes)
    field = sizing_field(stack, dot, options)
    foot = _triangulate_footprint(stack, field)
    heights, layer_region, names = layer_heights(stack, field, options.film_layers)
    return _extrude_footprint(foot, heights, layer_region, names)


def refuse_dome(segment: Segment) -> None:
    """Raise InputError when the effector is a dome."""
    if segment.effector is not None and segment.effector.shape == "dome":
        raise InputError("mesh.mesher = layered cannot mesh segment.effector.shape = dome: use pytetwild")


def layer_heights(
    stack: StackOutline, field: Sizing, film_layers: int, breaks: Iterable[float] = ()
) -> tuple[Floats, Ints, tuple[str, ...]]:
    """Heights (k + 1,) in mm of the layers of elements, the part (k,) of each layer, and the names of the parts.

    breaks : heights in the media and the effector at which a layer of elements must end.
    """
    x, y = field.centers_mm[0] if len(field.centers_mm) else (0.0, 0.0)
    x, y = np.clip(x, -stack.half_x, stack.half_x), np.clip(y, -stack.half_y, stack.half_y)

    def size(z: Floats) -> Floats:
        under_dot = field.at(np.column_stack([np.full_like(z, x), np.full_like(z, y), z]))
        if not stack.is_slice:  # resolving the held side over the whole footprint is too dear in a solid
            return under_dot
        at_side = field.at(np.column_stack([np.full_like(z, field.side_x_mm), np.zeros_like(z), z]))
        return np.minimum(under_dot, at_side)

    def through(bottom: float, top: float) -> Floats:
        inside = {z for z in breaks if bottom + SAME_HEIGHT_MM < z < top - SAME_HEIGHT_MM}
        return graded_points_through([bottom, *sorted(inside), top], size)

    pieces = [
        ("medium2", through(0.0, stack.film_bottom)),
        ("film", np.linspace(stack.film_bottom, stack.film_top, film_layers + 1)),
        ("medium1", through(stack.film_top, stack.medium1_top)),
    ]
    if stack.shape != "none":
        pieces.append(("effector", through(stack.medium1_top, stack.top)))
    heights = np.concatenate([[0.0], *[z[1:] for _, z in pieces]])
    part = np.concatenate([np.full(len(z) - 1, i, dtype=np.int64) for i, (_, z) in enumerate(pieces)])
    return heights, part, tuple(name for name, _ in pieces)


def _triangulate_footprint(stack: StackOutline, field: Sizing) -> Triangulation:
    """The triangulation of the footprint, as fine at each place as the finest of skin and film above it."""

    def size(xy: Floats) -> Floats:
        at = [np.column_stack([xy, np.full(len(xy), z)]) for z in (stack.film_top, stack.top)]
        return 1.6 * np.minimum(field.at(at[0]), field.at(at[1]))  # right triangles: hypotenuse to mean edge

    start = triangles_beside_planes(start_triangulation(stack, field.coarse_mm), stack.planes)
    return refine(start, size, stack.effector_half_x if stack.shape == "cylinder" else None)


def triangles_beside_planes(start: Triangulation, planes: Planes) -> Triangulation:
    """Triangles on the positive side of every mirror plane; the start is symmetric, and so is its bisection."""
    middle = start.points[start.triangles].mean(axis=1)
    kept = (middle[:, list(planes)] > 0.0).all(axis=1)
    used, number = np.unique(start.triangles[kept], return_inverse=True)
    return Triangulation(start.points[used], number.reshape(-1, 3).astype(np.int64), start.part[kept])


def _extrude_footprint(foot: Triangulation, heights: Floats, layer_region: Ints, names: tuple[str, ...]) -> LinearMesh:
    """Tetrahedra of all prisms of all layers; the effector stands only on the triangles of its foot."""
    count = len(foot.points)
    points = np.column_stack([np.tile(foot.points, (len(heights), 1)), np.repeat(heights, count)])
    tets, region = [], []
    for layer, part in enumerate(layer_region):
        base = foot.triangles[foot.part == 1] if names[part] == "effector" else foot.triangles
        tets.append(split_prisms(base + layer * count, base + (layer + 1) * count))
        region.append(np.full(len(tets[-1]), part, dtype=np.int64))
    all_tets = np.concatenate(tets)
    return without_unused(LinearMesh(points, orient_tets(points, all_tets), np.concatenate(region), names))
