"""Data of the studio's 3D view: a closed surface of every part and the tetrahedra inside, as plain arrays.

Arrays travel as they are, in binary frames. The corners of all triangles and tetrahedra are nodes that belong to one
part each, so that parts can be hidden and any plane can be laid through them in the page.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from export.cutaway import is_slice
from export.dot_surface import dot_parts, in_segment_frame, placed_dot
from export.nodal_values import SplitNodes
from export.skin import MM_PER_M, NodalSteps, nodal_steps
from export.subdivision import TETRA_CHILDREN, TRIANGLE_CHILDREN
from export.viewer_data import (
    byte_shares,
    colour_map_bytes,
    displacement_steps,
    field_tops,
    rgb,
    spread_steps,
    step_caption,
    triangle_corners,
)
from foundation.arrays import Floats, Ints
from geometry.dot import DotShape
from geometry.solids import PART_COLOURS
from geometry.triangulation import triangulated
from mesh.types import TET_FACES, TetMesh
from solve.result import PressResult, Step

TESSELLATION_CHORD_MM, TESSELLATION_ANGLE_RAD = 0.02, 0.3
MOST_CURVED_TETS = 40_000
"""Above this the quadratic tetrahedra are drawn by their corners only."""
MOST_NODE_STEPS = 1_500_000
"""Nodes times steps that the page is sent at most; of larger meshes fewer steps are shown, at least the last one."""
View = dict[str, Any]


def press_view(tet_mesh: TetMesh, result: PressResult, dot_shape: DotShape) -> View:
    """The view of a press, lengths in mm.

    steps : indentation and force of each of s steps; names, colours : of the parts, by region. points (n, 3),
    displacement (s, n, 3) in displacementUnit; region (n,); triangles (t, 3) of the closed surface of every part;
    tets (m, 4). stress, strain, charge, pressure (s, n) are shares of their value in tops, charge from -top to top.
    dotPoints (3 k, 3) : loose triangles of the dot, which dotShift (s, 3) moves.
    """
    steps = result.steps
    chosen = [steps[k] for k in spread_steps(len(steps))]
    nodes = nodal_steps(tet_mesh, chosen)
    triangles, tets = _closed_triangles(nodes.split), nodes.split.tets
    used = np.arange(len(nodes.points_mm))
    if len(tets) <= MOST_CURVED_TETS:
        triangles, tets = (
            cells[:, np.array(children)].reshape(-1, len(children[0]))
            for cells, children in ((triangles, TRIANGLE_CHILDREN), (tets, TETRA_CHILDREN))
        )
    else:
        used, tets = np.unique(tets[:, :4], return_inverse=True)
        place = np.zeros(len(nodes.points_mm), np.int64)
        place[used] = np.arange(len(used))
        triangles, tets = place[triangles[:, :3]], tets.reshape(-1, 4)
    kept = _last_steps(len(chosen), len(used))
    shown = np.ix_(np.array(kept), used)
    names = tet_mesh.region_names
    return {
        "steps": [step_caption(chosen[k]) for k in kept],
        **_parts(names),
        "slice": is_slice(tet_mesh),
        "plane": float(chosen[-1].dot_position_m[1]) * MM_PER_M,
        "points": np.asarray(nodes.points_mm[used], np.float32),
        "region": np.asarray(nodes.split.region[used], np.uint8),
        "triangles": np.asarray(triangles, np.uint32),
        "tets": np.asarray(tets, np.uint32),
        **displacement_steps(nodes.displacement_mm[shown]),
        **_fields(nodes, shown, names.index("film"), result),
        **_dot(tet_mesh, [chosen[k] for k in kept], dot_shape),
    }


def _last_steps(steps: int, nodes: int) -> list[int]:
    """The first and last step and as many between as MOST_NODE_STEPS allows."""
    count = max(1, min(steps, MOST_NODE_STEPS // nodes))
    return [steps - 1] if count == 1 else sorted({round(k) for k in np.linspace(0, steps - 1, count)})


def _closed_triangles(split: SplitNodes) -> Ints:
    """Quadratic facets (k, 6) between parts and outside, one for each part that it bounds."""
    facets = split.tets[:, TET_FACES].reshape(-1, 6)
    keys = np.ravel_multi_index(tuple(np.sort(facets[:, :3], axis=1).T), (len(split.node),) * 3)
    _, first, count = np.unique(keys, return_index=True, return_counts=True)
    return np.asarray(facets[first[count == 1]])


def _fields(nodes: NodalSteps, chosen: tuple[Any, ...], film: int, result: PressResult) -> View:
    """Fields at the chosen steps and nodes as bytes, and the value of a whole one."""
    soft = nodes.split.region != film
    tops = field_tops(nodes.von_mises_MPa[-1, soft], nodes.contact_pressure_MPa, result.film_peak)
    arrays = {
        "stress": nodes.von_mises_MPa, "strain": nodes.film_strain, "charge": nodes.charge_pC_per_mm2,
        "pressure": nodes.contact_pressure_MPa,
    }  # fmt: skip
    signed = {"charge": tops["charge"]}
    found = {
        name: byte_shares(array[chosen] + signed.get(name, 0.0), tops[name] + signed.get(name, 0.0))
        for name, array in arrays.items()
    }
    return {**{name: np.asarray(shares, np.uint8) for name, shares in found.items()}, "tops": tops}


def _dot(tet_mesh: TetMesh, steps: Sequence[Step], dot_shape: DotShape) -> View:
    """The dot at its first place, and how far each step moves it."""
    places = np.stack([step.dot_position_m for step in steps]) * MM_PER_M
    points = _outward(triangle_corners(placed_dot(dot_shape, tet_mesh, places[0])))
    shift = (places - places[0]).tolist()
    return {"dotPoints": np.asarray(points, np.float32), "dotShift": shift, "dotColour": rgb(PART_COLOURS["dot"])}


def parts_view(solids: Mapping[str, Any], dot_shape: DotShape) -> View:
    """As press_view, of the parts at rest before anything is meshed: one step, no tetrahedra, no fields.

    solids : build123d solids of the layers and the case by their labels.
    """
    surfaces = [triangulated(solid, TESSELLATION_CHORD_MM, TESSELLATION_ANGLE_RAD) for solid in solids.values()]
    low, high = _lowest_and_highest(surfaces)
    half = 0.5 * (high - low)
    dot = [
        in_segment_frame(dot_shape, part.points_mm, dot_shape.origin_mm)[part.triangles].reshape(-1, 3)
        for part in dot_parts(dot_shape, (float(half[0]), float(half[1])))
    ]
    first = np.cumsum([0, *(len(points) for points, _ in surfaces[:-1])])
    points = np.concatenate([points for points, _ in surfaces])
    return {
        "steps": [{"indentation": 0.0, "force": 0.0}],
        **_parts(list(solids)),
        "slice": False,
        "plane": float(dot_shape.origin_mm[1]),
        "points": np.asarray(points, np.float32),
        "region": np.repeat(np.arange(len(surfaces), dtype=np.uint8), [len(points) for points, _ in surfaces]),
        "triangles": np.concatenate(
            [np.asarray(triangles + offset, np.uint32) for (_, triangles), offset in zip(surfaces, first, strict=True)]
        ),
        "tets": np.empty((0, 4), np.uint32),
        **displacement_steps(np.zeros((1, *points.shape))),
        "tops": {},
        "dotPoints": np.asarray(_outward(np.concatenate(dot)), np.float32),
        "dotShift": [[0.0, 0.0, 0.0]],
        "dotColour": rgb(PART_COLOURS["dot"]),
    }


def _parts(names: Sequence[str]) -> View:
    colours: dict[str, NDArray[Any]] = colour_map_bytes()
    return {"names": list(names), "colours": [rgb(PART_COLOURS[name]) for name in names], **colours}


def _outward(corners: Floats) -> Floats:
    """Corners (3 k, 3) of a closed surface, turned where they face inwards: the frame of the dot is mirrored."""
    a, b, c = corners.reshape(-1, 3, 3).transpose(1, 0, 2)
    volume = np.einsum("ij,ij->", a, np.cross(b, c))
    return corners if volume > 0 else corners.reshape(-1, 3, 3)[:, ::-1].reshape(-1, 3)


def _lowest_and_highest(surfaces: Iterable[tuple[Floats, Ints]]) -> tuple[Floats, Floats]:
    """Lowest and highest corner (3,) of all surfaces."""
    points = np.concatenate([found for found, _ in surfaces])
    return points.min(axis=0), points.max(axis=0)
