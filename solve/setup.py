"""From a model and a mesh to what the march needs: the system and the recorder of its history."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from mesh.symmetry import mirrored_mesh
from mesh.types import Planes, TetMesh
from solve.delaminations import with_rims_of_patches
from solve.model import Model
from solve.open_interfaces import OpenInterface, open_interfaces
from solve.problem import build_system, refuse_unresolved_electrodes
from solve.recorder import Recorder
from solve.solution.schedule import Target, schedule
from solve.symmetry import planes_of
from solve.system import System
from solve.whole_segment import meshed_share


@dataclass(frozen=True)
class Setup:
    """A discretised press. tet_mesh : what is meshed of it, its interfaces open; unfolded : axes about which the mesh
    that was given has been mirrored.
    """

    model: Model
    tet_mesh: TetMesh
    unfolded: Planes
    opened: tuple[OpenInterface, ...]
    system: System
    recorder: Recorder

    @property
    def full_drive(self) -> float:
        """Depth or force at the end of the press in solver units, a force as the meshed share of the whole."""
        press, segment = self.model.press, self.model.segment
        if press.force_N is not None:
            return press.force_N * meshed_share(segment, self.tet_mesh) / self.system.units.force
        return 1e-3 * press.depth_mm / self.system.units.length

    def targets(self, follows_time: bool) -> list[Target]:
        """Loads to reach and their times, the first at rest (see solve.solution.schedule)."""
        return schedule(self.model.press, self.full_drive, self.system.units.length, follows_time)


def discretise(model: Model, tet_mesh: TetMesh, dot: DotShape, others: Iterable[Model] = ()) -> Setup:
    """Discretise a press. A mesh of a half or a quarter is unfolded about every plane that the press does not have.

    others : models that are to share this mesh, with dots of their own. InputError for a patch outside its interface.
    """
    kept = set(planes_of(model, dot))
    for other in others:
        kept &= set(planes_of(other, resolve_dot(other.dot, other.segment)))
    lost = tuple(axis for axis in tet_mesh.planes if axis not in kept)
    physics, plane_strain = model.physics, model.segment.section == "plane-strain"
    whole = with_rims_of_patches(mirrored_mesh(tet_mesh, lost).tet_mesh, model.segment, physics.delaminations)
    opened = open_interfaces(whole, physics.bonds, physics.delaminations, plane_strain)
    return replace(set_up(model, dot, *opened), unfolded=lost)


def set_up(
    model: Model,
    dot: DotShape,
    tet_mesh: TetMesh,
    opened: tuple[OpenInterface, ...],
    like: System | None = None,
) -> Setup:
    """Discretise a press on a mesh whose interfaces are open already; like : as of solve.problem.build_system.

    ValueError for a mesh that ends at a plane which the press does not have.
    """
    if not set(tet_mesh.planes) <= set(planes_of(model, dot)):
        raise ValueError("the press is not symmetric about a plane at which its mesh ends")
    driven = model.press.force_N is not None
    system = build_system(
        model.segment, model.materials, dot, tet_mesh, driven, model.physics, model.amplifier, opened, like,
        model.separate_channels,
    )  # fmt: skip
    refuse_unresolved_electrodes(model.segment, tet_mesh, system.film)
    recorder = Recorder(system, tet_mesh, model.physics, model.segment, model.materials)
    return Setup(model, tet_mesh, (), opened, system, recorder)
