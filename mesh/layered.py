"""The deterministic mesher: triangulate the footprint, extrude it layer by layer, split the prisms."""

import numpy as np

from geometry.dot_shape import DotShape
from geometry.errors import InputError
from geometry.parameters import Segment
from mesh.bisection import Triangulation, refine
from mesh.footprint import start_triangulation
from mesh.linear import LinearMesh, oriented, split_prisms, without_unused
from mesh.outline import Outline, outline
from mesh.parameters import MeshOptions
from mesh.sizing import Sizing, sizing
from mesh.spacing import graded
from mesh.types import Floats, Ints


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


def levels(stack: Outline, field: Sizing, film_layers: int) -> tuple[Floats, Ints, tuple[str, ...]]:
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


def _triangulate(stack: Outline, field: Sizing) -> Triangulation:
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
