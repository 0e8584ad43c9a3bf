"""improved.toml: the configuration of the user with the physics that the recordings show to be missing."""

from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any, cast

import tomlkit
from tomlkit.items import InlineTable, Table

from diagnose.engines.coupon.engine import CouponEngine
from diagnose.engines.coupon.improved_material import improved_material
from diagnose.findings import Findings, FittedModel
from diagnose.forward import Engine, Setting
from diagnose.next_press.press_shape import Shape
from diagnose.next_press.proposals import base_setup
from diagnose.verdict.names import model_words
from diagnose.verdict.resimulation import setting_mechanism
from softdot.config.rig import RIG_FILE, RIG_KEYS, Rig

IMPROVED_HEADING = "Your {} with what the recordings say was left out: {}."
UNCHANGED_HEADING = "Your {} unchanged: the diagnosis named nothing that was left out."
COUPON_HEADING = (
    "The material '{}' as its coupon says: {}. It is in medium 2 of the default segment; copy it where you need it."
)


def improved_text(rig: Rig, engine: Engine, findings: Findings) -> str | None:
    """The improved configuration as TOML, comments kept; None for a coupon without a result and an unknown geometry.

    Without a [press] of its own it presses like the deepest press of the recording.
    """
    if rig.config is not None:
        document, head = _segment(rig, findings)
    elif rig.recording.specimen is not None and findings.best is not None:
        document, head = _coupon(cast(CouponEngine, engine), findings.best)
    else:
        return None
    return f"# {head}\n\n{tomlkit.dumps(document).strip()}\n"


def _segment(rig: Rig, findings: Findings) -> tuple[tomlkit.TOMLDocument, str]:
    document = tomlkit.parse((rig.folder / RIG_FILE).read_text("utf-8-sig"))
    for key in RIG_KEYS & document.keys():
        document.remove(key)
    deepest = base_setup(rig.recording)
    if "press" not in document and deepest is not None:
        document.add(tomlkit.nl())
        document["press"] = _press(deepest.run.drive, deepest.shape)
    if findings.best is None:
        return document, UNCHANGED_HEADING.format(RIG_FILE)
    _append(document, [setting_mechanism(setting).model_dump(mode="json") for setting in findings.best.settings])
    return document, IMPROVED_HEADING.format(RIG_FILE, model_words(findings.best))


def _coupon(engine: CouponEngine, best: FittedModel) -> tuple[tomlkit.TOMLDocument, str]:
    layer = "medium2"
    fitted = ((engine.nuisance(name), value) for name, value in best.shared.items())
    constants = [Setting(candidate, (value,)) for candidate, value in fitted if candidate is not None]
    found = improved_material(engine, [*best.settings, *constants], layer)
    document = tomlkit.parse(files("softdot.config").joinpath("default.toml").read_text("utf-8"))
    document["segment"][layer]["material"] = found.name
    document["materials"] = {found.name: _round_floats(found.table, 6)}
    _append(document, found.mechanisms)
    return document, COUPON_HEADING.format(found.name, model_words(best))


def _append(document: tomlkit.TOMLDocument, mechanisms: Sequence[Mapping[str, Any]]) -> None:
    """Append tables [[mechanisms]] to those of the user."""
    tables = document.get("mechanisms", tomlkit.aot())
    for mechanism in mechanisms:
        table = tomlkit.table()
        table.add("name", mechanism["name"])
        table.add("component", mechanism["component"])
        table.add("parameters", _inline(mechanism["parameters"]))
        table.add(tomlkit.nl())
        tables.append(table)
    if tables:
        document["mechanisms"] = tables


def _press(drive: str, shape: Shape) -> Table:
    depth = "indentation_mm" if drive == "displacement_mm" else "force_N"
    press = tomlkit.table()
    press.add(depth, _round_floats(shape.deep, 3))
    times = {"rise_s": shape.rise_s, "hold_s": shape.hold_s, "fall_s": shape.fall_s}
    press.add("waveform", _inline({"shape": "trapezoid", **_round_floats(times, 3)}))
    press.add(tomlkit.nl())
    return press


def _inline(values: Mapping[str, Any]) -> InlineTable:
    table = tomlkit.inline_table()
    table.update(_round_floats(dict(values), 6))
    return table


def _round_floats(value: Any, digits: int) -> Any:
    """Data with all floats rounded to a number of significant digits, also within lists and tables."""
    if isinstance(value, float):
        return float(f"{value:.{digits}g}")
    if isinstance(value, list | tuple):
        return [_round_floats(item, digits) for item in value]
    return {key: _round_floats(item, digits) for key, item in value.items()} if isinstance(value, dict) else value
