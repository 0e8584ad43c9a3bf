"""Nodal values of the film, recovered from those of its elements by superconvergent patch recovery.

Around each corner node a linear polynomial is fitted to the values at the centroids of the elements there, and its
value at the node is taken (Zienkiewicz and Zhu, Int. J. Numer. Meth. Eng. 33, 1992, 1331-1364). Means over the elements
around a node would do inside the film. At its rim they would not: elements that have an edge there and those that have
only a corner there lie at different distances from it, and their mean follows the elements instead of the field.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from export.subdivision import TETRA_EDGES
from foundation.arrays import Bools, Floats, Ints
from mesh.types import TetMesh
from solve.film_means import film_columns

SMALLEST_EIGENVALUE_RATIO = 1e-8  # relative eigenvalue below which a patch says nothing of that direction
SAME_PLACE_MM = 1e-7  # mm


@dataclass(frozen=True)
class FilmPatches:
    """The elements around each place of the film, through whose thickness all is constant.

    matrix : (p, e) what a place takes of each of the e tetrahedra; node : (n,) mesh nodes; place : (n, 2) the places
    that the node lies midway between, equal for corners.
    """

    matrix: sp.csr_matrix
    node: Ints
    place: Ints

    def at_nodes(self, values: Floats, count: int) -> Floats:
        """Values (e,) or (e, c) of the film's tetrahedra at all count nodes of the mesh; zero off the film.

        Never beyond the extremes of the elements: what files and pictures show does not exceed what is stated.
        """
        at_places = np.clip(self.matrix @ values, values.min(axis=0), values.max(axis=0))
        result = np.zeros((count, *values.shape[1:]))
        result[self.node] = at_places[self.place].mean(axis=1)
        return result


def film_patches(tet_mesh: TetMesh) -> FilmPatches:
    """The patches of a mesh's film; a slice has them along x only, since nothing varies across."""
    axes = 1 if bool(np.any(tet_mesh.twin != np.arange(len(tet_mesh.twin)))) else 2
    tets = tet_mesh.tets[tet_mesh.region_tets("film")]
    points = tet_mesh.points_mm[tets[:, :4], :axes]
    grid = np.round(points / SAME_PLACE_MM).astype(np.int64).reshape(-1, axes)
    _, first, place_of = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    where, place_of = points.reshape(-1, axes)[first], place_of.reshape(-1, 4)
    columns = film_columns(tet_mesh)
    share = columns.volume / np.bincount(columns.column, columns.volume)[columns.column]
    gather = sp.csr_matrix((share, (columns.column, np.arange(len(tets)))))
    touch = sp.csr_matrix(
        (np.ones(place_of.size), (place_of.ravel(), np.repeat(columns.column, 4))), (len(where), gather.shape[0])
    )
    weight = np.bincount(columns.column, columns.volume).astype(np.float64)
    patches = _columns_of_places(touch, _on_rim(where))
    fit = _fit_weights(patches, where, gather @ points.mean(axis=1), weight)
    node, place = _places_of_nodes(tets, place_of)
    return FilmPatches(sp.csr_matrix(fit @ gather), node, place)


def _on_rim(where: Floats) -> Bools:
    """Whether places (p, axes) lie on the outline of the rectangular film."""
    return np.asarray(
        ((where < where.min(axis=0) + SAME_PLACE_MM) | (where > where.max(axis=0) - SAME_PLACE_MM)).any(axis=1)
    )


def _columns_of_places(touch: sp.csr_matrix, rim: Bools) -> sp.coo_matrix:
    """Pairs of place and column: the columns that touch a place; at the rim those too that touch one of these."""
    wider = sp.diags_array(rim.astype(float)) @ touch @ (touch.T @ touch)
    return sp.coo_matrix(touch + wider)


def _fit_weights(patches: sp.coo_matrix, where: Floats, centre: Floats, weight: Floats) -> sp.csr_matrix:
    """Weights (p, c) with which values of the c columns add up to those at p places, by weighted least squares.

    where : (p, axes), centre : (c, axes), weight : (c,). Where a patch does not tell a slope there is none.
    """
    place, column = patches.coords
    basis = np.column_stack([np.ones(len(place)), centre[column] - where[place]])
    reach = np.sqrt(np.bincount(place, (basis[:, 1:] ** 2).sum(axis=1)) / np.bincount(place))
    basis[:, 1:] /= reach[place, None]
    weighted = weight[column, None] * basis
    normal = np.zeros((len(where), basis.shape[1], basis.shape[1]))
    np.add.at(normal, place, weighted[:, :, None] * basis[:, None, :])
    first = np.linalg.pinv(normal, rcond=SMALLEST_EIGENVALUE_RATIO, hermitian=True)[:, 0]
    return sp.csr_matrix(((first[place] * weighted).sum(axis=1), (place, column)), (len(where), len(centre)))


def _places_of_nodes(tets: Ints, place_of: Ints) -> tuple[Ints, Ints]:
    """Nodes (n,) of the tetrahedra (e, 10), and the two places of each (n, 2)."""
    ends = np.concatenate([np.repeat(np.arange(4)[:, None], 2, axis=1), TETRA_EDGES])
    node, first = np.unique(tets, return_index=True)
    tet, local = np.divmod(first, 10)
    return node, place_of[tet[:, None], ends[local]]
