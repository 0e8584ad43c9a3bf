"""Recordings: runs with their drive and channels on time axes even in stretches, and their tables in rig.toml."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from pathlib import PurePath
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, field_validator
from scipy.ndimage import median_filter

from diagnose.signals.acceleration import acceleration_mm_per_s2, velocity_mm_per_s
from diagnose.signals.phases import Segmentation, find_phases
from diagnose.signals.smoothed_drive import SmoothedDrive, smoothed_drive
from foundation.arrays import Bools, Floats
from foundation.nearest_name import nearest_name_hint
from geometry.parameters import Finite, Positive, Table
from solve.model import Readout
from solve.reduced.recording import second_differences

FORMAT = "softdot-recording/1"
NUISANCE_PARTS = ("effector", "medium1", "film", "medium2", "specimen")
ABSOLUTE = frozenset({"lag_s", "offset_V", "offset_N", "offset_mm"})
NUISANCES = frozenset(
    ABSOLUTE
    | {"gain", "force_gain", "clock_ratio", "d31"}
    | {f"{quantity}.{part}" for quantity in ("modulus", "thickness") for part in NUISANCE_PARTS}
)
LARGEST_RELATIVE = {"modulus.specimen": 10.0}
"""Largest relative uncertainty of what a test is made to find; of all else it is 1."""
Drive = Literal["displacement_mm", "force_N"]


class RunTable(Table):
    """Table of one run: its file of samples and what the experimenter believes of it."""

    file: str = Field(description="CSV file in the folder of rig.toml")
    label: str | None = Field(None, description="name in the report; none: the name of the file")
    drive: Drive = Field("displacement_mm", description="which measured column drives the simulation")
    dot_offset_mm: tuple[Finite, Finite] = Field((0.0, 0.0), description="position of the dot, x and y")
    over: tuple[int, int] | None = Field(
        None, description="row and column, from 1, of the segment of [array] that the dot stands over"
    )
    temperature_C: Annotated[float, Field(ge=-100.0, le=150.0, allow_inf_nan=False)] | None = Field(
        None, description="room temperature during this run"
    )
    virgin: bool | None = Field(
        None,
        description="whether the specimen was never strained before; none: a coupon is new in each run, anything else "
        "in the first one",
    )
    readout: dict[str, Any] = Field({}, description="keys of [readout] that differ in this run")
    nuisance: dict[str, Positive] = Field(
        {}, description="nuisance parameters, which are no missing physics, each with its standard deviation"
    )
    noise: dict[str, Positive] = Field(
        {}, description="column and standard deviation of its white noise, where neither rest nor repeated runs show it"
    )

    @field_validator("file")
    @classmethod
    def _inside(cls, value: str) -> str:
        """The name of the file, refused where it leads out of the folder of the recording."""
        parts = PurePath(value.replace("\\", "/")).parts
        if not parts or PurePath(value).is_absolute() or ".." in parts or ":" in parts[0]:
            raise ValueError("must be the name of a file in the folder of rig.toml or in a folder below it")
        return value

    @field_validator("nuisance", mode="before")
    @classmethod
    def _flat(cls, value: Any) -> Any:
        """Nuisances by dotted name: modulus.medium1 = 0.1 is a table in a table to TOML."""
        flat = _flatten(value) if isinstance(value, Mapping) else value
        for name in flat if isinstance(flat, Mapping) else ():
            if name not in NUISANCES:
                raise ValueError(f"'{name}' is not a nuisance parameter; {nearest_name_hint(name, NUISANCES)}")
            most = LARGEST_RELATIVE.get(name, 1.0)
            if name not in ABSOLUTE and isinstance(flat[name], int | float) and flat[name] > most:
                raise ValueError(
                    f"{name} = {flat[name]:g} is relative, and must be at most {most:g}; 0.05 is five percent"
                )
        return flat

    @property
    def name(self) -> str:
        """Label, or the name of the file without its ending."""
        return self.label if self.label is not None else self.file.rpartition("/")[2].removesuffix(".csv")


class Specimen(Table):
    """A coupon of one material, uniformly deformed."""

    kind: Literal["tension", "compression", "shear"] = Field(
        description="tension: a strip pulled along its length; compression: a block pressed through its thickness; "
        "shear: a layer between plates that move along its length"
    )
    material: str = Field(description="name of a material")
    length_mm: Positive = Field(description="tension: free length between the grips; otherwise the size along x")
    width_mm: Positive = Field(description="size along y")
    thickness_mm: Positive = Field(description="thickness of the strip, block or layer")

    @property
    def gauge_mm(self) -> float:
        """Length in mm by which a displacement is divided for the nominal strain."""
        return self.length_mm if self.kind == "tension" else self.thickness_mm

    @property
    def area_mm2(self) -> float:
        """Area in mm2 by which a force is divided for the nominal stress."""
        return self.width_mm * (self.thickness_mm if self.kind == "tension" else self.length_mm)


class RigTables(Table):
    """Tables of rig.toml other than those of the configuration."""

    format: Literal["softdot-recording/1"] = Field(description="format of this file")
    geometry: Literal["known", "unknown"] = Field(
        "known", description="unknown: there is no [segment] and no 3D model; the charge is proportional to the force"
    )
    runs: tuple[RunTable, ...] = Field(description="one table per file")
    specimen: Specimen | None = Field(None, description="a coupon in place of [segment]")

    @field_validator("runs")
    @classmethod
    def _some(cls, runs: tuple[RunTable, ...]) -> tuple[RunTable, ...]:
        if not runs:
            raise ValueError("must hold at least one table")
        return runs


def _flatten(table: Mapping[str, Any]) -> dict[str, Any]:
    """Nested tables as one with dotted names: {"modulus": {"medium1": 0.1}} -> {"modulus.medium1": 0.1}."""
    flat: dict[str, Any] = {}
    for name, value in table.items():
        inner = _flatten(value) if isinstance(value, Mapping) else None
        flat |= {name: value} if inner is None else {f"{name}.{key}": item for key, item in inner.items()}
    return flat


MEDIAN_WINDOW_STEPS = 9
"""Window of the running median of time steps: a single late sample is a gap, five in a row are another rate."""
GAP_RATIO, OTHER_RATE_RATIO = 1.5, 1.2
"""Ratios of a step to the running median, and of the running median to the one before."""


def even_pieces(time_s: Floats) -> tuple[slice, ...]:
    """Slices of a time axis (t,), together all of it, each without a gap and at one rate."""
    step = np.diff(time_s)
    usual = median_filter(step, MEDIAN_WINDOW_STEPS, mode="nearest")
    other_rate = np.abs(np.diff(np.log(usual))) > np.log(OTHER_RATE_RATIO)
    edges = {0, *(np.flatnonzero(step > GAP_RATIO * usual) + 1), *(np.flatnonzero(other_rate) + 1), len(time_s)}
    return tuple(slice(int(a), int(b)) for a, b in pairwise(sorted(edges)))


def samples_after_gaps(time_s: Floats) -> list[int]:
    """Numbers of the samples before which the time (t,) jumps."""
    step = np.diff(time_s)
    return [
        int(n) + 1 for n in np.flatnonzero(step > GAP_RATIO * median_filter(step, MEDIAN_WINDOW_STEPS, mode="nearest"))
    ]


def sampling_rates_Hz(time_s: Floats) -> list[float]:
    """Sampling rates of a time axis (t,), one after the other, without equal neighbours; short pieces do not count."""
    found: list[float] = []
    for piece in even_pieces(time_s):
        if piece.stop - piece.start <= MEDIAN_WINDOW_STEPS:
            continue
        rate = 1.0 / float(np.median(np.diff(time_s[piece])))
        if not found or abs(np.log(rate / found[-1])) > np.log(OTHER_RATE_RATIO):
            found.append(rate)
    return found


def is_evenly_sampled(time_s: Floats) -> bool:
    """Whether steps of time (t,) differ from their median by less than a tenth; noise models need that."""
    step = np.diff(time_s)
    return bool(len(step) > 0 and np.abs(step / np.median(step) - 1.0).max() < 0.1)


@dataclass(frozen=True)
class Run:
    """Samples of one run. Every array is (t,); channel names carry their units.

    file : as rig.toml names it.
    time_s : increases.
    drive : name of the channel that drives the simulation; it has no missing sample (short gaps are bridged).
    channels : displacement_mm, force_N, voltage_V or voltage_1_V ..., as far as measured; NaN where missing.
    valid : channel -> True where the sample, and that of the drive, was measured.
    saturated : channel -> True where the sensor or amplifier stood at its limit.
    covariates : dot_x_mm, dot_y_mm, temperature_C, as far as measured.
    readout : the amplifier of this run as rig.toml states it; None for open circuit.
    nuisance : what may float without counting as physics -> one-sigma width.
    noise : channel -> one sigma of its white noise, where the experimenter states it.
    moving, accelerated : velocity (mm/s) and acceleration (mm/s2) of the drive, where they are known better than from
    a path that was measured.
    virgin : whether a new specimen begins with it.
    largest_before : drive -> its largest value in earlier runs of the same specimen at this place, which stress
    softening and yield remember.
    """

    label: str
    file: str
    time_s: Floats
    drive: Drive
    channels: Mapping[str, Floats]
    valid: Mapping[str, Bools]
    saturated: Mapping[str, Bools]
    covariates: Mapping[str, Floats] = field(default_factory=dict)
    dot_offset_mm: tuple[float, float] = (0.0, 0.0)
    temperature_C: float | None = None
    readout: Readout | None = None
    nuisance: Mapping[str, float] = field(default_factory=dict)
    noise: Mapping[str, float] = field(default_factory=dict)
    moving: Floats | None = None
    accelerated: Floats | None = None
    virgin: bool = True
    largest_before: Mapping[Drive, float] = field(default_factory=dict)

    def with_drive(self, drive: Floats) -> "Run":
        """This run under another drive (t,); what is added to the measured one has no noise."""
        channels, more = {**self.channels, self.drive: drive}, drive - self.drive_values
        if self.drive != "displacement_mm":
            return replace(self, channels=channels, moving=None, accelerated=None)
        moving = self.velocity_mm_per_s + np.gradient(more, self.time_s)
        accelerated = self.acceleration_mm_per_s2 + second_differences(self.time_s, more)
        return replace(self, channels=channels, moving=moving, accelerated=accelerated)

    @property
    def drive_values(self) -> Floats:
        """Samples (t,) of the channel that drives the simulation."""
        return self.channels[self.drive]

    @cached_property
    def smoothed_drive(self) -> SmoothedDrive:
        """The motion behind the samples of the drive, with which a model is pressed."""
        return smoothed_drive(self.drive_values, self.pieces)

    @property
    def answers(self) -> tuple[str, ...]:
        """Names of the channels that a model has to explain."""
        return tuple(name for name in self.channels if name != self.drive)

    @property
    def voltages(self) -> tuple[str, ...]:
        """Names of the voltage channels in the order of the electrodes."""
        return tuple(sorted((name for name in self.channels if name.startswith("voltage")), key=_channel_number))

    def usable(self, channel: str) -> Bools:
        """Flags (t,) of samples that a fit may use: measured and not at the limit."""
        return self.valid[channel] & ~self.saturated[channel]

    @cached_property
    def pieces(self) -> tuple[slice, ...]:
        """Slices of even sampling: a gap in time or another rate begins a new one."""
        return even_pieces(self.time_s)

    @cached_property
    def velocity_mm_per_s(self) -> Floats:
        """Velocity (t,) of the drive in mm/s, where it is a displacement."""
        return velocity_mm_per_s(self.time_s, self.drive_values) if self.moving is None else self.moving

    @cached_property
    def acceleration_mm_per_s2(self) -> Floats:
        """Acceleration (t,) of the drive in mm/s2, where it is a displacement."""
        if self.accelerated is not None:
            return self.accelerated
        return acceleration_mm_per_s2(self.time_s, self.drive_values)

    @cached_property
    def step_s(self) -> float:
        """Median step of time in s."""
        return float(np.median(np.diff(self.time_s)))


def with_earlier_drives(runs: Iterable[Run]) -> Iterator[Run]:
    """Runs, each with the largest drives of the runs before it on the same specimen at the same place."""
    reached: dict[tuple[float, float], dict[Drive, float]] = {}
    for run in runs:
        reached = {} if run.virgin else reached
        before = reached.get(run.dot_offset_mm, {})
        yield replace(run, largest_before=before)
        most = max(float(run.drive_values.max()), before.get(run.drive, 0.0))
        reached[run.dot_offset_mm] = {**before, run.drive: most}


@dataclass(frozen=True)
class Recording:
    """All runs of one rig. specimen : the coupon of a coupon test, else None. warnings : one sentence each."""

    runs: tuple[Run, ...]
    specimen: Specimen | None = None
    warnings: tuple[str, ...] = ()

    @cached_property
    def phases(self) -> tuple[Segmentation, ...]:
        """Presses and phases of each run. Only the displacement of a dot counts from the touch."""
        return tuple(
            find_phases(run.time_s, run.drive_values, self.specimen is None and run.drive == "displacement_mm")
            for run in self.runs
        )

    def as_next_run(self, run: Run) -> Run:
        """A run as it would be made next, after all others; that of a coupon on a new one."""
        new = replace(run, virgin=self.specimen is not None)
        return list(with_earlier_drives([*self.runs, new]))[-1]

    def run(self, label: str) -> Run:
        """The run with this label. KeyError where there is none."""
        return {run.label: run for run in self.runs}[label]


def _channel_number(name: str) -> int:
    """Number in the name of a channel, 0 without one: voltage_3_V -> 3."""
    found = re.search(r"\d+", name)
    return int(found[0]) if found else 0
