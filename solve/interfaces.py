"""Which interfaces of the mesh open: those with a compliant bond, and delaminated patches of the others.

Where a bond is delaminated: the facets of an interface within a disc, or within a strip of a slice.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Bools, Floats, Ints
from geometry.base import InputError
from mesh.interfaces import inner_nodes, interface_facets, split_interface
from mesh.types import TetMesh
from solve.model import BondLine, Delamination

ROUND_OFF_MM = 1e-9


def delaminated_facets(
    tet_mesh: TetMesh, name: str, center_mm: tuple[float, float], diameter_mm: float, plane_strain: bool
) -> Bools:
    """Facets (k,) of interface_facets whose middle lies in the disc (plane strain: |x - x_c| <= diameter / 2).

    A diameter of 0 selects none. InputError when the disc reaches outside the interface, or is so small that the
    mesh has no node inside which could open.
    """
    facets = interface_facets(tet_mesh, name)
    if diameter_mm == 0.0:
        return np.zeros(len(facets), bool)
    given = f"mechanisms.delamination at {name}: center_mm = {list(center_mm)}, diameter_mm = {diameter_mm:g}"
    corners = tet_mesh.points_mm[facets[:, :3], :2]
    axes = slice(0, 1) if plane_strain else slice(0, 2)
    center = np.array(center_mm)
    _refuse_outside(corners[..., axes].reshape(-1, center[axes].size), center[axes], diameter_mm, given)
    # the two triangles of a slice's rectangle share their middle in x, not their centroid
    middle = (corners.min(axis=1) + corners.max(axis=1)) / 2 if plane_strain else corners.mean(axis=1)
    inside = np.linalg.norm((middle - center)[:, axes], axis=1) <= diameter_mm / 2 + ROUND_OFF_MM
    if not len(inner_nodes(tet_mesh, facets, ~inside)):
        raise InputError(f"{given}: must span several facets, which are too large there (mesh.element_size_mm)")
    return np.asarray(inside)


def _refuse_outside(corners: Floats, center: Floats, diameter: float, given: str) -> None:
    """InputError when the disc leaves the box around the interface's corners (k, d)."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    reach = diameter / 2 - ROUND_OFF_MM
    if diameter < 0.0 or (center - reach < low).any() or (center + reach > high).any():
        box = ", ".join(f"{axis} from {a:g} to {b:g} mm" for axis, a, b in zip("xy", low, high, strict=False))
        raise InputError(f"{given}: the patch must lie within the interface, {box}, and its diameter be 0 or more")


BONDS = (  # from the base up: the part below an interface keeps its nodes, so that earlier facets stay right
    "bond-base",
    "bond-film-medium2",
    "bond-medium1-film",
    "bond-effector-medium1",
)


@dataclass(frozen=True)
class OpenInterface:
    """Matched facets (k, 6) below and above an interface, and which of them are delaminated (k,)."""

    name: str
    lower: Ints
    upper: Ints
    delaminated: Bools


def open_interfaces(
    tet_mesh: TetMesh, bonds: Mapping[str, BondLine], delaminations: tuple[Delamination, ...], plane_strain: bool
) -> tuple[TetMesh, tuple[OpenInterface, ...]]:
    """The mesh with its nodes doubled there. InputError for a patch outside its interface or a missing layer."""
    opened = []
    for name in BONDS:
        patches = [patch for patch in delaminations if patch.bond == name]
        if name not in bonds and not patches:
            continue
        bare = np.zeros(len(interface_facets(tet_mesh, name)), bool)
        for patch in patches:
            bare |= delaminated_facets(tet_mesh, name, patch.center_mm, patch.diameter_mm, plane_strain)
        joined = np.zeros_like(bare) if name in bonds else ~bare
        tet_mesh, lower, upper = split_interface(tet_mesh, name, joined)
        opened.append(OpenInterface(name, lower, upper, bare))
    return tet_mesh, tuple(opened)
