"""The discretisation error of force and voltages: the same press on elements two and three times as large tells.

Where the error of a mesh falls with the power p of the element size, it is the difference to a mesh of elements r times
as large over r^p - 1 (Richardson; Roache, J. Fluids Eng. 116, 1994, 405-413). Quadratic elements have p of 2 and more
where the solution is smooth. It is not at a held rim and at the edge of contact, and meshes of a mesher that does not
repeat itself scatter besides, which three meshes do not tell from convergence: p is taken as 1.2, a little above that
of a singular stress. One difference may vanish by chance, which two do rarely: the stated error is the root of the sum
of their squares, and of the least that such a comparison can tell. What meshes scatter is in it, as each is a sample.
benchmarks/error_bars.py counts how often it covers the true error.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from foundation.arrays import Floats
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from softdot.summary import history, not_finite
from softdot.tolerances.responses import FullLoadResponse, KitPress, on_larger_elements, remembered
from solve.solution.full_load import StoppedShortError

RATIOS = 2.0, 3.0
"""Sizes of the larger elements over that of the others."""
ORDER, LEAST_PERCENT = 1.2, 0.25
"""Of convergence, and least error that is stated: chosen on designs that benchmarks/error_bars.py does not count."""


class Answers(NamedTuple):
    """At the steps (s,) that are compared: force, open-circuit voltage of all electrodes in parallel, and of each alone
    (s, e).
    """

    force_N: Floats
    voltage_V: Floats
    electrode_voltages_V: Floats


class DiscretisationError(NamedTuple):
    """Of the largest force and voltage of a press; electrodes : of the voltage of each alone (e,)."""

    force_percent: float
    voltage_percent: float
    electrodes_percent: Floats


def answers_of(summary: Mapping[str, Any]) -> Answers:
    """Of a summary of a press that converged, at all its steps but the unloaded one."""
    each = np.array([one["open_circuit_voltage_V"] for one in summary["electrodes"]], dtype=np.float64)
    total = np.asarray(summary["open_circuit_voltage_V"], dtype=np.float64)
    return Answers(np.asarray(summary["reaction_force_N"], dtype=np.float64)[1:], total[1:], each.T[1:])


def follows_path(config: Config) -> bool:
    """Whether the full load alone does not tell about the last step: where the path matters, and after a slide."""
    return model_of(config).follows_time or bool(config.press.path_xy_mm)


def along_path(config: Config, ratio: float) -> Answers:
    """The whole press on larger elements, kept on disk. InputError, MeshingError, StoppedShortError."""
    larger = on_larger_elements(config, ratio)
    return Answers(*map(np.array, remembered(larger, "answers along the path", lambda: _whole_press(larger))))


def _whole_press(config: Config) -> Answers:
    result = PreparedPress(config).solve()
    past = history(result)
    each = np.array([step.open_circuit_voltage_V for step in result.steps])
    found = Answers(past.reaction_force_N[1:], past.open_circuit_voltage_V[1:], each[1:])
    failure = result.failure or not_finite(found._asdict())
    if failure:
        raise StoppedShortError(failure)
    return found


def full_load(config: Config, ratio: float, keys: Sequence[str] = ()) -> FullLoadResponse:
    """The press at its full load alone on larger elements, and its derivatives by keys; kept on disk.

    In one load step: where the path does not matter, the steps do not either. InputError also where it does;
    LinearSolveError, MeshingError, StoppedShortError.
    """
    larger = on_larger_elements(config, ratio)
    at_once = larger.press.model_copy(update={"load_steps": 1})
    return KitPress(larger.model_copy(update={"press": at_once})).full_load(keys)


def answer_at(load: FullLoadResponse) -> Answers:
    """As one step."""
    nominal = load.nominal
    return Answers(*(np.array([one]) for one in (nominal.force, nominal.voltage, load.electrode_voltages_V)))


def discretisation_error(fine: Answers, larger: Mapping[float, Answers]) -> DiscretisationError:
    """Of a mesh; larger : ratio of sizes -> answers on larger elements, at as many steps or at the last one alone."""
    off = zip(*(_by_one(fine, coarse, ratio) for ratio, coarse in larger.items()), strict=True)
    force, voltage, electrodes = (np.sqrt(np.sum(np.square(each), axis=0) + LEAST_PERCENT**2) for each in off)
    return DiscretisationError(float(force), float(voltage), electrodes)


def _by_one(fine: Answers, coarse: Answers, ratio: float) -> list[Floats]:
    """Richardson's estimate of the error of the finer mesh in percent, of each of the answers, from one other mesh."""
    steps, falls = len(coarse.force_N), ratio**ORDER - 1.0
    return [_percent(one[-steps:], other) / falls for one, other in zip(fine, coarse, strict=True)]


def _percent(fine: Floats, coarse: Floats) -> Floats:
    """Largest difference over the steps (s, ...) in percent of the largest value, of each column."""
    size = np.abs(fine).max(axis=0)
    return np.asarray(100.0 * np.abs(fine - coarse).max(axis=0) / np.maximum(size, 1e-300))
