"""Where a bond is delaminated: the facets of an interface within a disc, or within a strip of a slice."""

import numpy as np

from foundation.arrays import Bools, Floats
from foundation.errors import InputError
from geometry.parameters import Segment
from mesh.interfaces import inner_nodes, interface_facets
from mesh.outline import stack_outline
from mesh.seams import mesh_with_columns_at
from mesh.types import TetMesh
from solve.physics import Delamination

ROUND_OFF_MM = 1e-9


def delaminated_facets(tet_mesh: TetMesh, patch: Delamination, plane_strain: bool) -> Bools:
    """Facets (k,) of interface_facets whose middle lies in the disc (plane strain: |x - x_c| <= diameter / 2) or its
    image where the mesh ends at a mirror plane; of a patch outside the disc all others.

    A diameter of 0 selects none. InputError when the disc reaches outside the interface, or is so small, or so large
    where the rim is loose, that the mesh has no node which could open.
    """
    name, diameter_mm = patch.bond, patch.diameter_mm
    facets = interface_facets(tet_mesh, name)
    if diameter_mm == 0.0:
        return np.full(len(facets), patch.outside)
    what = "bonded_diameter_mm" if patch.outside else "diameter_mm"
    given = f"mechanisms.delamination at {name}: center_mm = {list(patch.center_mm)}, {what} = {diameter_mm:g}"
    corners = tet_mesh.points_mm[facets[:, :3], :2]
    axes = slice(0, 1) if plane_strain else slice(0, 2)
    center, mirrored = np.array(patch.center_mm), list(tet_mesh.planes)
    center[mirrored] = np.abs(center[mirrored])  # of what reaches over the plane the image covers as much and more
    high, low = corners.max(axis=(0, 1)), corners.min(axis=(0, 1))
    low[mirrored] = -high[mirrored]
    if not patch.outside:
        _refuse_outside(low[axes], high[axes], center[axes], diameter_mm, given)
    # the two triangles of a slice's rectangle share their middle in x, not their centroid
    middle = (corners.min(axis=1) + corners.max(axis=1)) / 2 if plane_strain else corners.mean(axis=1)
    inside = np.linalg.norm((middle - center)[:, axes], axis=1) <= diameter_mm / 2 + ROUND_OFF_MM
    loose: Bools = inside != patch.outside
    if not len(inner_nodes(tet_mesh, facets, ~loose)):
        raise InputError(f"{given}: what is loose must span several facets, too large there (mesh.element_size_mm)")
    return loose


def _refuse_outside(low: Floats, high: Floats, center: Floats, diameter: float, given: str) -> None:
    """InputError when the disc leaves the box around the interface, from low (d,) to high (d,)."""
    reach = diameter / 2 - ROUND_OFF_MM
    if diameter < 0.0 or (center - reach < low).any() or (center + reach > high).any():
        box = ", ".join(f"{axis} from {a:g} to {b:g} mm" for axis, a, b in zip("xy", low, high, strict=False))
        raise InputError(f"{given}: the patch must lie within the interface, {box}, and its diameter be 0 or more")


def with_rims_of_patches(tet_mesh: TetMesh, segment: Segment, delaminations: tuple[Delamination, ...]) -> TetMesh:
    """The mesh, of a slice with corners where its delaminated patches begin and end; of a solid as it was.

    Facets are loose or bonded as a whole. Where the patch ended at the nearest of them, what it does would go up in
    steps of whole elements as it grows. InputError for a missing layer.
    """
    if segment.section == "solid":
        return tet_mesh
    foot = stack_outline(segment).effector_half_x
    kept = [-foot, foot]
    for patch in delaminations:
        rims = [patch.center_mm[0] + side * patch.diameter_mm / 2 for side in (-1, 1)]
        tet_mesh = mesh_with_columns_at(tet_mesh, interface_facets(tet_mesh, patch.bond), rims, kept)
        kept += rims
    return tet_mesh
