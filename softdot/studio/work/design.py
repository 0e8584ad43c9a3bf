"""What a design is before anything is solved: its values, mistakes, warnings, parts and cost."""

from collections.abc import Mapping
from pathlib import PurePath
from typing import Any

from foundation.errors import InputError
from foundation.library_loading import load_alone
from geometry.array.checks import check_array
from geometry.checks import check_segment
from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from softdot.arrays.case import ArrayCase
from softdot.case import Case
from softdot.config.default_design import completed
from softdot.config.hashes import input_hash
from softdot.config.loading import config_from
from softdot.config.mistakes import mistakes
from softdot.config.schema import Config
from softdot.config.toml import parse_toml
from softdot.json_files import plain
from softdot.second_process import PARTS

NAME = "design"
Solids = dict[str, Any]
DOTS = range(1, 7)


def config_of(text: str) -> Config:
    """The configuration of a design. InputError."""
    return _config(parse_toml(text, NAME))


def _config(tables: Mapping[str, Any]) -> Config:
    config = config_from(completed(tables))
    refuse_files_outside(config)
    return config


def case_of(text: str) -> Case:
    """The case of a design of one segment. InputError."""
    return Case(config_of(text))


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


class SegmentDesign:
    """A design of one segment, as the page speaks of it."""

    presses = ("press:coarse_press", "press:accurate_press")

    def __init__(self, config: Config) -> None:
        self._case = Case(config)

    @property
    def warnings(self) -> list[str]:
        """InputError for what cannot be pressed."""
        return self._case.warnings

    def told(self) -> dict[str, Any]:
        """What it costs, and a hash of all that its press depends on."""
        case = self._case
        return {"cost": vars(case.cost), "press_hash": input_hash(pressed_part(case).config)}

    def solids(self) -> tuple[Solids, DotShape]:
        """Solids by their labels, and the dot. InputError."""
        from geometry.assembly import case_solid, layer_solids

        model = self._case.model
        segment = model.segment
        check_segment(segment)
        solids = {**layer_solids(segment, 1e-3 * segment.film.thickness_um), "case": case_solid(segment)}
        return solids, resolve_dot(model.dot, segment)


class ArrayDesign:
    """A design of an array, which the raised dots of a cell press."""

    presses = ("press:press_of_cell",)

    def __init__(self, config: Config) -> None:
        self._case = ArrayCase(config)

    @property
    def warnings(self) -> list[str]:
        """InputError for what cannot be pressed."""
        return self._case.warnings

    def told(self) -> dict[str, Any]:
        """What it costs, where its segments lie (mm), which of them is under which dot of the first cell, and a hash of
        the press; that is None where no dot is raised.
        """
        case = self._case
        cell, layout = case.config.dot.cell, case.layout
        under = {dot: number for dot in DOTS if (number := case.under_dot(dot)) is not None}
        segments = {"labels": [place.label for place in layout.places], "centres_mm": layout.middles}
        about = {**segments, "size_mm": layout.size_mm, "half_mm": layout.half_mm, "cell": cell, "under": under}
        pressed = None if cell is None else input_hash(case.config)
        return {"cost": vars(case.cost), "press_hash": pressed, "array": about}

    def solids(self) -> tuple[Solids, DotShape]:
        """As of a segment: the islands of a layer are one body, and the grid belongs to the case. InputError."""
        from build123d import Compound

        from geometry.array.parts import array_parts

        case = self._case
        check_array(case.layout)
        alone = case.config.dot.cell is None
        press = case.press_over(case.layout.places[0]) if alone else case.press_by_cell()
        parts: dict[str, list[Any]] = {}
        for part in array_parts(case.layout, press.dot):
            parts.setdefault(part.label.replace("grid", "case").rpartition("-")[2], []).append(part.solid)
        del parts["dot"]
        return {name: Compound(solids) for name, solids in parts.items()}, press.dot


def design_of(config: Config) -> SegmentDesign | ArrayDesign:
    """Of the kind that a configuration states. InputError."""
    return SegmentDesign(config) if config.array is None else ArrayDesign(config)


def draw(text: str) -> dict[str, Any] | None:
    """The parts at rest for the 3D view; None for a design that has none, about which examine says why."""
    from export.parts_view import parts_view

    try:
        return parts_view(*design_of(config_of(text)).solids())
    except InputError:
        return None


def examine(text: str) -> dict[str, Any]:
    """What the page says of a design.

    values : every key, None where the text is no TOML. mistakes : one sentence each; where there is one, nothing is
    pressed. remedies : for each mistake or warning. presses : the tasks that press it. press_hash : of all that the
    press depends on. array : of an array, where its segments are.
    """
    from softdot.studio.work.remedies import remedies

    try:
        tables = parse_toml(text, NAME)
    except InputError as error:
        return {"values": None, "stated": None, "mistakes": [str(error)], "warnings": [], "remedies": [None]}

    def check(found: Mapping[str, Any]) -> tuple[Config, SegmentDesign | ArrayDesign, list[str]]:
        config = _config(found)
        design = design_of(config)
        return config, design, design.warnings

    found, checked = mistakes(tables, check)
    if checked is None:
        whole, stated = plain({"values": completed(tables), "stated": tables}).values()
        tried = remedies(tables, found, lambda changed: check(changed)[2])
        return {"values": whole, "stated": stated, "mistakes": found, "warnings": [], "remedies": tried}
    config, design, warnings = checked
    told: dict[str, Any] = plain(
        {
            "values": config.model_dump(mode="json"),
            "stated": tables,
            "mistakes": found,
            "warnings": warnings,
            "presses": design.presses,
            **design.told(),
        }
    )
    return {**told, "remedies": remedies(tables, warnings, lambda changed: check(changed)[2])}


def warm_up() -> None:
    """Load what a drawn design takes."""
    load_alone("build123d", *PARTS)
    draw("")
