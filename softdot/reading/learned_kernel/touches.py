"""Recorded touches of single cells: NPZ files with the values of all channels over time, and the letters touched."""

import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from foundation.files import regular_file_size
from geometry.braille_cells import FIRST_CELL
from softdot.braille_text.english import english_table
from softdot.log import warn
from softdot.reading.cells import KINDS_OF_CELL

LARGEST_MB, LEAST_SAMPLES, LARGEST_VALUE = 1000, 8, 1e30
"""Size of a file that is read, samples of a touch that are needed, and a bound of values, whose squares are needed."""
SAME_SHARE = 0.02
"""By which sampling rates and durations of one sensor may differ."""
ARRAYS = ("taxels", "sampling_Hz", "letter", "place_mm", "together")
"""What is read of a file."""
CLIPPED_SHARE = 0.05
"""Of the values of a channel: where as many are its least or largest one, it is told as clipped."""


@dataclass(frozen=True)
class Touches:
    """Values (n, t, c) of c channels in n touches; the rest is None where a file does not say it.

    cells (n,) : what was touched, as numbers of six bits. place_mm (n, t) : course of the place. together (n,) :
    touches with the same number are of one cell.
    """

    taxels: Floats
    sampling_Hz: float
    cells: Ints | None = None
    place_mm: Floats | None = None
    together: Ints | None = None

    @property
    def duration_s(self) -> float:
        """Time that a touch lasts."""
        return float(self.taxels.shape[1] / self.sampling_Hz)

    def part(self, rows: Ints) -> "Touches":
        """Some of the touches."""
        return replace(
            self,
            taxels=self.taxels[rows],
            cells=None if self.cells is None else self.cells[rows],
            place_mm=None if self.place_mm is None else self.place_mm[rows],
            together=None if self.together is None else self.together[rows],
        )


def load_touches(path: Path) -> Touches:
    """Load the touches of a file. InputError for one that holds none, or numbers or letters that cannot be."""
    where = f"touches '{path}'"
    arrays = _arrays_of(path, where)
    for name in ("taxels", "sampling_Hz"):
        if name not in arrays:
            raise InputError(
                f"{where}: {name} is missing among {', '.join(arrays)[:200] or 'no array'}; taxels (touch, time, "
                "channel) and sampling_Hz are needed"
            )
    others = [name for name in arrays if name not in ARRAYS]
    if others:
        warn([f"{where}: {', '.join(others)[:200]}: not read; arrays that are: {', '.join(ARRAYS)}"])
    taxels = _finite(arrays["taxels"], f"{where}: taxels")
    if taxels.ndim != 3 or 0 in taxels.shape:
        raise InputError(f"{where}: taxels has the shape {taxels.shape}, it must be (touch, time, channel)")
    if taxels.shape[1] < LEAST_SAMPLES:
        raise InputError(f"{where}: a touch has {taxels.shape[1]} samples, at least {LEAST_SAMPLES} are needed")
    rate = _finite(arrays["sampling_Hz"], f"{where}: sampling_Hz")
    if rate.size != 1 or not rate.item() > 0.0:
        raise InputError(f"{where}: sampling_Hz must be one number above 0")
    count = len(taxels)
    place = None if "place_mm" not in arrays else _finite(arrays["place_mm"], f"{where}: place_mm")
    if place is not None and place.shape != taxels.shape[:2]:
        raise InputError(f"{where}: place_mm has the shape {place.shape}, that of taxels asks for {taxels.shape[:2]}")
    together = None if "together" not in arrays else _whole(arrays["together"], count, f"{where}: together")
    cells = None if "letter" not in arrays else _cells(arrays["letter"], count, where)
    return Touches(taxels, float(rate.item()), cells, place, together)


def join_touches(all_of: Sequence[Touches], names: Sequence[str]) -> Touches:
    """The touches of several files of one sensor. InputError, by the name of the file, where they differ in kind."""
    first = all_of[0]
    for one, name in zip(all_of, names, strict=True):
        for what, own, other in (
            ("channels", one.taxels.shape[2], first.taxels.shape[2]),
            ("samples a touch", one.taxels.shape[1], first.taxels.shape[1]),
            ("Hz of sampling", one.sampling_Hz, first.sampling_Hz),
        ):
            if own != other:
                raise InputError(
                    f"touches '{name}': has {own} {what}, '{names[0]}' has {other}; give files of one kind"
                )
        if (one.place_mm is None) != (first.place_mm is None):
            raise InputError(f"touches '{name}': place_mm must be in all files or in none")
    together = {
        key: None if any(getattr(one, key) is None for one in all_of)
        else np.concatenate([getattr(one, key) for one in all_of])
        for key in ("cells", "place_mm")
    }  # fmt: skip
    return Touches(np.concatenate([one.taxels for one in all_of]), first.sampling_Hz, **together)


def clipped_channels(taxels: Floats) -> dict[int, float]:
    """Share of the values that are the least or the largest one, of each channel from 1 on where that is often."""
    found = {}
    for number, values in enumerate(np.moveaxis(taxels, 2, 0), 1):
        share = max(float(np.mean(values == values.min())), float(np.mean(values == values.max())))
        if CLIPPED_SHARE <= share < 1.0:
            found[number] = share
    return found


def letter_of(cell: int) -> str | None:
    """The letter of a cell, a blank for the one without dots; None where the cell is no letter."""
    return " " if cell == 0 else {number: letter for letter, number in letter_cells().items()}.get(cell)


def letter_cells() -> dict[str, int]:
    """Letter -> cell, with the blank."""
    return {" ": 0, **{letter: ord(cell) - FIRST_CELL for letter, cell in english_table()["letters"].items()}}


def _arrays_of(path: Path, where: str) -> dict[str, Any]:
    """All arrays of a file. InputError where it cannot be read."""
    size = regular_file_size(path, where)
    if size > 1e6 * LARGEST_MB:
        raise InputError(f"{where}: has {size / 1e6:.0f} MB, at most {LARGEST_MB} MB are read")
    if not zipfile.is_zipfile(path):
        raise InputError(f"{where}: is no NPZ file, as numpy.savez writes it with taxels and sampling_Hz")
    try:
        with np.load(path, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except Exception as error:  # the reader raises what a damaged file happens to lead to
        raise InputError(f"{where}: cannot be read as NPZ without pickled objects ({error})") from None


def _finite(values: Any, what: str) -> Floats:
    """The values as floats. InputError for others than finite numbers."""
    if not (np.issubdtype(values.dtype, np.integer) or np.issubdtype(values.dtype, np.floating)):
        raise InputError(f"{what}: holds {values.dtype}, numbers are needed")
    wrong = np.argwhere(~(np.abs(values) < LARGEST_VALUE))
    if len(wrong):
        value = values[tuple(wrong[0])]
        told = f"is {value:g}, it must be below {LARGEST_VALUE:g}" if np.isfinite(value) else "is not finite"
        raise InputError(f"{what}{[int(one) for one in wrong[0]]}: {told}; leave that touch out")
    return np.asarray(values, dtype=np.float64)


def _whole(values: Any, count: int, what: str) -> Ints:
    """Whole numbers (n,). InputError for anything else."""
    if not np.issubdtype(values.dtype, np.integer) or values.shape != (count,):
        raise InputError(f"{what}: must be one whole number for each of the {count} touches")
    return np.asarray(values, dtype=np.int64)


def _cells(letters: Any, count: int, where: str) -> Ints:
    """Cells (n,) of letters, of the blank, or of Unicode Braille characters with six dots. InputError for others."""
    if letters.shape != (count,) or letters.dtype.kind != "U":
        raise InputError(f"{where}: letter must be one text for each of the {count} touches")
    known = letter_cells()
    cells = []
    for number, letter in enumerate(str(one) for one in letters):
        cell = known.get(letter, ord(letter) - FIRST_CELL if len(letter) == 1 else -1)
        if not 0 <= cell < KINDS_OF_CELL:
            raise InputError(
                f"{where}: letter[{number}] = '{letter[:20]}': must be a to z, a blank, or a Unicode Braille character "
                "of six dots"
            )
        cells.append(cell)
    return np.array(cells, dtype=np.int64)
