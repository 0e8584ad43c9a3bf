"""Mesh files as other programs may write them."""

from pathlib import Path

import meshio
import numpy as np

from mesh.types import TetMesh


def written(points: np.ndarray, tets: np.ndarray, region: np.ndarray, names: tuple[str, ...], path: Path) -> str:
    """An .inp file as another mesher may write it: element sets for the parts and no surfaces."""
    kind = {4: "tetra", 10: "tetra10"}[tets.shape[1]]
    sets = {name: [np.flatnonzero(region == number)] for number, name in enumerate(names)}
    meshio.abaqus.write(path, meshio.Mesh(points, [(kind, tets)], cell_sets=sets))
    return str(path)


def linear(of: TetMesh, path: Path, names: tuple[str, ...] | None = None) -> str:
    return written(of.points_mm, of.tets[:, :4], of.region, names or of.region_names, path)


def gmsh_22(of: TetMesh, surfaces: dict[str, np.ndarray], path: Path) -> str:
    """The older format 2.2, whose groups meshio gives as numbers and names."""
    cells = [("tetra10", of.tets), *(("triangle6", facets) for facets in surfaces.values())]
    tags = [of.region + 1, *(np.full(len(facets), 50 + i) for i, facets in enumerate(surfaces.values()))]
    names = {name: np.array([i + 1, 3]) for i, name in enumerate(of.region_names)}
    names |= {name: np.array([50 + i, 2]) for i, name in enumerate(surfaces)}
    whole = meshio.Mesh(of.points_mm, cells, cell_data={"gmsh:physical": tags}, field_data=names)
    meshio.gmsh.write(path, whole, "2.2", binary=False)
    return str(path)
