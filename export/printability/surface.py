"""The triangulated surface of a part."""

from typing import Any

import numpy as np

DEFLECTION_MM = 0.005
"""Largest distance of a facet from the true surface: a tenth of the thinnest layer."""
ANGULAR_DEFLECTION = 0.15
"""Largest angle between neighbouring facets, in radians."""


def surface_of(body: Any) -> Any:
    """A trimesh.Trimesh, in mm, of a build123d shape; a Trimesh is taken as it is, with merged vertices."""
    import trimesh

    if isinstance(body, trimesh.Trimesh):
        merged = body.copy()
        merged.merge_vertices()
        return merged
    points, triangles = body.tessellate(DEFLECTION_MM, ANGULAR_DEFLECTION)
    surface = trimesh.Trimesh(np.array([tuple(p) for p in points]), np.array(triangles), process=True)
    surface.update_faces(surface.nondegenerate_faces(height=1e-9))
    return surface
