"""The conditions of reading a line, with units in their names, bounds and defaults."""

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from math import isfinite
from typing import Any, Literal, get_args

from foundation.errors import InputError
from geometry.braille_standards import BrailleStandard, standard
from softdot.arrays.kernel import ArrayKernel

Mode = Literal["slide", "press"]
MODES: tuple[Mode, ...] = get_args(Mode)
WIDEST_SIGMA = 2.5
"""Standard deviations at which the scatter of dots is cut; the range of a standard is taken for that many to each
side.
"""
HEIGHT_SCATTER_MM, POSITION_SCATTER_MM = 0.015, 0.03
"""Assumed where the standard states no range; no source gives them."""
DEFAULT_SHARE_OF_DEPTH = 0.75
"""Default depth as a share of the kernel's depth."""
PITCH_TOLERANCE_MM = 0.01
"""Difference of two pitches that still count as equal."""
WIDEST_TREMOR_RMS = 4.0  # RMS, where the wobble is cut
BOUNDS: dict[str, tuple[float, float]] = {
    "speed_mm_per_s": (0.5, 500.0),
    "depth_mm": (1e-3, 5.0),
    "force_N": (1e-4, 1e3),
    "yaw_deg": (-45.0, 45.0),
    "offset_mm": (-5.0, 5.0),
    "tremor_um": (0.0, 1000.0),
    "tremor_Hz": (0.05, 30.0),
    "height_mm": (0.05, 2.0),
    "height_scatter_mm": (0.0, 0.5),
    "position_scatter_mm": (0.0, 0.5),
    "worn": (0.0, 1.0),
    "wear_mm": (0.0, 2.0),
    "missing": (0.0, 1.0),
    "noise_mV": (0.0, 1e6),
    "hum_mV": (0.0, 1e6),
    "sampling_Hz": (50.0, 1e5),
    "speed_cv": (0.0, 1.0),
    "speed_time_s": (0.05, 60.0),
    "pauses": (0.0, 100.0),
    "ways_back": (0.0, 100.0),
    "wander_mm": (0.0, 2.0),
    "skew_deg": (-5.0, 5.0),
    "contact_losses": (0.0, 100.0),
    "contact_loss_s": (0.02, 10.0),
    "hum_Hz": (5.0, 1000.0),
    "hum_drift_Hz": (0.0, 5.0),
    "hum_third": (0.0, 1.0),
    "drift_mV": (0.0, 1e4),
    "gain_scatter": (0.0, 0.9),
    "dead_channel": (0.0, 1000.0),
    "swapped_channel": (0.0, 1000.0),
    "reversed_channel": (0.0, 1000.0),
    "press_s": (1e-3, 60.0),
    "hold_s": (0.0, 60.0),
}
"""Condition -> its least and largest value."""
CHANNELS = ("dead_channel", "swapped_channel", "reversed_channel")
"""Conditions that number a channel."""
HAND: dict[str, float] = {
    "speed_mm_per_s": 40.0,
    "speed_cv": 0.2,
    "speed_time_s": 0.5,
    "pauses": 1.0,
    "ways_back": 1.0,
    "wander_mm": 0.3,
    "skew_deg": 0.5,
    "hum_mV": 5.0,
    "hum_Hz": 49.97,
    "hum_drift_Hz": 0.02,
    "hum_third": 0.1,
    "gain_scatter": 0.1,
}
"""Conditions of a hand that holds the array, all of them assumed; those of a machine are the defaults."""
PRESETS: dict[str, dict[str, float]] = {"machine": {}, "hand": HAND}


@dataclass(frozen=True)
class ReadingConditions:
    """The conditions of reading a line; None stands for the value that kernel or standard imply.

    depth_mm or force_N : depth of nominal dots below the resting top, or force on all dots. height_mm : of all dots,
    which are deeper by its excess over the nominal one. worn, missing : shares of the dots. speed_cv, speed_time_s :
    standard deviation of the logarithm of the speed, and its correlation time. pauses, ways_back, contact_losses :
    their mean number in the line. skew_deg : angle of the path with the line. hum_mV : amplitude; hum_third : of its
    third harmonic over it. drift_mV : standard deviation of a slow voltage. dead_channel, swapped_channel (with the
    next one), reversed_channel : numbers from 1, 0 for none. leftward : from right to left.
    """

    standard: str | None = None
    mode: Mode = "slide"
    speed_mm_per_s: float = 10.0
    depth_mm: float | None = None
    force_N: float | None = None
    yaw_deg: float = 0.0
    offset_mm: float = 0.0
    tremor_um: float = 3.0
    tremor_Hz: float = 2.0
    height_mm: float | None = None
    height_scatter_mm: float | None = None
    position_scatter_mm: float = POSITION_SCATTER_MM
    worn: float = 0.0
    wear_mm: float = 0.1
    missing: float = 0.0
    sampling_Hz: float = 500.0
    noise_mV: float = 1.0
    hum_mV: float = 0.0
    speed_cv: float = 0.0
    speed_time_s: float = 0.5
    pauses: float = 0.0
    ways_back: float = 0.0
    wander_mm: float = 0.0
    skew_deg: float = 0.0
    contact_losses: float = 0.0
    contact_loss_s: float = 0.2
    hum_Hz: float = 50.0
    hum_drift_Hz: float = 0.0
    hum_third: float = 0.0
    drift_mV: float = 0.0
    gain_scatter: float = 0.0
    dead_channel: float = 0.0
    swapped_channel: float = 0.0
    reversed_channel: float = 0.0
    reversed_all: bool = False
    leftward: bool = False
    press_s: float = 0.2
    hold_s: float = 0.2
    seed: int = 0

    def __post_init__(self) -> None:
        """InputError for a value out of bounds."""
        for name, (low, high) in BOUNDS.items():
            value = getattr(self, name)
            if value is not None and not (isfinite(value) and low <= value <= high):
                raise InputError(f"{option_name(name)} = {value:g}: must be from {low:g} to {high:g}")
        if self.seed < 0:
            raise InputError(f"--seed = {self.seed}: must be at least 0")
        for name in CHANNELS:
            if getattr(self, name) != round(getattr(self, name)):
                raise InputError(f"{option_name(name)} = {getattr(self, name):g}: must be a whole number")
        if self.force_N is not None and self.contact_losses:
            raise InputError(f"--contact-losses = {self.contact_losses:g}: a held force keeps contact; give --depth-mm")
        if self.force_N is not None and self.mode == "press":
            raise InputError(f"--force-N = {self.force_N:g}: --mode press is driven by its depth; give --depth-mm")

    def with_implied_values(self, kernel: ArrayKernel) -> "ReadingConditions":
        """The conditions with standard, depth and scatter as kernel and standard imply. InputError for a
        contradiction.
        """
        if self.depth_mm is not None and self.force_N is not None:
            raise InputError(f"--force-N = {self.force_N:g}: give either --depth-mm or --force-N, not both")
        chosen = standard_of(kernel, self.standard)
        nominal = chosen.nominal_mm("height_mm", "--standard")
        height = nominal if self.height_mm is None else self.height_mm
        scatter = _height_scatter_mm(chosen) if self.height_scatter_mm is None else self.height_scatter_mm
        known = replace(self, standard=chosen.name, height_mm=height, height_scatter_mm=scatter)
        deepest = float(kernel.depth_mm[-1])
        margin = max(0.0, height - nominal) + WIDEST_SIGMA * scatter + 1e-3 * WIDEST_TREMOR_RMS * self.tremor_um
        most = deepest - margin
        if most <= 0.0:
            raise InputError(f"height and its scatter: the highest dot is {margin:.3g} mm deeper than a nominal one, "
                             f"and the kernel ends at {deepest:.3g} mm")  # fmt: skip
        depth = min(DEFAULT_SHARE_OF_DEPTH * deepest, most) if self.depth_mm is None else self.depth_mm
        if self.force_N is None and depth > most + 1e-9:
            raise InputError(
                f"--depth-mm = {depth:g}: with scatter and tremor a dot could be {depth + margin:.4g} mm deep, and the "
                f"kernel ends at {deepest:.4g} mm; give at most {most:.4g}"
            )
        if depth >= nominal:  # of nominal dots: lower ones leave the plate where it is
            raise InputError(
                f"--depth-mm = {depth:g}: the plate would touch the array, as its dots are {nominal:g} mm high"
            )
        return replace(known, depth_mm=most if self.force_N is not None else depth)

    def as_dict(self) -> dict[str, Any]:
        """All conditions by name."""
        return {one.name: getattr(self, one.name) for one in fields(self)}


PRESS_TIMES = ("press_s", "hold_s")
"""Conditions of --mode press alone."""
SLIDE_CONDITIONS = (
    "speed_cv", "pauses", "ways_back", "wander_mm", "skew_deg", "contact_losses", "leftward",
)  # fmt: skip
"""Conditions of --mode slide alone."""
HUM = ("hum_Hz", "hum_drift_Hz", "hum_third")
RECORDING_CONDITIONS = ("standard", "mode", *PRESS_TIMES, "speed_mm_per_s")
"""Conditions that the decoders of a recording are told; the speed only of presses, where it gives the time of the
next.
"""


def refuse_idle(conditions: ReadingConditions, stated: Iterable[str], is_recorded: bool) -> None:
    """InputError for a stated condition that has no effect beside the others, or beside a recording."""
    slides = conditions.mode == "slide"
    idle = {
        **(dict.fromkeys(PRESS_TIMES, "with --mode press") if slides else {}),
        **({"tremor_Hz": "with --tremor-um above 0"} if conditions.tremor_um == 0.0 else {}),
        **({"wear_mm": "with --worn above 0"} if conditions.worn == 0.0 else {}),
        **({"speed_time_s": "with --speed-cv above 0"} if conditions.speed_cv == 0.0 else {}),
        **({"contact_loss_s": "with --contact-losses above 0"} if conditions.contact_losses == 0.0 else {}),
        **(dict.fromkeys(HUM, "with --hum-mV above 0") if conditions.hum_mV == 0.0 else {}),
        **({} if slides else dict.fromkeys(SLIDE_CONDITIONS, "with --mode slide")),
    }
    for name in stated:
        if is_recorded and (name not in RECORDING_CONDITIONS or (slides and name == "speed_mm_per_s")):
            idle[name] = "on voltages that are simulated, and here --recording has its own"
        if name in idle:
            raise InputError(f"{option_name(name)} = {getattr(conditions, name)}: acts only {idle[name]}; leave it out")


def refuse_missing_channels(conditions: ReadingConditions, channels: int) -> None:
    """InputError for a condition of a channel that the array does not have."""
    for name in CHANNELS:
        if getattr(conditions, name) > channels:
            raise InputError(f"{option_name(name)} = {getattr(conditions, name):g}: the array has {channels} channels")


def option_name(name: str) -> str:
    """The option of the command line for a condition: --noise-mV."""
    return f"--{name.replace('_', '-')}"


def standard_of(kernel: ArrayKernel, name: str | None) -> BrailleStandard:
    """The named standard, else the kernel's. InputError where its dots are not as far apart as the segments."""
    chosen = standard(name or kernel.about["standard"], "--standard")
    pitch, own = chosen.nominal_mm("dot_pitch_mm", "--standard"), float(kernel.about["pitch_mm"])
    if abs(pitch - own) > PITCH_TOLERANCE_MM:
        raise InputError(
            f"--standard = '{chosen.name}': its dots are {pitch:g} mm apart, the segments of the kernel {own:g} mm; "
            "choose a standard of the same pitch or another kernel"
        )
    chosen.nominal_mm("cell_pitch_mm", "--standard")
    return chosen


def standard_warnings(kernel: ArrayKernel, chosen: BrailleStandard) -> list[str]:
    """A warning where the dots of the kernel differ from those of the standard."""
    own, base = kernel.about["dot"]["base_diameter_mm"], chosen.quantities["base_diameter_mm"].nominal_mm
    if base is None or abs(base - own) < PITCH_TOLERANCE_MM:
        return []
    return [f"dots of '{chosen.name}' have a base of {base:g} mm, those of the kernel {own:g} mm: contact differs"]


def _height_scatter_mm(chosen: BrailleStandard) -> float:
    size = chosen.quantities["height_mm"]
    if size.minimum_mm is None or size.maximum_mm is None:
        return HEIGHT_SCATTER_MM
    return (size.maximum_mm - size.minimum_mm) / (2.0 * WIDEST_SIGMA)
