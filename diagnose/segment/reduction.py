"""The baseline's table with what its layers remember, kept on disk by the reduced model itself."""

from dataclasses import dataclass

import numpy as np

from diagnose.vocabulary.memory import LARGEST_SHARE
from geometry.dot import resolve_dot
from mesh.types import Floats, TetMesh
from solve.model import Model
from solve.reduced.build import build_reduced
from solve.reduced.model import ReducedModel

DEPTH_NODES = 8


@dataclass(frozen=True)
class Reduction:
    """A model at its first touch and with elastic physics only, on a mesh to depth_mm, with layers that relax."""

    model: Model
    tet_mesh: TetMesh
    depth_mm: float
    relaxing: tuple[str, ...]

    def made(self) -> ReducedModel:
        """Pressed, or recalled. NoEquilibriumError."""
        return build_reduced(
            self.model.segment, self.model.materials, resolve_dot(self.model.dot, self.model.segment), self.tet_mesh,
            self.depth_mm, dict.fromkeys(self.relaxing, LARGEST_SHARE), self.model.physics, DEPTH_NODES, check=False,
        )  # fmt: skip

    def run(self) -> Floats:
        """Make it, so that it can be recalled elsewhere."""
        self.made()
        return np.zeros(0)
