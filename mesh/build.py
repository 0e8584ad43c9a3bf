"""The front door of the mesher. It imports late because the command line imports it early."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geometry.dot import DotShape
    from geometry.parameters import Segment
    from mesh.parameters import MeshOptions
    from mesh.types import LinearMesh, TetMesh


def build(segment: Segment, dot: DotShape, options: MeshOptions) -> TetMesh:
    """Mesh a segment, film included, as curved ten-node tetrahedra with named facets.

    dot : where and how round the dot is, which is where the mesh is fine.
    Raises InputError when the mesher cannot mesh the shape, MeshingError when it fails or takes too long.
    """
    from mesh.quadratic import finished

    return finished(_linear(segment, dot, options), segment, options)


def _linear(segment: Segment, dot: DotShape, options: MeshOptions) -> LinearMesh:
    """Choose the mesher; what pytetwild makes is remembered."""
    from mesh import cache
    from mesh.layered import layered, layered_slice, tetwild_slice
    from mesh.tetwild import tetwild

    is_slice = segment.section == "plane-strain"
    if options.mesher == "layered":
        return (layered_slice if is_slice else layered)(segment, dot, options)
    make = tetwild_slice if is_slice else tetwild
    return cache.remembered(cache.key(segment, dot, options), lambda: make(segment, dot, options))
