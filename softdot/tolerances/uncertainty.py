"""How far force and voltage of a run can be trusted, given mesh, mesher and tolerances of the materials.

To first order: each constant of a material, off by its stated tolerance, moves the response along its derivative
(ISO/IEC Guide 98-3, 2008, clause 5.1.2). The derivatives come from the same press on elements twice as large, at its
full load alone, which also gives the discretisation error (softdot.tolerances.discretisation). All parts are taken as
independent, and their squares added. Where a part is missing there is no sum: the mesh alone is far less than the
effect of the materials.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from math import hypot
from typing import Any, TypeVar

import numpy as np

from foundation.errors import InputError
from mesh.types import MeshingError
from softdot.config.schema import Config
from softdot.tolerances.discretisation import (
    SIZE_RATIOS,
    Answers,
    DiscretisationError,
    along_path,
    answers_at_full_load,
    answers_from_summary,
    discretisation_error,
    follows_path,
    full_load,
)
from softdot.tolerances.questions import PressAnswer
from softdot.tolerances.tolerances import Tolerance, material_tolerances
from solve.solution.full_load import StoppedShortError
from solve.solution.linear import LinearSolveError

PRESS_ERRORS = InputError, LinearSolveError, MeshingError, StoppedShortError
"""Errors of a press on larger elements, after which the uncertainty has no such part."""
MISSING_NOTES = {
    "path": "what the tolerances of the materials do is not estimated here, since this press depends on its path; "
    "softdot kit calculates it",
    "slide": "what the tolerances of the materials do is not estimated here, since the dot slides after it is pressed "
    "in; softdot kit calculates it for the press before the slide",
    "failed": "what the tolerances of the materials and the mesh do could not be estimated: the press on larger "
    "elements failed",
}
"""Reason why a part is missing -> the note that says so."""


def uncertainty(config: Config, summary: Mapping[str, Any]) -> dict[str, Any]:
    """The keys discretisation_error and uncertainty of summary.json: of the final force and open-circuit voltage.

    config : as the user states it; summary : of its press, which converged. Each part has name, source, force_percent
    and voltage_percent; note says what is missing, and then there is no sum. A run whose force or voltage is zero has
    no percentages.
    """
    found, given = answers_from_summary(summary), config.press.force_N is not None
    if found.force_N[-1] == 0.0 or found.voltage_V[-1] == 0.0:
        return {}
    try:
        parts, larger, note = _estimate_parts(config, given)
    except PRESS_ERRORS:
        return {"uncertainty": {"parts": [], "note": MISSING_NOTES["failed"]}}
    error = discretisation_error(found, larger)
    percent = _without_given_force((error.force_percent, error.voltage_percent), given)
    times = " and ".join(f"{ratio:g}" for ratio in larger)
    parts.append(_part_table("mesh", f"the same press on elements {times} times as large", percent))
    return {
        "discretisation_error": _error_table(error, percent, [one["name"] for one in summary["electrodes"]]),
        "uncertainty": {**(_root_sum_square(parts) if note is None else {}), "parts": parts, "note": note},
    }


def _error_table(error: DiscretisationError, percent: tuple[float, float], electrodes: Sequence[str]) -> dict[str, Any]:
    """The discretisation error as summary.json holds it."""
    named = zip(electrodes, error.electrodes_percent, strict=True)
    each = [{"name": name, "voltage_percent": float(one)} for name, one in named]
    return {"force_percent": percent[0], "voltage_percent": percent[1], "electrodes": each}


def _estimate_parts(config: Config, given: bool) -> tuple[list[dict[str, Any]], dict[float, Answers], str | None]:
    """Shares of the materials, largest on the voltage first; answers on larger elements; a note on what is missing.

    Raises any of PRESS_ERRORS.
    """
    if follows_path(config):
        larger = _pressed_on_larger_elements(lambda ratio: along_path(config, ratio))
        return [], larger, MISSING_NOTES["slide" if config.press.path_xy_mm else "path"]
    rows = [row for row in material_tolerances(config) if row.counted]
    keys = sorted({key for row in rows for key in row.slopes})
    loads = _pressed_on_larger_elements(lambda ratio: full_load(config, ratio, keys if ratio == SIZE_RATIOS[0] else ()))
    parts = [_material_part(row, loads[SIZE_RATIOS[0]], given) for row in rows]
    larger = {ratio: answers_at_full_load(load) for ratio, load in loads.items()}
    return sorted(parts, key=lambda part: -part["voltage_percent"]), larger, None


Found = TypeVar("Found")


def _pressed_on_larger_elements(press: Callable[[float], Found]) -> dict[float, Found]:
    """Ratio of sizes -> result of press there; only that of the first one must succeed. Raises any of PRESS_ERRORS."""
    found = {SIZE_RATIOS[0]: press(SIZE_RATIOS[0])}
    for ratio in SIZE_RATIOS[1:]:
        with suppress(*PRESS_ERRORS):
            found[ratio] = press(ratio)
    return found


def fill_cache(config: Config) -> None:
    """Calculate what uncertainty needs besides the press, and leave it in the cache; it may run beside the press."""
    with suppress(*PRESS_ERRORS):
        _estimate_parts(config, given=False)


def _without_given_force(percent: tuple[float, float], given: bool) -> tuple[float, float]:
    """Percentages of force and voltage, with zero for a force that is given."""
    return (0.0 if given else percent[0], percent[1])


def _root_sum_square(parts: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """The root of the sum of the squares of all parts, in percent of force and of voltage."""
    return {name: hypot(*(part[name] for part in parts)) for name in ("force_percent", "voltage_percent")}


def _material_part(row: Tolerance, answer: PressAnswer, given: bool) -> dict[str, Any]:
    """The part of one constant of a material, at the end of its tolerance."""
    force, voltage = 100.0 * np.abs(row.effect(answer.slopes) / np.array(answer.nominal))
    percent = _without_given_force((float(force), float(voltage)), given)
    return _part_table(f"{row.label} ±{row.plus_minus:.3g} {row.unit}", row.source, percent)


def _part_table(name: str, source: str, percent: tuple[float, float]) -> dict[str, Any]:
    """One part of the uncertainty as summary.json holds it."""
    return {"name": name, "source": source, "force_percent": percent[0], "voltage_percent": percent[1]}
