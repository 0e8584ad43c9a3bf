"""rig.toml: the configuration that a laboratory believes in, and the runs it recorded."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from pydantic import Field, ValidationError

from diagnose.signals.reading import read_recording
from diagnose.signals.recording import Recording, RigTables, Run, RunTable
from foundation.errors import InputError
from geometry.parameters import Table
from geometry.stack import layers
from softdot.config.array_rig import as_one_segment
from softdot.config.errors import refuse_absurd_numbers, sentence, without_round_off
from softdot.config.loading import config_from, with_built_in_constants
from softdot.config.schema import Config
from softdot.config.toml import read_toml
from solve.materials.parameters import AnyMaterial, Material, find_material
from solve.model import Readout

RIG_FILE = "rig.toml"
RIG_KEYS = frozenset(RigTables.model_fields)
"""Keys of rig.toml that are no configuration."""
Kind = TypeVar("Kind", bound=Table)


class Bench(Table):
    """The part of a configuration that holds without a segment: for a coupon test, or an unknown geometry."""

    materials: dict[str, AnyMaterial] = Field({}, description="materials beside or instead of the built-in ones")
    readout: Readout | None = Field(None, description="the amplifier; leave out for open circuit")
    seed: int = Field(0, ge=0, description="seed of everything random")


@dataclass(frozen=True)
class Rig:
    """A rig.toml and the samples that it names.

    tables : rig.toml as read. config : None where there is no segment, of an array the one wide segment; bench : what
    is known without a segment.
    """

    folder: Path
    tables: Mapping[str, Any]
    config: Config | None
    bench: Bench
    recording: Recording

    @property
    def materials(self) -> Mapping[str, Material]:
        """The user's own materials by name."""
        return self.config.materials if self.config is not None else self.bench.materials


def load_rig(folder: Path | str) -> Rig:
    """Read a folder of rig.toml and CSV files. InputError with one sentence naming file, key or row and column."""
    folder = Path(folder)
    if not folder.is_dir():
        what = "this is a file, a folder is needed" if folder.exists() else "there is no such folder"
        raise InputError(f"recording '{folder}': {what}")
    if not (folder / RIG_FILE).exists():
        raise InputError(f"recording '{folder}': has no {RIG_FILE}, which states what was built and measured")
    tables = read_toml(folder / RIG_FILE)
    try:
        own, config, bench, readouts = _parse_rig(tables)
    except InputError as error:
        raise InputError(f"recording '{folder / RIG_FILE}': {error}") from None
    height_mm = np.inf if config is None else layers(config.segment)[-1].top_mm
    recording = read_recording(folder, own.runs, readouts, own.specimen, height_mm)
    if config is not None:
        for run in recording.runs:
            _refuse_other_channels(run, config, folder)
            _refuse_dot_beside(run, config, folder)
    return Rig(folder, tables, config, bench, recording)


def _parse_rig(tables: Mapping[str, Any]) -> tuple[RigTables, Config | None, Bench, list[Readout | None]]:
    """The tables of rig.toml: those of recordings, configuration, bench, and the amplifier of each run. InputError."""
    own = _validate(RigTables, {key: tables[key] for key in RIG_KEYS & tables.keys()})
    rest = {key: value for key, value in tables.items() if key not in RIG_KEYS}
    if own.specimen is None and own.geometry == "known":
        config, runs = as_one_segment(config_from(rest), own.runs)
        own = own.model_copy(update={"runs": runs})
        bench = Bench(materials=config.materials, readout=config.readout, seed=config.seed)
    else:
        config, bench = None, _bench(rest, own)
    return own, config, bench, [_readout(run, number, rest, bench) for number, run in enumerate(own.runs)]


def _bench(rest: Mapping[str, Any], own: RigTables) -> Bench:
    """The bench of a coupon or an unknown geometry. InputError, also where a segment is stated."""
    if "segment" in rest:
        key = "specimen" if own.specimen is not None else "geometry = 'unknown'"
        raise InputError(f"segment and {key} exclude each other: leave one of them out")
    bench = _validate(Bench, with_built_in_constants(rest))
    if own.specimen is not None:
        find_material(own.specimen.material, bench.materials, "specimen.material")
    return bench


def _readout(run: RunTable, number: int, rest: Mapping[str, Any], bench: Bench) -> Readout | None:
    """The amplifier of one run: [readout] with the keys that the run overrides. InputError."""
    if not run.readout:
        return bench.readout
    given = rest.get("readout", {})
    try:
        return _validate(Bench, {"readout": Readout.override_keys(given, run.readout)}).readout
    except InputError as error:
        raise InputError(f"runs[{number}].{error}") from None


def _validate(kind: type[Kind], tables: Mapping[str, Any]) -> Kind:
    """Tables as one kind of table. InputError with one sentence."""
    tables = without_round_off(tables)
    try:
        checked = kind.model_validate_json(json.dumps(tables, default=str), strict=True)
    except ValidationError as error:
        raise InputError(sentence(error, tables, kind)) from None
    refuse_absurd_numbers(tables)
    return checked


def _refuse_other_channels(run: Run, config: Config, folder: Path) -> None:
    """InputError unless a run has one column of voltage for each electrode, or none."""
    columns, electrodes = len(run.voltages), max(1, len(config.segment.film.electrodes))
    if columns not in (0, electrodes):
        raise InputError(
            f"recording '{folder / run.file}' row 1: has {columns} columns of voltage, but segment.film.electrodes of "
            f"{RIG_FILE} makes {electrodes} of them"
        )
    numbered = [f"voltage_{number}_V" for number in range(1, columns + 1)]
    if run.voltages not in (("voltage_V",), tuple(numbered)):
        raise InputError(
            f"recording '{folder / run.file}' row 1: has {', '.join(run.voltages)}; electrodes are numbered from 1, so "
            f"{', '.join(numbered)}"
        )


def _refuse_dot_beside(run: Run, config: Config, folder: Path) -> None:
    """InputError where the middle of the dot is not over the segment."""
    sizes = np.array([config.segment.length_mm, config.segment.width_mm])
    if (np.abs(run.dot_offset_mm) > 0.5 * sizes).any():
        raise InputError(
            f"recording '{folder / RIG_FILE}': dot_offset_mm = {[float(f'{x:g}') for x in run.dot_offset_mm]} of the "
            f"run '{run.label}' is beside the segment of {sizes[0]:g} mm x {sizes[1]:g} mm"
        )
