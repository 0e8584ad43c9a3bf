"""Press the dot into the segment and, where a path is given, slide it."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from mesh.types import TetMesh
from solve.model import Model
from solve.readout.course import course
from solve.result import PressResult, Step
from solve.setup import Setup, discretise
from solve.solution.advice import explain_failure
from solve.solution.checkpoint import Checkpoint
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolver
from solve.solution.march import march, rest_state

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
    result = _solve_press(model, tet_mesh, on_step, checkpoint, dot or resolve_dot(model.dot, model.segment))
    for _ in range(MOST_DOUBLINGS):
        press = model.press.model_copy(update={"load_steps": 2 * model.press.load_steps})
        if accuracy_percent is None or not result.converged or press.load_steps > MOST_STEPS:
            break
        if course(result, model.press, model.amplifier, model.physics).readout_error_percent <= accuracy_percent:
            break
        model = replace(model, press=press)
        result = _solve_press(model, tet_mesh, on_step, None, dot or resolve_dot(model.dot, model.segment))
    return result


MOST_DOUBLINGS, MOST_STEPS = 4, 1000


def _solve_press(
    model: Model, tet_mesh: TetMesh, on_step: OnStep | None, checkpoint: Checkpoint | None, dot: DotShape
) -> PressResult:
    """Solve the press once, with the load steps that the model states."""
    setup = discretise(model, tet_mesh, dot)
    linear = LinearSolver(setup.system.factorisation_shift)
    failure = _follow(setup, linear, on_step, checkpoint)
    linear.close()
    if checkpoint is not None:
        checkpoint.discard()
    return setup.recorder.result(failure, linear.name, model.press, model.follows_time)


def _follow(setup: Setup, linear: LinearSolver, on_step: OnStep | None, checkpoint: Checkpoint | None) -> str | None:
    """March along the schedule and record it; returns why it stopped short, or None."""
    system, recorder, targets = setup.system, setup.recorder, setup.targets(setup.model.follows_time)
    past = [] if checkpoint is None else checkpoint.load(recorder, system.count)
    if not past:
        try:
            past = [rest_state(system, linear, targets[0])]
        except NoEquilibriumError as error:
            flat = system.at_rest(targets[0].load)
            recorder.start(flat)
            reason = explain_failure(system, error, flat, targets[0].load)
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
