"""What a design is before anything is solved: its values, mistakes, warnings, parts and cost."""

from collections.abc import Mapping
from pathlib import PurePath
from typing import Any

from geometry.base import InputError, load_alone
from softdot.case import Case
from softdot.config import Config, config_from, input_hash
from softdot.config.errors import mistakes
from softdot.config.toml import completed, parse_toml
from softdot.console import plain
from softdot.second_process import PARTS

NAME = "design"


def case_of(text: str) -> Case:
    """The case of a design. InputError."""
    return _case(parse_toml(text, NAME))


def _case(tables: Mapping[str, Any]) -> Case:
    config = config_from(completed(tables))
    refuse_files_outside(config)
    return Case(config)


def refuse_files_outside(config: Config) -> None:
    """InputError for a file of the design that is not below the folder in which the studio was started: a design that
    comes from somebody else must not read others.
    """
    waveform = config.press.waveform
    own = {"mesh.file": config.mesh.file, "press.waveform.file": None if waveform is None else waveform.file}
    for key, name in own.items():
        if name is None:
            continue
        path = PurePath(name.replace("\\", "/"))
        if path.is_absolute() or ".." in path.parts or ":" in name:
            raise InputError(f"{key} = '{name[:60]}': must be below the folder in which the studio was started")


def pressed_part(case: Case) -> Case:
    """The same design without what changes no press: the circuit, and the time where only the load counts."""
    config, model = case.config, case.model
    if not model.follows_time:
        behind = tuple(one for one in config.mechanisms if not one.traits.electrical)
        press = config.press.model_copy(update={"waveform": None})
        config = config.model_copy(update={"readout": None, "mechanisms": behind, "press": press})
    return Case(config)


def draw(text: str) -> dict[str, Any] | None:
    """The parts at rest for the 3D view; None for a design that has none, about which examine says why."""
    from export.parts_view import parts_view
    from geometry.assembly import case_solid, layer_solids
    from geometry.checks import check_segment
    from geometry.dot import resolve_dot

    try:
        model = case_of(text).model
        segment = model.segment
        check_segment(segment)
        solids = {**layer_solids(segment, 1e-3 * segment.film.thickness_um), "case": case_solid(segment)}
        return parts_view(solids, resolve_dot(model.dot, segment))
    except InputError:
        return None


def examine(text: str) -> dict[str, Any]:
    """What the page says of a design.

    values : every key, None where the text is no TOML. mistakes : one sentence each; where there is one, nothing is
    pressed. remedies : for each mistake or warning. press_hash : of all that the press depends on.
    """
    from softdot.checks import design_warnings, expected_cost
    from softdot.studio.work.remedies import remedies

    try:
        tables = parse_toml(text, NAME)
    except InputError as error:
        return {"values": None, "stated": None, "mistakes": [str(error)], "warnings": [], "remedies": [None]}

    def check(found: Mapping[str, Any]) -> Case:
        case = _case(found)
        _ = case.checked
        return case

    found, case = mistakes(tables, check)
    if case is None:
        whole, stated = plain({"values": completed(tables), "stated": tables}).values()
        tried = remedies(tables, found, check)
        return {"values": whole, "stated": stated, "mistakes": found, "warnings": [], "remedies": tried}
    dot, warnings = case.checked
    warnings = [*warnings, *design_warnings(case.model)]
    told: dict[str, Any] = plain(
        {
            "values": case.config.model_dump(mode="json"),
            "stated": tables,
            "mistakes": found,
            "warnings": warnings,
            "cost": vars(expected_cost(case.config, dot, case.planes)),
        }
    )
    tried = remedies(tables, warnings, check)
    return {**told, "remedies": tried, "press_hash": input_hash(pressed_part(case).config)}


def warm_up() -> None:
    """Load what a drawn design takes."""
    load_alone("build123d", *PARTS)
    draw("")
