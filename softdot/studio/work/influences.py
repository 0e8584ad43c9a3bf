"""What moves the voltage most: each number of a design a tenth larger, or within the tolerance of making it."""

from typing import Any

from foundation.errors import InputError
from foundation.worker_process import Tell
from softdot.case import Case
from softdot.config.schema import Config
from softdot.json_files import plain
from softdot.studio.work.design import case_of
from softdot.studio.work.press import COARSE, TaskProgress
from softdot.tolerances.budget import tolerance_budget
from softdot.tolerances.factors import FACTORS, factor_key, has_component
from softdot.tolerances.questions import Question, coarser_press
from softdot.tolerances.tolerances import LAYER_NAMES

LARGER = 0.1
WORDS = {
    "modulus_factor": "stiffness of {}", "thickness_factor": "thickness of {}", "d31_factor": "d31 of {}",
    "radius_factor": "radius of {}",
}  # fmt: skip


def influences(text: str, tell: Tell) -> dict[str, Any]:
    """Change of the largest force and voltage in percent, to first order, on the mesh of the coarse press.

    rows : where a number grows by a tenth, the largest change of the voltage first.
    """
    case, progress = case_of(text), TaskProgress(tell)
    progress.stage("derivatives")
    config = quick_press(case.config)
    keys = _keys(config)
    nominal, slopes, _ = Question(config, tuple(keys)).kept_answer()
    if nominal.force == 0.0 or nominal.voltage == 0.0:
        raise InputError("this press gives no force or no voltage, so that nothing changes it by a share")
    rows: list[dict[str, Any]] = [
        {
            "label": label,
            "voltage_percent": 100 * LARGER * size * slopes[key].voltage / nominal.voltage,
            "force_percent": 100 * LARGER * size * slopes[key].force / nominal.force,
        }
        for key, (label, size) in keys.items()
    ]
    rows.sort(key=lambda row: -abs(row["voltage_percent"]))
    return dict(plain({"rows": rows, "larger_percent": 100 * LARGER}))


def tolerances_of_making(text: str, tell: Tell) -> dict[str, Any]:
    """The tolerance budget of the kit, on the mesh of the coarse press."""
    case, progress = case_of(text), TaskProgress(tell)
    progress.stage("tolerances")
    config = case.config
    half = config.mesh.scale_sizes(COARSE / 2).model_copy(update={"mesher": quick_press(config).mesh.mesher})
    budget = plain(tolerance_budget(config.model_copy(update={"mesh": half}), progress.step).as_dict())
    rows = [{**row, "label": f"{row['label']} ±{row['plus_minus']:.3g} {row['unit']}"} for row in budget["rows"]]
    return {"rows": rows, "total": budget["root_sum_square"]}


def quick_press(config: Config) -> Config:
    """On large elements, extruded where the shape allows it."""
    larger = coarser_press(config, COARSE)
    domed = config.segment.effector is not None and config.segment.effector.shape == "dome"
    return larger if domed else larger.model_copy(update={"mesh": larger.mesh.model_copy(update={"mesher": "layered"})})


def _keys(config: Config) -> dict[str, tuple[str, float]]:
    """Key of the configuration with factors -> what it is called, and its size."""
    found = {
        factor_key(config, component, factor): (WORDS[factor].format(LAYER_NAMES.get(component, component)), 1.0)
        for component, factors in FACTORS.items()
        if has_component(config, component)
        for factor in factors
    }
    segment, press = config.segment, config.press
    found["segment.length_mm"] = ("length of the segment", segment.length_mm)
    found["segment.width_mm"] = ("width of the segment", segment.width_mm)
    if press.force_N is not None:
        found["press.force_N"] = ("force of the press", press.force_N)
    else:
        found["press.indentation_mm"] = ("depth of the press", Case(config).model.press.depth_mm)
    return found
