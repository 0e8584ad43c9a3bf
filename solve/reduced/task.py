"""What is reduced: one segment on its mesh, and how deep and with which physics it is pressed."""

from collections.abc import Mapping
from dataclasses import dataclass

from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.types import TetMesh
from solve.materials.parameters import Material
from solve.physics import Physics


@dataclass(frozen=True)
class ReductionTask:
    """What is reduced: a segment on its mesh, the dot, the deepest press, what may relax, and the other physics."""

    segment: Segment
    materials: Mapping[str, Material]
    dot: DotShape
    tet_mesh: TetMesh
    depth_mm: float
    relaxing: Mapping[str, float]
    physics: Physics
    depth_nodes: int
