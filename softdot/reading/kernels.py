"""The kernel that a line is read with: checked against this program, the configuration and what a reader needs."""

from pathlib import Path

import numpy as np

from geometry.base import InputError
from softdot.arrays.kernel import TABLES, ArrayKernel, load_kernel
from softdot.config import Config, config_from, config_hash
from softdot.console import installed_version
from softdot.reading.conditions import PITCH_TOLERANCE_MM
from solve.model import Readout

NEEDED = (
    "centres_mm", "capacitance_pF", "labels", "pitch_mm", "size_mm", "standard", "dot", "softdot_version",
    "config_hash", "config",
)  # fmt: skip
USUAL_READOUT = Readout(input_resistance_MOhm=10.0)
"""What a reader has where no [readout] is stated."""
ROWS = 3


def opened_kernel(folder: Path, config: Config | None = None) -> ArrayKernel:
    """Of a folder. InputError for one that this program did not write, of another design, or that cannot read."""
    kernel = load_kernel(folder)
    where = f"kernel '{folder}'"
    missing = [key for key in NEEDED if key not in kernel.about]
    if missing:
        raise InputError(f"{where}: {missing[0]} is missing; make it again by softdot array --kernel")
    if kernel.about["softdot_version"] != installed_version():
        raise InputError(
            f"{where}: softdot_version = '{kernel.about['softdot_version']}': this is {installed_version()}; make the "
            "kernel again by softdot array --kernel"
        )
    checked_kernel(kernel, where)
    if config is not None and not _same_design(kernel, config):
        raise InputError(
            f"{where}: config_hash = '{kernel.about['config_hash'][:12]}': is of another design than the configuration "
            f"with '{config_hash(config)[:12]}'; make a kernel of it by softdot array --kernel"
        )
    return kernel


def checked_kernel(kernel: ArrayKernel, where: str) -> ArrayKernel:
    """The same kernel. InputError, which begins with where, for one that is damaged or cannot read a line."""
    _refuse_damaged(kernel, where)
    _refuse_missing_rows(kernel, where)
    return kernel


def readout_of(kernel: ArrayKernel, config: Config | None) -> Readout:
    """Of the configuration, else of the kernel's, else the usual one."""
    if config is not None and config.readout is not None:
        return config.readout
    own = kernel.about["config"].get("readout")
    return USUAL_READOUT if own is None else Readout.model_validate(own)


def _same_design(kernel: ArrayKernel, config: Config) -> bool:
    """Whether both are alike but for the read-out, which changes no kernel."""
    if config_hash(config) == kernel.about["config_hash"]:
        return True
    own = config_from(kernel.about["config"])
    return bool(config_hash(config.model_copy(update={"readout": own.readout})) == kernel.about["config_hash"])


def _refuse_damaged(kernel: ArrayKernel, where: str) -> None:
    for name in TABLES:
        if not np.isfinite(getattr(kernel, name)).all():
            raise InputError(f"{where}: {name} holds a number that is not finite; make it again")
    places, count = (len(kernel.x_mm), len(kernel.y_mm), len(kernel.depth_mm)), len(kernel.centres_mm)
    surface = (len(kernel.place_x_mm), len(kernel.place_y_mm))
    sizes = {
        "charge_pC": (*places, count),
        "force_N": places,
        "sinking_mm": (*surface, len(kernel.load_mm), *surface),
        "centres_mm": (count, 2),
        "capacitance_pF": (count,),
    }
    for name, size in sizes.items():
        if getattr(kernel, name).shape != size:
            raise InputError(f"{where}: {name} has the size {getattr(kernel, name).shape}, not {size}; make it again")
    if not (kernel.capacitance_pF > 0.0).all():
        raise InputError(f"{where}: capacitance_pF must be above 0; make it again")


def _refuse_missing_rows(kernel: ArrayKernel, where: str) -> None:
    """A segment over each row of dots."""
    pitch, y = float(kernel.about["pitch_mm"]), kernel.centres_mm[:, 1]
    for row in range(ROWS):
        if np.abs(y - pitch * (row - 1)).min() > 0.5 * pitch + PITCH_TOLERANCE_MM:
            raise InputError(
                f"{where}: has no segment over row {row + 1} of a cell; reading needs array.rows of at least {ROWS}"
            )
