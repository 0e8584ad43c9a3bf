"""From a model and a mesh to what the march needs: the system and the recorder of its history."""

from dataclasses import dataclass

from geometry.dot_shape import DotShape
from mesh.types import TetMesh
from solve.electrodes import refuse_unresolved, scale_of_section
from solve.interfaces import OpenInterface
from solve.model import Model
from solve.problem import build_system
from solve.recorder import Recorder
from solve.schedule import Target, schedule
from solve.system import System, Units


@dataclass(frozen=True)
class Setup:
    """A discretised press."""

    model: Model
    system: System
    recorder: Recorder

    @property
    def full_drive(self) -> float:
        """Depth or force at the end of the press, solver units."""
        press, segment = self.model.press, self.model.segment
        if press.force_N is not None:
            return press.force_N / scale_of_section(segment, self.recorder.tet_mesh)[0] / self.system.units.force
        return 1e-3 * press.depth_mm / self.system.units.length

    def targets(self, follows_time: bool) -> list[Target]:
        """What is to be reached, and when (see solve.schedule)."""
        return schedule(self.model.press, self.full_drive, self.system.units.length, follows_time)


def set_up(
    model: Model,
    dot: DotShape,
    tet_mesh: TetMesh,
    opened: tuple[OpenInterface, ...],
    units: Units | None = None,
) -> Setup:
    """Discretise a model on a mesh whose interfaces are open already; units : of another system, to share them."""
    driven = model.press.force_N is not None
    system = build_system(
        model.segment, model.materials, dot, tet_mesh, driven, model.physics, model.readout, opened, units
    )
    refuse_unresolved(model.segment, system.film.area())
    return Setup(model, system, Recorder(system, tet_mesh, model.physics, model.segment, model.materials))
