"""The discretisation error of force and voltages, from the same press on elements two and three times as large.

Where the error of a mesh falls with the power p of the element size, it is the difference to a mesh of elements r times
as large over r^p - 1 (Richardson; Roache, J. Fluids Eng. 116, 1994, 405-413). Quadratic elements have p of 2 and more
where the solution is smooth. It is not at a held rim and at the edge of contact, and meshes of a mesher that does not
repeat itself scatter besides, which three meshes do not tell from convergence: p is taken as 1.2, a little above that
of a singular stress. One difference may vanish by chance, which two do rarely: the stated error is the root of the sum
of their squares, and of the least error that such a comparison can show. The scatter of meshes is included, as each is
a sample. benchmarks/error_bars.py counts how often the estimate covers the true error.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from foundation.arrays import Floats
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from softdot.summary import history, not_finite
from softdot.tolerances.questions import PressAnswer, Question, kept_on_disk, with_larger_elements
from solve.solution.full_load import StoppedShortError

SIZE_RATIOS = 2.0, 3.0
"""Element sizes of the larger meshes over that of the judged one."""
CONVERGENCE_ORDER, LEAST_PERCENT = 1.2, 0.25
"""Order of convergence, and least error that is stated, in percent: chosen on designs that benchmarks/error_bars.py
does not count.
"""


class Answers(NamedTuple):
    """The compared answers of a press at its steps (s,): force, open-circuit voltage of all electrodes in parallel, and
    of each alone (s, e).
    """

    force_N: Floats
    voltage_V: Floats
    electrode_voltages_V: Floats


class DiscretisationError(NamedTuple):
    """Error in percent of the largest force and voltage of a press, and of the voltage of each electrode alone (e,)."""

    force_percent: float
    voltage_percent: float
    electrodes_percent: Floats


def answers_from_summary(summary: Mapping[str, Any]) -> Answers:
    """The answers at all loaded steps of a press that converged, from its summary."""
    each = np.array([one["open_circuit_voltage_V"] for one in summary["electrodes"]], dtype=np.float64)
    total = np.asarray(summary["open_circuit_voltage_V"], dtype=np.float64)
    return Answers(np.asarray(summary["reaction_force_N"], dtype=np.float64)[1:], total[1:], each.T[1:])


def follows_path(config: Config) -> bool:
    """Whether the press cannot be judged by its full load alone: where the path matters, and after a slide."""
    return model_of(config).follows_time or bool(config.press.path_xy_mm)


def answers_on_larger_elements(config: Config, ratio: float) -> Answers:
    """The answers on larger elements, kept on disk: along the whole press where its path counts, else at full load.

    InputError, LinearSolveError, MeshingError, StoppedShortError.
    """
    if not follows_path(config):
        return answers_at_full_load(full_load(config, ratio))
    larger = with_larger_elements(config, ratio)
    return Answers(*map(np.array, kept_on_disk(larger, "answers along the path", lambda: _answers_of_press(larger))))


def _answers_of_press(config: Config) -> Answers:
    """The answers at all loaded steps of a press. StoppedShortError."""
    result = PreparedPress(config).solve()
    past = history(result)
    each = np.array([step.open_circuit_voltage_V for step in result.steps])
    found = Answers(past.reaction_force_N[1:], past.open_circuit_voltage_V[1:], each[1:])
    failure = result.failure or not_finite(found._asdict())
    if failure:
        raise StoppedShortError(failure)
    return found


def full_load(config: Config, ratio: float, keys: Sequence[str] = ()) -> PressAnswer:
    """The press at its full load alone on larger elements, and its derivatives by keys; kept on disk.

    In one load step: where the path does not matter, the steps do not either. InputError also where it does;
    LinearSolveError, MeshingError, StoppedShortError.
    """
    larger = with_larger_elements(config, ratio)
    at_once = larger.press.model_copy(update={"load_steps": 1})
    question = Question(larger.model_copy(update={"press": at_once}), tuple(keys), is_full_load=True)
    return question.kept_answer()


def answers_at_full_load(load: PressAnswer) -> Answers:
    """The response at full load as answers of one step."""
    return Answers(*(np.array([one]) for one in (*load.nominal, load.electrodes_V[""])))


def discretisation_error(fine: Answers, larger: Mapping[float, Answers]) -> DiscretisationError:
    """The discretisation error of answers. larger : ratio of sizes -> answers on larger elements, at as many steps or
    at the last one alone.
    """
    off = zip(*(_richardson_percent(fine, coarse, ratio) for ratio, coarse in larger.items()), strict=True)
    force, voltage, electrodes = (np.sqrt(np.sum(np.square(each), axis=0) + LEAST_PERCENT**2) for each in off)
    return DiscretisationError(float(force), float(voltage), electrodes)


def _richardson_percent(fine: Answers, coarse: Answers, ratio: float) -> list[Floats]:
    """The error of the finer mesh in percent, for each of the answers, from one coarser mesh (Richardson)."""
    steps, falls = len(coarse.force_N), ratio**CONVERGENCE_ORDER - 1.0
    return [_largest_difference_percent(one[-steps:], other) / falls for one, other in zip(fine, coarse, strict=True)]


def _largest_difference_percent(fine: Floats, coarse: Floats) -> Floats:
    """Largest difference over the steps (s, ...), in percent of the largest value, of each column."""
    size = np.abs(fine).max(axis=0)
    return np.asarray(100.0 * np.abs(fine - coarse).max(axis=0) / np.maximum(size, 1e-300))
