"""Press the dot into the segment and, where a path is given, slide it.

From a model and a mesh to what the march needs: the system and the recorder of its history.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import pairwise

from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from mesh.symmetry import unfolded
from mesh.types import Planes, TetMesh
from solve.delaminations import with_rims_of_patches
from solve.model import Model
from solve.open_interfaces import OpenInterface, open_interfaces
from solve.problem import build_system, refuse_unresolved
from solve.readout.course import course
from solve.recorder import Recorder
from solve.result import PressResult, Step
from solve.solution.advice import explained
from solve.solution.checkpoint import Checkpoint
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolver
from solve.solution.march import march, rest_state
from solve.solution.schedule import Target, schedule
from solve.symmetry import planes_of
from solve.system import System
from solve.units import Units
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
        """Depth or force at the end of the press, solver units."""
        press, segment = self.model.press, self.model.segment
        if press.force_N is not None:
            return press.force_N * meshed_share(segment, self.tet_mesh) / self.system.units.force
        return 1e-3 * press.depth_mm / self.system.units.length

    def targets(self, follows_time: bool) -> list[Target]:
        """What is to be reached, and when (see solve.solution.schedule)."""
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
    whole = with_rims_of_patches(unfolded(tet_mesh, lost).tet_mesh, model.segment, physics.delaminations)
    opened = open_interfaces(whole, physics.bonds, physics.delaminations, plane_strain)
    return replace(set_up(model, dot, *opened), unfolded=lost)


def set_up(
    model: Model,
    dot: DotShape,
    tet_mesh: TetMesh,
    opened: tuple[OpenInterface, ...],
    units: Units | None = None,
) -> Setup:
    """On a mesh whose interfaces are open already; units : of another system, to share them.

    ValueError for a mesh that ends at a plane which the press does not have.
    """
    if not set(tet_mesh.planes) <= set(planes_of(model, dot)):
        raise ValueError("the press is not symmetric about a plane at which its mesh ends")
    driven = model.press.force_N is not None
    system = build_system(
        model.segment, model.materials, dot, tet_mesh, driven, model.physics, model.amplifier, opened, units
    )
    refuse_unresolved(model.segment, tet_mesh, system.film)
    recorder = Recorder(system, tet_mesh, model.physics, model.segment, model.materials)
    return Setup(model, tet_mesh, (), opened, system, recorder)


OnStep = Callable[[Step, int, int], None]


def press_segment(
    model: Model,
    tet_mesh: TetMesh,
    on_step: OnStep | None = None,
    checkpoint: Checkpoint | None = None,
    dot: DotShape | None = None,
    accuracy_percent: float | None = None,
) -> PressResult:
    """Solve the press of a model on a mesh of its segment. on_step(step, number, count) follows the progress.

    The read-out matters only where the film's voltage acts back on it (coupling = "two-way").
    checkpoint : where a long press leaves its state, and goes on from one that was killed.
    dot : at rest, where it is not the one that the model's table describes.
    accuracy_percent : load steps are doubled until the read-out between them is so accurate; None: as stated.
    Want of convergence raises nothing: the result then holds what converged and says where and why it ended.
    InputError for a delaminated patch outside its interface.
    """
    result = _pressed(model, tet_mesh, on_step, checkpoint, dot or resolve_dot(model.dot, model.segment))
    for _ in range(MOST_DOUBLINGS):
        press = model.press.model_copy(update={"load_steps": 2 * model.press.load_steps})
        if accuracy_percent is None or not result.converged or press.load_steps > MOST_STEPS:
            break
        if course(result, model.press, model.amplifier, model.physics).readout_error_percent <= accuracy_percent:
            break
        model = replace(model, press=press)
        result = _pressed(model, tet_mesh, on_step, None, dot or resolve_dot(model.dot, model.segment))
    return result


MOST_DOUBLINGS, MOST_STEPS = 4, 1000


def _pressed(
    model: Model, tet_mesh: TetMesh, on_step: OnStep | None, checkpoint: Checkpoint | None, dot: DotShape
) -> PressResult:
    setup = discretise(model, tet_mesh, dot)
    linear = LinearSolver(setup.system.factorisation_shift)
    failure = _follow(setup, linear, on_step, checkpoint)
    linear.close()
    if checkpoint is not None:
        checkpoint.discard()
    return setup.recorder.result(failure, linear.name, model.press, model.follows_time)


def _follow(setup: Setup, linear: LinearSolver, on_step: OnStep | None, checkpoint: Checkpoint | None) -> str | None:
    """March along the schedule; returns why it stopped short, or None."""
    system, recorder, targets = setup.system, setup.recorder, setup.targets(setup.model.follows_time)
    past = [] if checkpoint is None else checkpoint.load(recorder, system.count)
    if not past:
        try:
            past = [rest_state(system, linear, targets[0])]
        except NoEquilibriumError as error:
            flat = system.at_rest(targets[0].load)
            recorder.start(flat)
            reason = explained(system, error, flat, targets[0].load)
            return f"step 0 of {len(targets) - 1}, the prestretched film at rest, has no equilibrium: {reason}"
        recorder.start(past[0])
    count, done = len(targets) - 1, len(recorder.steps)
    for number, (before, target) in list(enumerate(pairwise(targets), start=1))[done - 1 :]:
        failure = march(system, linear, past, target, before.kink, recorder.record, may_snap=True)
        if past[-1].time > before.time:
            recorder.report()
            if on_step is not None:
                on_step(recorder.steps[-1], number, count)
        if failure is not None:
            reached = recorder.steps[-1]
            depth = f"{1e3 * reached.indentation_m:.3f} mm and {reached.reaction_force_N + 0.0:.3g} N"
            return f"step {number} of {count} stopped at {depth}, {failure}"
        if checkpoint is not None and checkpoint.save(past, recorder):
            linear.close()  # it is not in the file: a press that goes on from there goes the same way
    return None
