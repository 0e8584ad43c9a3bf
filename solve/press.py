"""Press the dot into the segment and, where a path is given, slide it."""

from collections.abc import Callable, Mapping
from itertools import pairwise

from geometry.dot_shape import DotShape
from geometry.parameters import Segment
from mesh.types import TetMesh
from solve.electrodes import scale_of_section
from solve.interfaces import open_interfaces
from solve.linear import LinearSolver
from solve.march import march, rest_state
from solve.materials.parameters import Material
from solve.newton import NoEquilibriumError
from solve.parameters import Press, Readout
from solve.physics import Physics
from solve.problem import build_system
from solve.recorder import Recorder
from solve.result import PressResult, Step
from solve.schedule import schedule
from solve.system import System

DEFAULT_INDENTATION_MM = 0.3

OnStep = Callable[[Step, int, int], None]


def press_segment(
    segment: Segment,
    materials: Mapping[str, Material],
    dot: DotShape,
    press: Press,
    tet_mesh: TetMesh,
    on_step: OnStep | None = None,
    physics: Physics | None = None,
    readout: Readout | None = None,
) -> PressResult:
    """Solve a press; materials : region name -> material. on_step(step, number, count) follows the progress.

    readout matters only where the film's voltage acts back on it (coupling = "two-way").
    Want of convergence raises nothing: the result then holds what converged and says where and why it ended.
    InputError for a delaminated patch outside its interface.
    """
    physics = physics or Physics()
    plane_strain = segment.section == "plane-strain"
    opened_mesh, opened = open_interfaces(tet_mesh, physics.bonds, physics.delaminations, plane_strain)
    driven = press.force_N is not None
    system = build_system(segment, materials, dot, opened_mesh, driven, physics, readout, opened)
    linear = LinearSolver(system.factorisation_shift)
    recorder = Recorder(system, opened_mesh, physics, segment, materials)
    failure = _follow(system, linear, recorder, press, segment, on_step)
    linear.close()
    return recorder.result(failure, linear.name, press, physics.follows_time)


def _follow(
    system: System,
    linear: LinearSolver,
    recorder: Recorder,
    press: Press,
    segment: Segment,
    on_step: OnStep | None,
) -> str | None:
    """March along the schedule; returns why it stopped short, or None."""
    full = full_drive(press, system, segment, recorder.tet_mesh)
    targets = schedule(press, full, system.units.length, recorder.physics.follows_time)
    try:
        past = [rest_state(system, linear, targets[0])]
    except NoEquilibriumError as error:
        past = [system.at_rest(targets[0].load)]
        recorder.start(past[0])
        return f"the prestretched film finds no equilibrium: {error}"
    recorder.start(past[0])
    count = len(targets) - 1
    for number, (before, target) in enumerate(pairwise(targets), start=1):
        failure = march(system, linear, past, target, before.kink, recorder.record)
        if past[-1].time > before.time:
            recorder.report()
            if on_step is not None:
                on_step(recorder.steps[-1], number, count)
        if failure is not None:
            reached = recorder.steps[-1]
            depth = f"{1e3 * reached.indentation_m:.3f} mm and {reached.reaction_force_N:.3g} N"
            return f"step {number} of {count} stopped at {depth}: {failure}"
    return None


def full_drive(press: Press, system: System, segment: Segment, tet_mesh: TetMesh) -> float:
    """Depth or force at the end of the press, solver units."""
    if press.force_N is not None:
        return press.force_N / scale_of_section(segment, tet_mesh)[0] / system.units.force
    return 1e-3 * (press.indentation_mm or DEFAULT_INDENTATION_MM) / system.units.length


