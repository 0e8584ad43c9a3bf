"""The baseline's table with what its layers remember, kept on disk by the reduced model itself."""

from dataclasses import dataclass

from geometry.dot_at_rest import resolve_dot
from mesh.types import TetMesh
from solve.model import Model
from solve.reduced.build import keep_model, recall_or_build
from solve.reduced.model import ReducedModel
from solve.reduced.task import ReductionTask

DEPTH_NODES = 8


@dataclass(frozen=True)
class Reduction:
    """A model at its first touch and with elastic physics only, on a mesh to depth_mm, with layers that relax.

    largest_share : sum of the relative moduli up to which each of them may relax.
    """

    model: Model
    tet_mesh: TetMesh
    depth_mm: float
    relaxing: tuple[str, ...]
    largest_share: float

    def build_model(self) -> ReducedModel:
        """Press the model, or recall it from the disk. NoEquilibriumError."""
        return recall_or_build(self._task, check=False)

    def keep(self, made: ReducedModel) -> None:
        """Keep on this disk a model that was made elsewhere."""
        keep_model(self._task, False, made)

    @property
    def _task(self) -> ReductionTask:
        model = self.model
        return ReductionTask(
            model.segment, model.materials, resolve_dot(model.dot, model.segment), self.tet_mesh, self.depth_mm,
            dict.fromkeys(self.relaxing, self.largest_share), model.physics, DEPTH_NODES,
        )  # fmt: skip
