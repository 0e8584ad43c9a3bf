"""A user's own mesh of the segment in place of the mesher's: checked against the configuration, then made complete."""

from functools import lru_cache
from hashlib import sha256

import numpy as np

from geometry.arrays import Floats, Ints
from geometry.base import InputError
from geometry.parameters import Segment
from geometry.stack import layers
from mesh.formats import REGIONS
from mesh.layered import twins
from mesh.outline import curved_surface, outline
from mesh.own_checks import refuse_inverted_elements, refuse_open_interfaces, refuse_other_outline, refuse_other_slice
from mesh.own_file import FileMesh, contents, read_file, told
from mesh.quadratic import named_facets, quadratic
from mesh.types import LinearMesh, MeshingError, TetMesh


def own_mesh(file: str, segment: Segment) -> TetMesh:
    """The mesh in a file, .msh, .inp or .xdmf in mm, as that of the segment; its base is centred at the origin.

    Mid-side nodes that the file has stay where they are; those of four-node tetrahedra are put on round skins. Named
    surfaces are found by their place; of contact, base and sides the file may name a part, which then counts alone.
    InputError with one sentence, naming mesh.file, for what cannot be read or is no mesh of this segment.
    """
    return _own_mesh(file, sha256(contents(file)).hexdigest(), segment)


@lru_cache(maxsize=2)
def _own_mesh(file: str, _content: str, segment: Segment) -> TetMesh:
    """Read and checked once for each content of the file."""
    where, read = told(file), read_file(file)
    names = tuple(layer.name for layer in layers(segment))
    region = _regions(read, names, where)
    points, tets, number = _corners_first(read)
    thickness_mm = float(np.ptp(points[:, 1]))
    stack = outline(segment, slice_mm=thickness_mm)
    if tets.shape[1] == 4:
        refuse_inverted_elements(points, tets, where)
        points, tets = quadratic(LinearMesh(points, tets, region, names), curved_surface(stack))
    refuse_inverted_elements(points, tets, where)
    if stack.is_slice:
        refuse_other_slice(points, tets, stack, where)
    refuse_other_outline(points, tets, region, names, stack, where)
    twin = twins(points) if stack.is_slice else np.arange(len(points), dtype=np.int64)
    try:
        refuse_open_interfaces(points, tets, region, names, stack, where)
        facets = named_facets(points, tets, region, names, stack)
    except MeshingError:
        raise InputError(f"{where}: more than two tetrahedra share a face; they must not overlap") from None
    for name, corners in read.surfaces.items():
        if not name.startswith("film-"):
            facets[name] = _named_part(facets.get(name), number[corners], f"{where}: surface '{name}'")
    size_mm = thickness_mm if stack.is_slice else segment.width_mm
    return TetMesh(points, tets, region, names, facets, twin, size_mm)


def _regions(read: FileMesh, names: tuple[str, ...], where: str) -> Ints:
    """Index into names of each tetrahedron (m,). InputError unless each is of one part that the segment has."""
    foreign = sorted(set(read.regions) & (set(REGIONS) - set(names)))
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
    """Points and tetrahedra with the corners before the mid-side nodes, and the new number of each old node (or -1)."""
    corners = np.unique(read.tets[:, :4])
    order = np.concatenate([corners, np.setdiff1d(read.tets, corners)])
    number = np.full(len(read.points_mm), -1, dtype=np.int64)
    number[order] = np.arange(len(order))
    return read.points_mm[order], number[read.tets], number


def _named_part(derived: Ints | None, corners: Ints, what: str) -> Ints:
    """Those of the facets found by place (k, 6) that the file names by their corners (j, 3). InputError for others."""
    there = np.zeros((0, 6), dtype=np.int64) if derived is None else derived
    named = {tuple(nodes) for nodes in np.sort(corners, axis=1).tolist()}
    chosen = np.array([tuple(nodes) in named for nodes in np.sort(there[:, :3], axis=1).tolist()], dtype=bool)
    if chosen.sum() != len(named):
        raise InputError(
            f"{what}: {len(named) - chosen.sum()} of its {len(named)} triangles are not faces of elements where the "
            "segment has this surface; name fewer, or leave the surface out, and it is found by its place"
        )
    return np.asarray(there[chosen])
