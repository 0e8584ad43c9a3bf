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
    "press_s": (1e-3, 60.0),
    "hold_s": (0.0, 60.0),
}
"""Condition -> its least and largest value."""


@dataclass(frozen=True)
class ReadingConditions:
    """The conditions of reading a line; None stands for the value that kernel or standard imply.

    depth_mm or force_N : depth of nominal dots below the resting top, or force on all dots. height_mm : of all dots,
    which are deeper by its excess over the nominal one. worn, missing : shares of the dots. hum_mV : amplitude of 50
    Hz.
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
    }
    for name in stated:
        if is_recorded and (name not in RECORDING_CONDITIONS or (slides and name == "speed_mm_per_s")):
            idle[name] = "on voltages that are simulated, and here --recording has its own"
        if name in idle:
            raise InputError(f"{option_name(name)} = {getattr(conditions, name)}: acts only {idle[name]}; leave it out")


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
