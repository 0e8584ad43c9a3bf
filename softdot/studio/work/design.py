"""What a design is before anything is solved: its values, mistakes, warnings, parts and cost."""

from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Any

from foundation.errors import InputError
from foundation.library_loading import load_alone
from geometry.array.checks import check_array
from geometry.array.layout import ArrayLayout
from geometry.checks import check_segment
from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from softdot.arrays.case import ArrayCase
from softdot.case import Case
from softdot.config.default_design import with_default_design
from softdot.config.hashes import input_hash
from softdot.config.loading import config_from
from softdot.config.mistakes import mistakes
from softdot.config.schema import Config
from softdot.config.toml import INCLUDE, parse_toml, with_included
from softdot.json_files import plain
from softdot.second_process import CAD_MODULES

NAME = "design"
Solids = dict[str, Any]
DOTS = range(1, 7)


def config_of(text: str) -> Config:
    """The configuration of a design. InputError."""
    return _config(_tables_of(text))


def _tables_of(text: str) -> dict[str, Any]:
    """The tables of a design and of the files that it includes. InputError."""
    tables = parse_toml(text, NAME)
    if INCLUDE not in tables:
        return tables
    for name in tables[INCLUDE] if isinstance(tables[INCLUDE], list) else []:
        _refuse_outside(INCLUDE, str(name))
    return with_included(tables, Path(NAME))


def _config(tables: Mapping[str, Any]) -> Config:
    config = config_from(with_default_design(tables))
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
        if name is not None:
            _refuse_outside(key, name)


def _refuse_outside(key: str, name: str) -> None:
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


class StudioDesign:
    """A design of one segment or of an array, as the page speaks of it."""

    def __init__(self, config: Config) -> None:
        self._case = Case(config)

    @property
    def presses(self) -> tuple[str, ...]:
        """The tasks that press it."""
        one = self._case.layout is None
        return ("press:coarse_press", "press:accurate_press") if one else ("press:press_of_cell",)

    @property
    def warnings(self) -> list[str]:
        """InputError for what cannot be pressed."""
        return self._case.warnings

    def told(self) -> dict[str, Any]:
        """What it costs, a hash of all that its press depends on, and of an array where its segments are.

        The hash is None where no dot of a cell is raised over an array.
        """
        case, cost = self._case, vars(self._case.cost)
        if case.layout is None:
            return {"cost": cost, "press_hash": input_hash(pressed_part(case).config)}
        pressed = None if case.config.dot.cell is None else input_hash(case.config)
        return {"cost": cost, "press_hash": pressed, "array": places(case.config, case.layout)}

    def solids(self) -> tuple[Solids, DotShape]:
        """Solids by their labels, and the dot. The islands of a layer are one body, and a grid belongs to the case.

        InputError.
        """
        case = self._case
        if case.layout is not None:
            return array_solids(case, case.layout)
        from geometry.assembly import case_solid
        from geometry.solids import layer_solids

        segment = case.model.segment
        check_segment(segment)
        solids = {**layer_solids(segment, 1e-3 * segment.film.thickness_um), "case": case_solid(segment)}
        return solids, resolve_dot(case.model.dot, segment)


def places(config: Config, layout: ArrayLayout) -> dict[str, Any]:
    """Where the segments of an array lie (mm), and which of them is under which dot of the first cell."""
    under = {dot: number for dot in DOTS if (number := ArrayCase(config).under_dot(dot)) is not None}
    segments = {"labels": [place.label for place in layout.places], "centres_mm": layout.middles}
    sizes = {"size_mm": layout.size_mm, "half_mm": layout.half_mm}
    return {**segments, **sizes, "cell": config.dot.cell, "under": under}


def array_solids(case: Case, layout: ArrayLayout) -> tuple[Solids, DotShape]:
    """As of a segment, the islands of a layer together, under the cell or a dot over the first segment. InputError."""
    from build123d import Compound

    check_array(layout)
    press = case.over("r1c1") if case.config.dot.cell is None else case.by_cell()
    parts: dict[str, list[Any]] = {}
    for part in press.parts:
        parts.setdefault(part.label.replace("grid", "case").rpartition("-")[2], []).append(part.solid)
    del parts["dot"]
    return {name: Compound(solids) for name, solids in parts.items()}, press.dot


def draw(text: str) -> dict[str, Any] | None:
    """The parts at rest for the 3D view; None for a design that has none, about which examine says why."""
    from export.solid_view import parts_view

    try:
        return parts_view(*StudioDesign(config_of(text)).solids())
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
        tables = _tables_of(text)
    except InputError as error:
        return {"values": None, "stated": None, "mistakes": [str(error)], "warnings": [], "remedies": [None]}

    def check(found: Mapping[str, Any]) -> tuple[Config, StudioDesign, list[str]]:
        config = _config(found)
        design = StudioDesign(config)
        return config, design, design.warnings

    found, checked = mistakes(tables, check)
    if checked is None:
        whole, stated = plain({"values": with_default_design(tables), "stated": tables}).values()
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
    load_alone("build123d", *CAD_MODULES)
    draw("")
