"""The numbering of the unknowns: displacements, pressures, voltages, contact pressures and the approach of the dot."""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from mesh.symmetry import in_plane
from mesh.types import TetMesh


class Numbers:
    """Hands out the numbers of unknowns, one after the other."""

    def __init__(self) -> None:
        self.count = 0

    def take(self, how_many: int) -> Ints:
        """The next numbers (how_many,)."""
        self.count += how_many
        return np.arange(self.count - how_many, self.count)


@dataclass(frozen=True)
class Unknowns:
    """Global numbers; -1 stands for a value that is prescribed.

    displacement : (n, 3) one row a node, twins share theirs.
    pressure : (m, 4) of the corners of each tetrahedron, continuous inside a region only; -1 in film and foam.
    voltage : (e,) one per electrode, the same for electrodes in parallel, -1 where it does not act back on the film.
    contact : (n,) contact pressure at the nodes of the contact facets, else -1.
    approach : number of the dot's approach, or -1 when it is prescribed.
    """

    displacement: Ints
    pressure: Ints
    voltage: Ints
    contact: Ints
    approach: int


def fixed_nodes(tet_mesh: TetMesh, held_regions: tuple[str, ...], freed: tuple[str, ...] = ()) -> Ints:
    """Nodes whose displacement is zero: the base and the sides of the regions that the case holds.

    freed : names of those surfaces that something else holds.
    """
    names = [name for name in ("base", *(f"side-{name}" for name in held_regions)) if name not in freed]
    facets = [tet_mesh.facets[name].ravel() for name in names if name in tet_mesh.facets]
    return np.unique(np.concatenate([np.zeros(0, np.int64), *facets]))


def number(
    tet_mesh: TetMesh,
    places: Floats,
    numbers: Numbers,
    held_regions: tuple[str, ...],
    plane_strain: bool,
    without_pressure: tuple[str, ...],
    electrodes: Ints,
    two_way: bool,
    parallel: bool,
    approach: bool,
    freed: tuple[str, ...] = (),
) -> Unknowns:
    """Number the unknowns of a problem.

    places : nodes (n, 3) by whose order unknowns are numbered; of a mesh that was moved those before, as nodes that
    pass each other would exchange their numbers. electrodes : (e,) numbers from 0, equal for electrodes of equal
    voltage; two_way : voltages act back, of electrodes in parallel or each alone. freed : surfaces that are not held
    still.
    """
    twin = tet_mesh.twin
    free = _free_displacements(tet_mesh, fixed_nodes(tet_mesh, held_regions, freed), plane_strain)
    displacement = np.full(free.shape, -1)
    displacement[free] = numbers.take(int(free.sum()))
    pressure, corners = _pressure_numbers(tet_mesh, numbers, without_pressure)
    contact = np.full(len(free), -1)
    touching = np.unique(twin[tet_mesh.facets["contact"]])
    contact[touching] = numbers.take(len(touching))

    nodes = np.concatenate([np.nonzero(free)[0], corners, touching])
    new = np.append(along_x(places[nodes]), -1)  # -1 stays -1
    voltage = np.full(len(electrodes), -1)
    if two_way:
        voltage[:] = numbers.take(1) if parallel else numbers.take(int(electrodes.max()) + 1)[electrodes]
    dot = int(numbers.take(1)[0]) if approach else -1
    return Unknowns(new[displacement][twin], new[pressure], voltage, new[contact][twin], dot)


def _free_displacements(tet_mesh: TetMesh, fixed: Ints, plane_strain: bool) -> Bools:
    """Whether each displacement (n, 3) is an unknown; of twins only the first is."""
    free = np.zeros((len(tet_mesh.points_mm), 3), bool)
    free[tet_mesh.twin[tet_mesh.tets]] = True
    free[tet_mesh.twin[fixed]] = False
    if plane_strain:
        free[:, 1] = False
    for axis in tet_mesh.planes:
        free[in_plane(tet_mesh.points_mm, axis), axis] = False
    return free


def _pressure_numbers(tet_mesh: TetMesh, numbers: Numbers, without_pressure: tuple[str, ...]) -> tuple[Ints, Ints]:
    """Numbers (m, 4) of the pressures at the corners of the tetrahedra, -1 for none, and the node of each number."""
    pressure, nodes = np.full((len(tet_mesh.tets), 4), -1), [np.zeros(0, np.int64)]
    for region, name in enumerate(tet_mesh.region_names):
        if name in without_pressure:
            continue
        inside = tet_mesh.region == region
        corners, local = np.unique(tet_mesh.twin[tet_mesh.tets[inside, :4]], return_inverse=True)
        pressure[inside] = numbers.take(len(corners))[local.reshape(-1, 4)]
        nodes.append(corners)
    return pressure, np.concatenate(nodes)


def along_x(points: Floats) -> Ints:
    """New number of each unknown (count,) from its node's place (count, 3): by x, then y, then z.

    Nested dissection starts from the given numbers. Unknowns that lie together had up to a quarter less to factorise
    when they were numbered together, on a cube of 280 000; on a segment it makes no difference.
    """
    new = np.empty(len(points), np.int64)
    new[np.lexsort(points.T[::-1])] = np.arange(len(points))
    return new
