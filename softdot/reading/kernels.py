"""The kernel that a line is read with, checked against this program, the configuration and the needs of a reader."""

from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

from foundation.errors import InputError
from geometry.parameters import Finite, Positive
from softdot.arrays.kernel import AGAIN, TABLES, ArrayKernel, load_kernel
from softdot.config.hashes import config_hash
from softdot.config.loading import config_from
from softdot.config.schema import Config
from softdot.reading.conditions import PITCH_TOLERANCE_MM
from softdot.version import installed_version
from solve.mechanisms import with_mechanisms
from solve.mechanisms.circuit.contact_electrification import CONTACT_ELECTRIFICATION
from solve.model import Model, Readout
from solve.physics import Physics


class KernelAbout(BaseModel):
    """The content of kernel.json that a reader needs; errors and counts of presses are there too."""

    model_config = ConfigDict(extra="allow", frozen=True, strict=True)
    centres_mm: list[list[Finite]]
    capacitance_pF: list[Positive]
    labels: list[str]
    pitch_mm: Positive
    size_mm: list[Positive]
    standard: str
    dot: dict[str, Any]
    softdot_version: str
    config_hash: str
    config: dict[str, Any]


DEFAULT_READOUT = Readout(input_resistance_MOhm=10.0)
"""The read-out of a reader where no [readout] is stated."""
DOT_ROWS = 3
"""Rows of dots in a cell."""


def open_kernel(folder: Path, config: Config | None = None) -> ArrayKernel:
    """Open the kernel in a folder. InputError for one of another program or design, or that cannot read a line."""
    kernel = load_kernel(folder)
    where = f"kernel '{folder}'"
    try:
        KernelAbout.model_validate(kernel.about)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key, said = ".".join(map(str, first["loc"])), first["msg"].lower()
        reason = "is missing" if first["type"] == "missing" else f": {said}"
        raise InputError(f"{where}: {key} {reason}; {AGAIN}") from None
    if kernel.about["softdot_version"] != installed_version():
        raise InputError(
            f"{where}: softdot_version = '{kernel.about['softdot_version']}': this is {installed_version()}; make the "
            "kernel again by softdot array --kernel"
        )
    check_kernel(kernel, where)
    if config is not None and not _same_design(kernel, config):
        raise InputError(
            f"{where}: config_hash = '{kernel.about['config_hash'][:12]}': is of another design than the configuration "
            f"with '{config_hash(config)[:12]}'; make a kernel of it by softdot array --kernel"
        )
    return kernel


def check_kernel(kernel: ArrayKernel, where: str) -> ArrayKernel:
    """Return the kernel. InputError, which begins with where, for one that is damaged or cannot read a line."""
    _refuse_damaged(kernel, where)
    _refuse_missing_rows(kernel, where)
    return kernel


def readout_of(kernel: ArrayKernel, config: Config | None) -> Readout:
    """The read-out of the configuration, else the kernel's, else DEFAULT_READOUT."""
    if config is not None and config.readout is not None:
        return config.readout
    own = kernel.about["config"].get("readout")
    return DEFAULT_READOUT if own is None else Readout.model_validate(own)


def electronics_of(kernel: ArrayKernel, readout: Readout) -> tuple[Readout, Physics]:
    """Read-out and stages, with the mechanisms of the kernel's design that act behind the film.

    The other mechanisms are in the charges of the kernel. InputError for those of single channels, and for a charge
    that the dot leaves, neither of which a reading models.
    """
    config = config_from(kernel.about["config"])
    behind = [one for one in config.mechanisms if one.traits.electrical]
    model = with_mechanisms(Model(config.segment, {}, config.dot, readout=readout), behind)
    apart = [part.words for part in model.physics.channels]
    apart += [one.name for one in config.mechanisms if one.name == CONTACT_ELECTRIFICATION.name and not one.is_off]
    if apart:
        raise InputError(
            f"mechanisms: {', '.join(apart)}: a reading has one amplifier for all segments and no charge of the touch; "
            "make a kernel without it"
        )
    return model.readout or readout, model.physics


def _same_design(kernel: ArrayKernel, config: Config) -> bool:
    """Whether kernel and configuration are alike but for the read-out, which changes no kernel."""
    if config_hash(config) == kernel.about["config_hash"]:
        return True
    own = config_from(kernel.about["config"])
    return bool(config_hash(config.model_copy(update={"readout": own.readout})) == kernel.about["config_hash"])


def _refuse_damaged(kernel: ArrayKernel, where: str) -> None:
    """InputError for a kernel with numbers or shapes that cannot be."""
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
    for name in ("x_mm", "y_mm", "depth_mm", "place_x_mm", "place_y_mm", "load_mm"):
        axis = getattr(kernel, name)
        if axis.ndim != 1 or len(axis) < 2 or not (np.diff(axis) > 0.0).all():
            raise InputError(f"{where}: {name} must rise from number to number; make it again")
    if not (kernel.capacitance_pF > 0.0).all():
        raise InputError(f"{where}: capacitance_pF must be above 0; make it again")


def _refuse_missing_rows(kernel: ArrayKernel, where: str) -> None:
    """InputError unless there is a segment over each row of dots."""
    pitch, y = float(kernel.about["pitch_mm"]), kernel.centres_mm[:, 1]
    for row in range(DOT_ROWS):
        if np.abs(y - pitch * (row - 1)).min() > 0.5 * pitch + PITCH_TOLERANCE_MM:
            raise InputError(
                f"{where}: has no segment over row {row + 1} of a cell; reading needs array.rows of at least {DOT_ROWS}"
            )
