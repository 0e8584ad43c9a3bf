"""A learned kernel as tables that answer touches, saved in a folder with a checksum."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from foundation.table_checksum import table_checksum

FORMAT = "softdot-learned-kernel/3"
NPZ, JSON, CHECKSUM = "kernel.npz", "kernel.json", "checksum_sha256"
AGAIN = "learn it again by softdot read --learn"
TABLES = ("limit", "centre", "weight", "axes", "mean", "dot_mean", "variance", "scatter", "shift_steps")


@dataclass(frozen=True)
class KernelView:
    """What touches of each of the 64 cells are like, along d axes of all that c heard channels do at t steps.

    limit (c,) : value from which on a channel is compressed, infinite where it is not. centre (t, c) : mean of the
    learned touches; weight (c,) : by which each channel is multiplied. axes (t, c, d). mean and variance (64, p, d) :
    of the mean touch of each cell at each of p lateral places, dot_mean (64, p, d) the mean by superposition of dots
    alone; scatter (64, d, d) : covariance of touches of one cell at one place. shift_steps (s,) : shifts over which
    scores are summed. lag_steps : of the right column behind the left one.
    """

    limit: Floats
    centre: Floats
    weight: Floats
    axes: Floats
    mean: Floats
    dot_mean: Floats
    variance: Floats
    scatter: Floats
    shift_steps: Floats
    lag_steps: float


@dataclass(frozen=True)
class LearnedKernel:
    """Views of the same touches, whose scores are averaged. about : what was learned from, and how sure to be."""

    views: tuple[KernelView, ...]
    about: dict[str, Any]

    @property
    def learned_cells(self) -> Ints:
        """Cells of which touches were learned, rising."""
        return np.array(sorted(int(cell) for cell in self.about["touches_of_cells"]), dtype=np.int64)

    def save(self, folder: Path) -> None:
        """Write kernel.npz and kernel.json."""
        tables = {
            f"{name}_{number}": getattr(view, name) for number, view in enumerate(self.views, 1) for name in TABLES
        }
        with (folder / NPZ).open("wb") as file:
            np.savez_compressed(file, **tables)
        about = {"format": FORMAT, **self.about}
        text = json.dumps({CHECKSUM: table_checksum(tables, about), **about}, indent=1, ensure_ascii=False)
        (folder / JSON).write_text(text, encoding="utf-8")


def is_learned_kernel(folder: str | None) -> bool:
    """Whether a folder holds the JSON file of a learned kernel, changed or not."""
    try:
        about = json.loads((Path(folder or "") / JSON).read_text("utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(about, dict) and str(about.get("format", "")).startswith(FORMAT.partition("/")[0])


def load_learned_kernel(folder: Path) -> LearnedKernel:
    """Load the learned kernel of a folder. InputError for one that is damaged, changed or of another format."""
    where = f"kernel '{folder}'"
    try:
        about = json.loads((folder / JSON).read_text("utf-8"))
        with np.load(folder / NPZ, allow_pickle=False) as file:
            tables = {name: np.asarray(file[name]) for name in file.files}
    except Exception as error:  # the readers raise what a damaged file happens to lead to
        raise InputError(f"{where}: cannot be read ({error}); {AGAIN}") from None
    if about.get("format") != FORMAT:
        raise InputError(f"{where}: format = {str(about.get('format'))[:40]!r}: must be '{FORMAT}'; {AGAIN}")
    if about.pop(CHECKSUM, None) != table_checksum(tables, about):
        raise InputError(f"{where}: {CHECKSUM} is not that of {JSON} and {NPZ}, one of which was changed; {AGAIN}")
    views = tuple(
        KernelView(**{name: tables[f"{name}_{number}"] for name in TABLES}, lag_steps=lag)
        for number, lag in enumerate(about["lags_steps"], 1)
    )
    return LearnedKernel(views, about)
