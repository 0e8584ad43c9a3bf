"""The file of a calibration, and recordings and kernels as it corrects them."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from foundation.errors import InputError
from foundation.files import read_text
from geometry.parameters import Finite, Positive
from softdot.arrays.kernel import ArrayKernel
from softdot.reading.voltages import Voltages

FORMAT = "softdot-calibration/1"
JSON = "calibration.json"
AGAIN = "make it again by softdot read --calibrate"


class MeasuredValue(BaseModel):
    """A value with its 95 % interval."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    value: Finite
    low: Finite
    high: Finite


class Calibration(BaseModel):
    """A sensor beside its kernel. Lists have an entry for each segment; numbers of leads and segments are from 1.

    order : the lead of each segment. gain : charge over that of the kernel; scale : their mean. width : of the charge
    of a dot over that of the kernel. explained_share : of the squared charges of the known line.
    """

    model_config = ConfigDict(extra="ignore", frozen=True)
    config_hash: str
    cells: int = Field(ge=1)
    direction: Literal["rightward", "leftward"]
    order: list[int]
    dead: list[int]
    polarity: list[Literal[-1, 1]]
    gain: list[MeasuredValue]
    scale: MeasuredValue
    width: Positive
    noise_mV: list[Finite]
    offset_mm: Finite
    explained_share: Finite

    def voltages(self, heard: Voltages) -> Voltages:
        """Voltages of the segments in the order of the kernel, as it would give them; dead ones are 0."""
        gain = np.array([one.value for one in self.gain]) * np.array(self.polarity)
        gain[[number - 1 for number in self.dead]] = np.inf
        return replace(heard, voltage_V=heard.voltage_V[:, [lead - 1 for lead in self.order]] / gain)


def widened(kernel: ArrayKernel, width: float) -> ArrayKernel:
    """The kernel whose charges lie over places that are wider by a factor."""
    return replace(kernel, x_mm=width * kernel.x_mm, y_mm=width * kernel.y_mm)


def load_calibration(path: Path, kernel: ArrayKernel) -> Calibration:
    """Load the calibration of a kernel from a file or its folder. InputError for that of another design."""
    where = f"calibration '{path}'"
    file = path / JSON if path.is_dir() else path
    try:
        content = json.loads(read_text(file, "calibration"))
        if not isinstance(content, dict) or content.get("format") != FORMAT:
            raise InputError(f"{where}: is no file of format '{FORMAT}'; {AGAIN}")
        found = Calibration.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(map(str, first["loc"]))
        raise InputError(f"{where}: {key}: {first['msg'].lower()}; {AGAIN}") from None
    except ValueError as error:
        raise InputError(f"{where}: cannot be read ({error}); {AGAIN}") from None
    if found.config_hash != kernel.about["config_hash"]:
        raise InputError(
            f"{where}: config_hash = '{found.config_hash[:12]}': is of another design than the kernel with "
            f"'{kernel.about['config_hash'][:12]}'; {AGAIN}"
        )
    count = len(kernel.centres_mm)
    if sorted(found.order) != list(range(1, count + 1)) or not len(found.polarity) == len(found.gain) == count:
        raise InputError(f"{where}: order, polarity and gain must name each of {count} segments once; {AGAIN}")
    return found
