"""Which interfaces of the mesh open: those with a compliant bond, and delaminated patches of the others."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Bools, Ints
from mesh.interfaces import interface_facets, split_interface
from mesh.types import TetMesh
from solve.delaminations import delaminated_facets
from solve.physics import BondLine, Delamination

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
            bare |= delaminated_facets(tet_mesh, patch, plane_strain)
        joined = np.zeros_like(bare) if name in bonds else ~bare
        tet_mesh, lower, upper = split_interface(tet_mesh, name, joined)
        opened.append(OpenInterface(name, lower, upper, bare))
    return tet_mesh, tuple(opened)
