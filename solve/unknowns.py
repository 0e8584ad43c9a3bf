"""Numbering of the unknowns: displacements, pressures, electrode voltages, contact pressures, dot position."""

from dataclasses import dataclass

import numpy as np

from mesh.types import Ints, TetMesh


@dataclass(frozen=True)
class Unknowns:
    """Global numbers; -1 stands for a value that is prescribed.

    displacement : (n, 3) one row a node, twins share theirs.
    pressure : (m, 4) of the corners of each tetrahedron, continuous inside a region only; -1 in the film.
    voltage : (e,) one per electrode, -1 where the voltage does not act back on the film.
    contact : (n,) contact pressure at the nodes of the contact facets, else -1.
    approach : number of the dot's approach, or -1 when it is prescribed.
    """

    displacement: Ints
    pressure: Ints
    voltage: Ints
    contact: Ints
    approach: int
    count: int


def fixed_nodes(tet_mesh: TetMesh, held_regions: tuple[str, ...]) -> Ints:
    """Nodes whose displacement is zero: the base and the sides of the regions that the case holds."""
    names = ["base", *(f"side-{name}" for name in held_regions)]
    facets = [tet_mesh.facets[name].ravel() for name in names if name in tet_mesh.facets]
    return np.unique(np.concatenate(facets))


def number(
    tet_mesh: TetMesh,
    held_regions: tuple[str, ...],
    plane_strain: bool,
    electrodes: int,
    two_way: bool,
    force_driven: bool,
) -> Unknowns:
    """Number all unknowns of a problem."""
    nodes, twin = len(tet_mesh.points_mm), tet_mesh.twin
    free = np.zeros((nodes, 3), bool)
    free[twin[tet_mesh.tets]] = True
    free[twin[fixed_nodes(tet_mesh, held_regions)]] = False
    if plane_strain:
        free[:, 1] = False
    displacement = np.full((nodes, 3), -1)
    displacement[free] = np.arange(free.sum())
    displacement = displacement[twin]
    count = int(free.sum())

    pressure = np.full((len(tet_mesh.tets), 4), -1)
    for region in range(len(tet_mesh.region_names)):
        if tet_mesh.region_names[region] == "film":
            continue
        inside = tet_mesh.region == region
        corners, local = np.unique(twin[tet_mesh.tets[inside, :4]], return_inverse=True)
        pressure[inside] = count + local.reshape(-1, 4)
        count += len(corners)

    voltage = np.full(electrodes, -1)
    if two_way:
        voltage = count + np.arange(electrodes)
        count += electrodes
    contact = np.full(nodes, -1)
    touching = np.unique(twin[tet_mesh.facets["contact"]])
    contact[touching] = count + np.arange(len(touching))
    contact = contact[twin]
    count += len(touching)
    approach = count if force_driven else -1
    return Unknowns(displacement, pressure, voltage, contact, approach, count + int(force_driven))
