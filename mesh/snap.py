"""Put the nodes of interfaces and outer faces onto their exact planes and curved surfaces."""

import numpy as np

from mesh.outline import Outline
from mesh.surfaces import curved_surface
from mesh.topology import TET_FACES, face_neighbours
from mesh.types import Floats, Ints

EFFECTOR = 2  # its region in a stack without film


def snapped(points: Floats, tets: Ints, region: Ints, stack: Outline) -> Floats:
    """Points (n, 3) with those of facets between different regions (or outside) moved onto their surfaces.

    Each such facet belongs to the surface it lies nearest to; a node gets the surfaces of all its facets.
    """
    neighbour = face_neighbours(tets)
    other = np.where(neighbour >= 0, region[neighbour], -1)
    owner, face = np.nonzero(other != region[:, None])
    facets = tets[owner[:, None], TET_FACES[face, :3]]
    planes, curved = _planes(stack), curved_surface(stack)
    off = np.array([np.abs(points[facets, axis] - value).max(axis=1) for axis, value in planes])
    if curved is not None:
        # The skin of a round effector is its curved surface, its lid or a slice's cut, never a side.
        skin = (region[owner] == EFFECTOR) & (other[owner, face] < 0)
        own = [(axis, value) == (2, stack.top) or (axis == 1 and stack.is_slice) for axis, value in planes]
        off[np.ix_(~np.array(own), skin)] = np.inf
        away = np.abs(curved.distance(points[facets].reshape(-1, 3))).reshape(-1, 3).max(axis=1)
        off = np.vstack([off, np.where(skin, away, np.inf)])
    nearest = np.argmin(off, axis=0)
    result = points.copy()
    if curved is not None:
        on_curved = np.unique(facets[nearest == len(planes)])
        result[on_curved] = curved.project(result[on_curved])
    for number, (axis, value) in enumerate(planes):
        result[np.unique(facets[nearest == number]), axis] = value
    if curved is not None:
        result[on_curved] = curved.project(result[on_curved])  # the rim, now in the plane of the foot
    return result


def _planes(stack: Outline) -> list[tuple[int, float]]:
    """Axis and position of every plane of the stack."""
    planes = [(0, -stack.half_x), (0, stack.half_x), (1, -stack.half_y), (1, stack.half_y)]
    planes += [(2, 0.0), (2, stack.film_bottom), (2, stack.medium1_top)]
    if stack.shape in ("layer", "block", "cylinder"):
        planes.append((2, stack.top))
    if stack.shape == "block" or (stack.shape == "cylinder" and stack.is_slice):
        planes += [(0, -stack.effector_half_x), (0, stack.effector_half_x)]
    if stack.shape == "block":
        planes += [(1, -stack.effector_half_y), (1, stack.effector_half_y)]
    return planes
