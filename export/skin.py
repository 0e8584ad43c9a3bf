"""Surfaces of the segment as small triangles that carry every shown step: outer skin, section and film.
Units are those that results are shown in: millimetres, megapascals and picocoulombs per square millimetre.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from export.nodal_values import SplitNodes, film_values, largest_principal, nodal_means, split_nodes
from export.subdivision import tetra_pattern, triangle_pattern
from foundation.arrays import Floats, Ints
from mesh.types import TET_FACES, TetMesh
from solve.result import Step

MM_PER_M = 1e3
MPA_PER_PA = 1e-6
PC_PER_MM2_PER_C_PER_M2 = 1e6
"""1 C/m^2 = 1e12 pC / 1e6 mm^2."""


@dataclass(frozen=True)
class Skin:
    """Triangles with their undeformed corners and the fields of each step (s steps).

    points_mm : (v, 3); triangles : (t, 3); region : (v,) part of each corner (each belongs to one only).
    displacement_mm : (s, v, 3); the others (s, v), zero outside the film or where the dot does not press.
    """

    points_mm: Floats
    triangles: Ints
    region: Ints
    displacement_mm: Floats
    von_mises_MPa: Floats
    film_strain: Floats
    charge_pC_per_mm2: Floats
    contact_pressure_MPa: Floats


@dataclass(frozen=True)
class NodalSteps:
    """Fields at the split nodes: displacement_mm (s, n, 3), the others (s, n)."""

    split: SplitNodes
    points_mm: Floats
    displacement_mm: Floats
    von_mises_MPa: Floats
    film_strain: Floats
    charge_pC_per_mm2: Floats
    contact_pressure_MPa: Floats

    @property
    def fields(self) -> tuple[Floats, ...]:
        """Fields in the order in which a Skin has them."""
        return (
            self.displacement_mm,
            self.von_mises_MPa,
            self.film_strain,
            self.charge_pC_per_mm2,
            self.contact_pressure_MPa,
        )


def nodal_steps(tet_mesh: TetMesh, steps: Sequence[Step]) -> NodalSteps:
    """Fields of the given steps that the skins show, at nodes that belong to one part each."""
    split, every = split_nodes(tet_mesh), [step.fields for step in steps]
    strain = [film_values(tet_mesh, f.film_tets, largest_principal(f.film_strain)) for f in every]
    charge = [film_values(tet_mesh, f.film_tets, f.charge_density_C_per_m2) for f in every]
    pressure = np.zeros((len(every), len(tet_mesh.points_mm)))
    for of_step, f in zip(pressure, every, strict=True):
        of_step[f.contact_nodes] = f.contact_pressure_Pa
    return NodalSteps(
        split,
        tet_mesh.points_mm[split.node],
        np.stack([f.displacement_m[split.node] for f in every]) * MM_PER_M,
        np.stack([nodal_means(split, f.von_mises_Pa) for f in every]) * MPA_PER_PA,
        np.stack([nodal_means(split, values) for values in strain]),
        np.stack([nodal_means(split, values) for values in charge]) * PC_PER_MM2_PER_C_PER_M2,
        pressure[:, split.node] * MPA_PER_PA,
    )


def outer_skin(nodes: NodalSteps, level: int = 1) -> Skin:
    """The skin of every part that is open to the outside, each quadratic face cut into 4^level triangles."""
    return _skin_of_facets(nodes, outer_facets(nodes.split), level)


def outer_facets(split: SplitNodes) -> Ints:
    """Quadratic facets (k, 6) in split nodes that belong to one tetrahedron only."""
    corners = np.sort(split.node[split.tets[:, TET_FACES[:, :3]]].reshape(-1, 3), axis=1)
    # three numbers in one, which sort many times faster than rows
    keys = np.ravel_multi_index(tuple(corners.T), (int(split.node.max()) + 1,) * 3)
    _, first, count = np.unique(keys, return_index=True, return_counts=True)
    return np.asarray(split.tets[:, TET_FACES].reshape(-1, 6)[first[count == 1]])


def film_top(nodes: NodalSteps, tet_mesh: TetMesh, level: int = 1) -> Skin:
    """The upper face of the film, each quadratic face cut into 4^level triangles."""
    film = tet_mesh.region_names.index("film")
    place = np.full(len(tet_mesh.points_mm), -1)
    own = np.flatnonzero(nodes.split.region == film)
    place[nodes.split.node[own]] = own
    return _skin_of_facets(nodes, place[tet_mesh.facets["film-top"]], level)


def cut_section(nodes: NodalSteps, y_mm: float, level: int = 1) -> Skin:
    """The cut through all parts along the undeformed plane y = y_mm, as a surface that faces -y."""
    import pyvista

    y = nodes.points_mm[nodes.split.tets, 1]
    crossed = nodes.split.tets[(y.min(axis=1) < y_mm) & (y.max(axis=1) > y_mm)]
    weights, small = tetra_pattern(level)
    cells = (np.arange(len(crossed))[:, None, None] * len(weights) + small).reshape(-1, 4)
    points, *fields = (_interpolate(weights, array, crossed) for array in _points_and_fields(nodes))
    grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: cells}, points)
    for number, values in enumerate(fields):
        grid.point_data[f"f{number}"] = values
    grid.cell_data["region"] = np.repeat(nodes.split.region[crossed[:, 0]], len(small))
    cut = grid.slice(normal="y", origin=(0.0, y_mm, 0.0)).triangulate()
    triangles = cut.regular_faces.astype(np.int64)
    return _turn_to_front(_skin_of_cut(nodes, triangles, np.asarray(cut.cell_data["region"]), cut))


def nearby_plane(tet_mesh: TetMesh, y_mm: float) -> float:
    """A y in mm just behind y_mm and inside the segment: a cut exactly through mesh faces would find no cells."""
    low, high = tet_mesh.points_mm[:, 1].min(), tet_mesh.points_mm[:, 1].max()
    inset = 1e-4 * (high - low)
    return float(np.clip(y_mm + inset, low + inset, high - inset))


def _points_and_fields(nodes: NodalSteps) -> list[Floats]:
    """Points first, then the fields of each step."""
    return [nodes.points_mm, *(field[s] for s in range(len(nodes.displacement_mm)) for field in nodes.fields)]


def _interpolate(weights: Floats, values: Floats, cells: Ints) -> Floats:
    """Values (n,) or (n, 3) at the pattern's points of every cell, stacked cell by cell."""
    result = np.einsum("pk,ck...->cp...", weights, values[cells])
    return np.asarray(result.reshape(-1, *values.shape[1:]))


def _skin_of_facets(nodes: NodalSteps, facets: Ints, level: int) -> Skin:
    """The skin of quadratic triangles (k, 6) in split nodes, subdivided; equal corners of one part are shared."""
    weights, small = triangle_pattern(level)
    triangles = (np.arange(len(facets))[:, None, None] * len(weights) + small).reshape(-1, 3)
    points, *fields = (_interpolate(weights, array, facets) for array in _points_and_fields(nodes))
    region = np.repeat(nodes.split.region[facets[:, 0]], len(weights))
    return _merge_corners(points, triangles, region, fields, len(nodes.fields))


def _skin_of_cut(nodes: NodalSteps, triangles: Ints, region: Ints, cut: "object") -> Skin:
    """The skin of a cut whose corners are given to one part each (parts meet at equal corners)."""
    points = np.asarray(cut.points, np.float64)[triangles].reshape(-1, 3)  # type: ignore[attr-defined]
    count = len(nodes.fields) * len(nodes.displacement_mm)
    fields = [np.asarray(cut.point_data[f"f{k}"])[triangles.ravel()] for k in range(count)]  # type: ignore[attr-defined]
    return _merge_corners(
        points, np.arange(len(points)).reshape(-1, 3), np.repeat(region, 3), fields, len(nodes.fields)
    )


def _merge_corners(points: Floats, triangles: Ints, region: Ints, fields: Sequence[Floats], each: int) -> Skin:
    """The skin with corners of equal place (to 0.1 um) and part merged, without triangles that vanish by it.

    each : number of fields of a step.
    """
    keys = np.column_stack([np.round(points * 1e4).astype(np.int64), region])
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    triangles = inverse.ravel()[triangles]
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    fields = [values[first] for values in fields]
    return Skin(points[first], triangles, region[first], *(np.stack(fields[k::each]) for k in range(each)))


def _turn_to_front(skin: Skin) -> Skin:
    """The skin with triangles turned so that their normals point to -y."""
    a, b, c = (skin.points_mm[skin.triangles[:, i]] for i in range(3))
    turned = np.cross(b - a, c - a)[:, 1] > 0
    return replace(skin, triangles=np.where(turned[:, None], skin.triangles[:, ::-1], skin.triangles))
