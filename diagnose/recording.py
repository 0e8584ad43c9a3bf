"""A recording: runs of one rig, each with its samples and what the experimenter believes of it."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from diagnose.phases import Segmentation, segmented
from diagnose.sampling import even_pieces
from diagnose.tables import Drive, Specimen
from mesh.types import Bools, Floats
from solve.parameters import Readout


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

    @property
    def drive_values(self) -> Floats:
        """The channel that drives the simulation, (t,)."""
        return self.channels[self.drive]

    @property
    def answers(self) -> tuple[str, ...]:
        """The channels that a model has to explain."""
        return tuple(name for name in self.channels if name != self.drive)

    @property
    def voltages(self) -> tuple[str, ...]:
        """The voltage channels in the order of the electrodes."""
        return tuple(sorted((name for name in self.channels if name.startswith("voltage")), key=_number))

    def usable(self, channel: str) -> Bools:
        """Samples (t,) that a fit may use: measured and not at the limit."""
        return self.valid[channel] & ~self.saturated[channel]

    @cached_property
    def pieces(self) -> tuple[slice, ...]:
        """Stretches of even sampling: a gap in time or another rate begins a new one."""
        return even_pieces(self.time_s)

    @cached_property
    def step_s(self) -> float:
        """Median step of time."""
        return float(np.median(np.diff(self.time_s)))


@dataclass(frozen=True)
class Recording:
    """All runs of one rig. specimen : the coupon, where it is a coupon test. warnings : one sentence each."""

    runs: tuple[Run, ...]
    specimen: Specimen | None = None
    warnings: tuple[str, ...] = ()

    @cached_property
    def phases(self) -> tuple[Segmentation, ...]:
        """Presses and phases of each run. Only the dot's displacement counts from the touch."""
        return tuple(
            segmented(run.time_s, run.drive_values, self.specimen is None and run.drive == "displacement_mm")
            for run in self.runs
        )

    def run(self, label: str) -> Run:
        """The run with this label. KeyError."""
        return {run.label: run for run in self.runs}[label]


def _number(name: str) -> int:
    """voltage_3_V -> 3."""
    found = re.search(r"\d+", name)
    return int(found[0]) if found else 0
