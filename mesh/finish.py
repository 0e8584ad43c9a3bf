"""From four-node tetrahedra to the mesh that the solver takes."""

import numpy as np

from geometry.parameters import Segment
from mesh.facets import named_facets
from mesh.linear import LinearMesh
from mesh.outline import outline
from mesh.parameters import MeshOptions
from mesh.quadratic import quadratic
from mesh.quality import refuse_inverted
from mesh.slice import twins
from mesh.surfaces import curved_surface
from mesh.types import TetMesh


def finished(linear: LinearMesh, segment: Segment, options: MeshOptions) -> TetMesh:
    """Add mid-side nodes, facets and twins. Raises MeshingError when an element is inverted."""
    is_slice = segment.section == "plane-strain"
    thickness_mm = options.contact_element_size_mm if is_slice else segment.width_mm
    stack = outline(segment, slice_mm=thickness_mm)
    points, tets = quadratic(linear, curved_surface(stack))
    twin = twins(points) if is_slice else np.arange(len(points), dtype=np.int64)
    facets = named_facets(points, tets, linear.region, linear.region_names, stack)
    result = TetMesh(points, tets, linear.region, linear.region_names, facets, twin, thickness_mm)
    refuse_inverted(result)
    return result
