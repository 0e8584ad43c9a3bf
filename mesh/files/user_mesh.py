"""A user's own mesh of the segment: read, checked against the configuration, and made into the mesh of the solver."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from foundation.errors import InputError
from foundation.files import regular_file_size
from geometry.parameters import Segment
from geometry.stack import layers
from mesh.files.abaqus import AbaqusMesh, is_tet, is_triangle, read_abaqus
from mesh.files.formats import REGION_NUMBERS, SURFACE_NUMBERS
from mesh.jacobian import jacobians, volumes
from mesh.outline import StackOutline, curved_surface, stack_outline
from mesh.quadratic import PLANE_TOLERANCE_MM, named_facets, quadratic_nodes_and_tets
from mesh.slice import node_twins
from mesh.types import TET_FACES, LinearMesh, MeshingError, TetMesh, face_neighbours, signed_volumes, unique_edges

FLAT_PART_TOLERANCE, ROUND_PART_TOLERANCE = 1e-4, 0.05
"""Relative error allowed of the volume of a part with plane faces, and of volume and size of a round effector."""
AXIS_NAMES = "xyz"


def refuse_inverted_elements(points: Floats, tets: Ints, where: str) -> None:
    """Raise InputError where an element, of four nodes or ten, has no positive volume at a sample point."""
    if tets.shape[1] == 4:
        bad = signed_volumes(points, tets) <= 0
    else:
        bad = (np.linalg.det(jacobians(points[tets])) <= 0).any(axis=1)
    if bad.any():
        raise InputError(
            f"{where}: {bad.sum()} of {len(tets)} elements are inverted or flat; every element must have a positive "
            "volume in the order of its nodes"
        )


def refuse_other_outline(
    points: Floats, tets: Ints, region: Ints, names: tuple[str, ...], stack: StackOutline, where: str
) -> None:
    """Raise InputError where a part is not where the configured segment has it, or not of its volume.

    points (n, 3) in mm, tets (m, 10), region (m,) index into names.
    """
    exact, found = stack.volumes(), np.bincount(region, volumes(points[tets]), len(names))
    for number, name in enumerate(names):
        corners = points[np.unique(tets[region == number, :4])]
        is_round = name == "effector" and curved_surface(stack) is not None
        for axis, (low, high) in enumerate(_part_box(name, stack)):
            allowed = ROUND_PART_TOLERANCE * (high - low) if is_round else PLANE_TOLERANCE_MM
            is_low, is_high = corners[:, axis].min(), corners[:, axis].max()
            if not (
                -PLANE_TOLERANCE_MM <= is_low - low <= allowed and -PLANE_TOLERANCE_MM <= high - is_high <= allowed
            ):
                raise InputError(
                    f"{where}: {name} reaches from {is_low:.6g} to {is_high:.6g} mm in {AXIS_NAMES[axis]}, it must as "
                    f"in the configuration reach from {low:.6g} to {high:.6g} mm"
                )
        if abs(found[number] / exact[name] - 1.0) > (ROUND_PART_TOLERANCE if is_round else FLAT_PART_TOLERANCE):
            raise InputError(
                f"{where}: {name} has a volume of {found[number]:.6g} mm³, it must as in the configuration have "
                f"{exact[name]:.6g} mm³"
            )
    _refuse_beyond_skin(points, tets, stack, where)


def _part_box(name: str, stack: StackOutline) -> list[tuple[float, float]]:
    """Lowest and highest x, y and z of a part, in mm."""
    heights = {
        "medium2": (0.0, stack.film_bottom),
        "film": (stack.film_bottom, stack.film_top),
        "medium1": (stack.film_top, stack.medium1_top),
        "effector": (stack.medium1_top, stack.top),
    }
    x, y = (stack.effector_half_x, stack.effector_half_y) if name == "effector" else (stack.half_x, stack.half_y)
    return [(-x, x), (-y, y), heights[name]]


def _refuse_beyond_skin(points: Floats, tets: Ints, stack: StackOutline, where: str) -> None:
    """Refuse a round effector that bulges.

    Its corners may lie inside the round skin, as those of flat facets do.
    """
    surface = curved_surface(stack)
    if surface is None:
        return
    corners = points[np.unique(tets[:, :4])]
    beyond = surface.distance(corners[corners[:, 2] > stack.medium1_top + PLANE_TOLERANCE_MM])
    if len(beyond) and beyond.max() > PLANE_TOLERANCE_MM:
        raise InputError(
            f"{where}: a node of effector lies {beyond.max():.3g} mm outside the round skin of the configuration; "
            "it must lie on it or inside"
        )


def refuse_open_interfaces(
    points: Floats, tets: Ints, region: Ints, names: tuple[str, ...], stack: StackOutline, where: str
) -> None:
    """Raise InputError where elements do not share nodes: an outer face is neither base, side, cut nor skin.

    MeshingError where more than two elements share a face.
    """
    owner, face = np.nonzero(face_neighbours(tets[:, :4]) < 0)
    corner = points[tets[owner[:, None], TET_FACES[face, :3]]]
    z = corner[..., 2]
    ends = np.array([stack.half_x, stack.half_y])
    on_sides = np.zeros(len(corner), dtype=bool)
    for plane in (-ends, ends):  # a slice has corners on both of its faces alone: one plane at a time
        on_sides |= (np.abs(corner[..., :2] - plane) < PLANE_TOLERANCE_MM).all(axis=1).any(axis=1)
    is_skin = z.min(axis=1) > stack.medium1_top - PLANE_TOLERANCE_MM
    if "effector" in names:
        is_skin &= (region[owner] != names.index("effector")) | (z.max(axis=1) > stack.medium1_top + PLANE_TOLERANCE_MM)
    inside = ~(on_sides | is_skin | (np.abs(z) < PLANE_TOLERANCE_MM).all(axis=1))
    if inside.any():
        first = np.flatnonzero(inside)[0]
        raise InputError(
            f"{where}: {inside.sum()} faces inside the segment, such as one of {names[region[owner[first]]]} at "
            f"z = {z[first].mean():.6g} mm, belong to one element only; neighbouring parts must share the nodes of "
            "their interface"
        )


def refuse_unshared_middles(tets: Ints, where: str) -> None:
    """Raise InputError unless each edge of elements (m, 10) has one mid-side node that no other edge has."""
    edges, number = unique_edges(tets[:, :4])
    pairs = np.unique(np.column_stack([number.ravel(), tets[:, 4:].ravel()]), axis=0)
    torn = len(pairs) - len(edges)
    if torn:
        raise InputError(
            f"{where}: {torn} mid-side nodes are not shared by the elements of their edge; elements that meet must "
            "share all nodes of the face or edge between them, those in the middle of edges too"
        )
    if len(np.unique(pairs[:, 1])) < len(pairs) or np.isin(pairs[:, 1], tets[:, :4]).any():
        raise InputError(f"{where}: a mid-side node belongs to several edges, or is a corner; each edge needs its own")


def refuse_other_slice(points: Floats, tets: Ints, stack: StackOutline, where: str) -> None:
    """Raise InputError unless a slice is one layer of elements with the same x and z on both of its faces."""
    corners = points[np.unique(tets[:, :4])]
    low, high = (np.abs(corners[:, 1] - y) < PLANE_TOLERANCE_MM for y in (-stack.half_y, stack.half_y))
    one, other = (np.unique(np.round(corners[on][:, [0, 2]] / PLANE_TOLERANCE_MM), axis=0) for on in (low, high))
    if not (low | high).all() or not np.array_equal(one, other):
        raise InputError(
            f"{where}: segment.section = 'plane-strain' needs one layer of elements in y, centred at y = 0, with "
            "corners of the same x and z on both of its faces"
        )


MESHIO_READERS = {".msh": "gmsh", ".xdmf": "xdmf"}
TET_CELLS, TRIANGLE_CELLS = ("tetra", "tetra10"), ("triangle", "triangle6")
NAMED_FILES_PATTERN = re.compile(
    rb"([^\s<>\"']+\.h5):|^\s*\*[^*\r\n][^\r\n]*\binput\s*=\s*([^\r\n,]+)", re.IGNORECASE | re.MULTILINE
)


@dataclass(frozen=True)
class FileMesh:
    """The tetrahedra, regions and surfaces in a file.

    points_mm (n, 3); tets (m, 4) or (m, 10) in VTK's order; regions : name -> (m,) whether it has a tetrahedron.
    surfaces : name -> (k, 3) corners of triangles, of either orientation. Names are in lower case.
    """

    points_mm: Floats
    tets: Ints
    regions: dict[str, Bools]
    surfaces: dict[str, Ints]


def message_name(file: str) -> str:
    """Name of the mesh file in messages."""
    return f"mesh.file = '{file}'"


def file_contents(file: str) -> bytes:
    """All bytes of a mesh file and of the files that it names, and so on; missing files have none."""
    found: dict[Path, bytes] = {}
    waiting = [Path(file)]
    for path in waiting:
        if path in found or "\0" in str(path) or not path.is_file():
            continue
        found[path] = path.read_bytes()
        if path.suffix.lower() not in (".msh", ".h5"):
            names = (
                (match[1] or match[2]).decode("utf-8", "replace") for match in NAMED_FILES_PATTERN.finditer(found[path])
            )
            waiting += [path.parent / name.strip().strip('"') for name in names]
    return b"".join(found.values())


def read_file(file: str) -> FileMesh:
    """Read a mesh of tetrahedra. InputError, naming mesh.file, for a missing file, no mesh, or other elements."""
    path, where = Path(file), message_name(file)
    kind = MESHIO_READERS.get(path.suffix.lower())
    if kind is None and path.suffix.lower() != ".inp":
        raise InputError(f"{where}: must end with .msh (Gmsh), .inp (Abaqus, CalculiX) or .xdmf")
    regular_file_size(path, where)
    return (
        _file_mesh_from_abaqus(read_abaqus(path, where), where)
        if kind is None
        else _file_mesh_by_meshio(path, kind, where)
    )


def _file_mesh_by_meshio(path: Path, kind: str, where: str) -> FileMesh:
    import meshio

    try:
        found = getattr(meshio, kind).read(path)
    except Exception as error:  # meshio raises what a wrong file happens to lead to
        said = " ".join(str(error).split()) or type(error).__name__
        if "gmsh:physical" in said:
            said = "it holds elements of no physical group; save only those of physical groups"
        raise InputError(f"{where}: meshio cannot read it as a mesh of this format ({said})") from None
    return _file_mesh_from_meshio(found, where)


def _file_mesh_from_abaqus(found: AbaqusMesh, where: str) -> FileMesh:
    """Tetrahedra, sets that hold any of them as regions, and facets of sets named as a surface. InputError."""
    number = [place for place, (kind, _) in enumerate(found.cells) if is_tet(kind)]
    nodes = {len(found.cells[place][1]) for place in number}
    if len(nodes) != 1:
        held = "tetrahedra with 4 nodes and with 10" if nodes else "no solid elements"
        raise InputError(f"{where}: holds {held}; all must be tetrahedra with 4 nodes, or all with 10")
    masks = {name: np.isin(number, cells) for name, cells in found.sets.items() if name not in SURFACE_NUMBERS}
    facets = {
        name: np.array([found.cells[cell][1][:3] for cell in cells if is_triangle(found.cells[cell][0])])
        for name, cells in found.sets.items()
        if name in SURFACE_NUMBERS
    }
    tets = np.array([found.cells[place][1] for place in number], dtype=np.int64)
    return FileMesh(
        found.points_mm,
        tets,
        {name: mask for name, mask in masks.items() if mask.any()},
        {name: corners.astype(np.int64) for name, corners in facets.items() if len(corners)},
    )


def _file_mesh_from_meshio(found: Any, where: str) -> FileMesh:
    """Tetrahedra of all blocks, regions and surfaces. InputError for other solid elements and for a mixture."""
    kinds = {block.type for block in found.cells if block.dim == 3}
    if not kinds or not kinds <= set(TET_CELLS) or len(kinds) > 1:
        names = ", ".join(sorted(kinds)) or "no solid elements"
        raise InputError(f"{where}: holds {names}; all must be tetrahedra with 4 nodes, or all with 10")
    sets = _cell_sets(found)
    tets = np.concatenate([block.data for block in found.cells if block.type in TET_CELLS]).astype(np.int64)
    if found.points.ndim != 2 or found.points.shape[1] != 3 or tets.min() < 0 or tets.max() >= len(found.points):
        raise InputError(f"{where}: an element has a node without three coordinates")
    regions = {name: _tet_mask(found, blocks) for name, blocks in sets.items() if name not in SURFACE_NUMBERS}
    surfaces = {name: _triangle_corners(found, blocks) for name, blocks in sets.items() if name in SURFACE_NUMBERS}
    return FileMesh(
        np.asarray(found.points, dtype=np.float64),
        tets,
        {name: mask for name, mask in regions.items() if mask.any()},
        {name: corners for name, corners in surfaces.items() if len(corners)},
    )


def _cell_sets(found: Any) -> dict[str, list[Ints]]:
    """Name -> its cells in each block, from sets, physical groups, or the region numbers that softdot writes."""
    count = len(found.cells)
    sets = {}
    for name, parts in found.cell_sets.items():
        if not name.startswith("gmsh:") and len(parts) == count:
            sets[name.lower()] = [np.asarray(part, dtype=np.int64) for part in parts]
    marks = found.cell_data.get("gmsh:physical", found.cell_data.get("region"))
    for name, number, dimension in _physical_groups(found) if marks is not None else ():
        numbers = (mark if block.dim == dimension else [] for block, mark in zip(found.cells, marks, strict=True))
        sets.setdefault(name.lower(), [np.flatnonzero(np.asarray(one) == number) for one in numbers])
    return sets


def _physical_groups(found: Any) -> Iterator[tuple[str, int, int]]:
    """Name, number and dimension of each physical group; those of softdot for a file without any names."""
    if found.field_data:
        for name, (number, dimension) in found.field_data.items():
            yield name, int(number), int(dimension)
    elif not found.cell_sets:
        for name, number in REGION_NUMBERS.items():
            yield name, number, 3


def _tet_mask(found: Any, parts: list[Ints]) -> Bools:
    """Whether each of all tetrahedra (m,) is in a set."""
    masks = []
    for block, part in zip(found.cells, parts, strict=True):
        if block.type in TET_CELLS:
            masks.append(np.isin(np.arange(len(block.data)), part))
    return np.concatenate(masks)


def _triangle_corners(found: Any, parts: list[Ints]) -> Ints:
    """Corners (k, 3) of the triangles in a set."""
    chosen = [np.zeros((0, 3), dtype=np.int64)]
    for block, part in zip(found.cells, parts, strict=True):
        if block.type in TRIANGLE_CELLS:
            chosen.append(block.data[part, :3].astype(np.int64))
    return np.concatenate(chosen)


def user_mesh(file: str, segment: Segment) -> TetMesh:
    """The mesh in a file, .msh, .inp or .xdmf in mm, as that of the segment; its base is centred at the origin.

    Mid-side nodes that the file has stay where they are; those of four-node tetrahedra are put on round skins. Named
    surfaces are found by their place; of contact, base and sides the file may name a part, which then counts alone.
    InputError with one sentence, naming mesh.file, for what cannot be read or is no mesh of this segment.
    """
    return _checked_mesh(file, sha256(file_contents(file)).hexdigest(), segment)


@lru_cache(maxsize=2)
def _checked_mesh(file: str, _content: str, segment: Segment) -> TetMesh:
    """The mesh of the segment, read and checked once for each content of the file."""
    where, read = message_name(file), read_file(file)
    if not np.isfinite(read.points_mm[read.tets]).all():
        raise InputError(f"{where}: an element has a node without three finite coordinates")
    names = tuple(layer.name for layer in layers(segment))
    region = _tet_regions(read, names, where)
    points, tets, number = _corners_first(read)
    thickness_mm = float(np.ptp(points[:, 1]))
    stack = stack_outline(segment, slice_mm=thickness_mm)
    if tets.shape[1] == 4:
        refuse_inverted_elements(points, tets, where)
        points, tets = quadratic_nodes_and_tets(LinearMesh(points, tets, region, names), curved_surface(stack))
    refuse_unshared_middles(tets, where)
    refuse_inverted_elements(points, tets, where)
    if stack.is_slice:
        refuse_other_slice(points, tets, stack, where)
    refuse_other_outline(points, tets, region, names, stack, where)
    twin = node_twins(points) if stack.is_slice else np.arange(len(points), dtype=np.int64)
    try:
        refuse_open_interfaces(points, tets, region, names, stack, where)
        facets = named_facets(points, tets, region, names, stack)
    except MeshingError:
        raise InputError(f"{where}: more than two tetrahedra share a face; they must not overlap") from None
    for name, corners in read.surfaces.items():
        if not name.startswith("film-"):
            facets[name] = _named_facets(facets.get(name), number[corners], f"{where}: surface '{name}'")
    size_mm = thickness_mm if stack.is_slice else segment.width_mm
    return TetMesh(points, tets, region, names, facets, twin, size_mm)


def _tet_regions(read: FileMesh, names: tuple[str, ...], where: str) -> Ints:
    """Index into names of each tetrahedron (m,). InputError unless each is of one part that the segment has."""
    foreign = sorted(set(read.regions) & (set(REGION_NUMBERS) - set(names)))
    missing = [name for name in names if name not in read.regions]
    if missing or foreign:
        wrong = f"has no {missing[0]}" if missing else f"has {foreign[0]}, which the segment has not"
        known = ", ".join(sorted(read.regions)) or "none"
        raise InputError(f"{where}: {wrong}; its parts must be {', '.join(names)}, it names {known}")
    masks = np.array([read.regions[name] for name in names])
    wrong_count = int((masks.sum(axis=0) != 1).sum())
    if wrong_count:
        raise InputError(
            f"{where}: {wrong_count} of {len(read.tets)} tetrahedra are not in exactly one of the parts "
            f"{', '.join(names)}"
        )
    return np.asarray(np.argmax(masks, axis=0), dtype=np.int64)


def _corners_first(read: FileMesh) -> tuple[Floats, Ints, Ints]:
    """Points and tetrahedra with corners before mid-side nodes, and the new number of each old node.

    The number is -1 for a node that no tetrahedron has.
    """
    corners = np.unique(read.tets[:, :4])
    order = np.concatenate([corners, np.setdiff1d(read.tets, corners)])
    number = np.full(len(read.points_mm), -1, dtype=np.int64)
    number[order] = np.arange(len(order))
    return read.points_mm[order], number[read.tets], number


def _named_facets(derived: Ints | None, corners: Ints, what: str) -> Ints:
    """Facets (j, 6), of those found by place (k, 6), that a file names by their corners (j, 3).

    InputError for triangles that are not among them.
    """
    there = np.zeros((0, 6), dtype=np.int64) if derived is None else derived
    named = {tuple(nodes) for nodes in np.sort(corners, axis=1).tolist()}
    chosen = np.array([tuple(nodes) in named for nodes in np.sort(there[:, :3], axis=1).tolist()], dtype=bool)
    if chosen.sum() != len(named):
        raise InputError(
            f"{what}: {len(named) - chosen.sum()} of its {len(named)} triangles are not faces of elements where the "
            "segment has this surface; name fewer, or leave the surface out, and it is found by its place"
        )
    return np.asarray(there[chosen])
