"""How far force and voltage of a run can be trusted, given mesh, mesher and tolerances of the materials.

To first order: each constant of a material, off by its stated tolerance, moves the response along its derivative
(ISO/IEC Guide 98-3, 2008, clause 5.1.2). The derivatives come from the same press on elements twice as large, at its
full load alone, which also gives the discretisation error (softdot.tolerances.discretisation). All parts are taken as
independent, and their squares added. Where a part is missing there is no sum: the mesh alone is far less than the
effect of the materials.
"""

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from mesh.types import MeshingError
from softdot.config.schema import Config
from softdot.tolerances.discretisation import (
    SIZE_RATIOS,
    Answers,
    answers_at_full_load,
    answers_from_summary,
    answers_on_larger_elements,
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
    found, names = answers_from_summary(summary), [one["name"] for one in summary["electrodes"]]
    if found.force_N[-1] == 0.0 or found.voltage_V[-1] == 0.0:
        return {}
    try:
        parts, larger, note = _estimate_parts(config)
    except PRESS_ERRORS:
        return {"uncertainty": {"parts": [], "note": MISSING_NOTES["failed"]}}
    error = discretisation_error(found, larger)
    times = " and ".join(f"{ratio:g}" for ratio in larger)
    mesh = np.array([error.force_percent, error.voltage_percent])
    parts.append(("mesh", f"the same press on elements {times} times as large", mesh))
    in_doubt = np.array([config.press.force_N is None, True])  # a force that is given is not
    each = zip(names, error.electrodes_percent, strict=True)
    electrodes = [{"name": name, "voltage_percent": float(percent)} for name, percent in each]
    told = [{"name": name, "source": source, **_percent_table(in_doubt * one)} for name, source, one in parts]
    total = np.sqrt(sum((in_doubt * one) ** 2 for *_, one in parts))
    return {
        "discretisation_error": {**_percent_table(in_doubt * mesh), "electrodes": electrodes},
        "uncertainty": {**(_percent_table(total) if note is None else {}), "parts": told, "note": note},
    }


def _percent_table(percent: Floats) -> dict[str, float]:
    """Percentages (2,) of force and voltage by name."""
    return {"force_percent": float(percent[0]), "voltage_percent": float(percent[1])}


Part = tuple[str, str, Floats]
"""Name and source of a part of the uncertainty, and its percentages (2,) of force and voltage."""


def _estimate_parts(config: Config) -> tuple[list[Part], dict[float, Answers], str | None]:
    """Parts of the materials, largest on the voltage first; answers on larger elements; a note on what is missing.

    Of the larger meshes only the first must succeed. Raises any of PRESS_ERRORS.
    """
    parts, note, (first, *further) = [], None, SIZE_RATIOS
    if follows_path(config):
        note = MISSING_NOTES["slide" if config.press.path_xy_mm else "path"]
        larger = {first: answers_on_larger_elements(config, first)}
    else:
        rows = [row for row in material_tolerances(config) if row.counted]
        load = full_load(config, first, sorted({key for row in rows for key in row.slopes}))
        parts = sorted((_material_part(row, load) for row in rows), key=lambda part: -part[2][1])
        larger = {first: answers_at_full_load(load)}
    for ratio in further:
        with suppress(*PRESS_ERRORS):
            larger[ratio] = answers_on_larger_elements(config, ratio)
    return parts, larger, note


def _material_part(row: Tolerance, load: PressAnswer) -> Part:
    """The part of one constant of a material, at the end of its tolerance."""
    percent = 100.0 * np.abs(row.effect(load.slopes) / np.array(load.nominal))
    return f"{row.label} ±{row.plus_minus:.3g} {row.unit}", row.source, percent


def fill_cache(config: Config) -> None:
    """Calculate what uncertainty needs besides the press, and leave it in the cache; it may run beside the press."""
    with suppress(*PRESS_ERRORS):
        _estimate_parts(config)
