"""The crosstalk matrix of an array: charge and voltage of each segment while a dot presses one of them alone."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from foundation.arrays import Floats
from geometry.array.layout import ArrayLayout
from softdot.arrays.case import ArrayCase
from softdot.arrays.presses import ArrayPresses, Signals
from softdot.prepared_press import PreparedPress


@dataclass(frozen=True)
class CrosstalkMatrix:
    """All presses of an array by one dot. [i][j] : segment j while only segment i is pressed.

    solved : number of a segment -> the press that was solved over it; the others are mirror images of these.
    """

    case: ArrayCase
    solved: Mapping[int, Signals]

    @property
    def layout(self) -> ArrayLayout:
        """Layout of the segments."""
        return self.case.layout

    def press(self, number: int) -> Signals:
        """The solved press that stands for that of one segment."""
        return self.solved[min(self.case.images(number))]

    def image_numbers(self, number: int) -> list[int]:
        """Number of the segment of the solved press that is the image of each segment, when one of that number is
        pressed.
        """
        columns, rows = len(self.layout.centres(0)), len(self.layout.centres(1))
        stands_for = divmod(min(self.case.images(number)), columns)
        row, column = divmod(number, columns)
        flip_row, flip_column = row != stands_for[0], column != stands_for[1]
        return [
            (rows - 1 - r if flip_row else r) * columns + (columns - 1 - c if flip_column else c)
            for r, c in (divmod(other, columns) for other in range(rows * columns))
        ]

    def _all_histories(self, name: str) -> Floats:
        """A quantity (n, s, n) of all presses: pressed segment, step, segment that is read."""
        count = len(self.layout.places)
        return np.array([getattr(self.press(i), name)[:, self.image_numbers(i)] for i in range(count)])

    @cached_property
    def charge_pC(self) -> Floats:
        """Charge (n, s, n): pressed segment, step, segment that is read."""
        return self._all_histories("charge_pC")

    @cached_property
    def voltage_V(self) -> Floats:
        """Voltage (n, s, n) at open circuit."""
        return self._all_histories("voltage_V")

    @cached_property
    def signal_V(self) -> Floats:
        """Voltage (n, s, n) that is read: behind the amplifiers where there are some, else at open circuit."""
        return self._all_histories("signal_V")

    @property
    def depth_mm(self) -> Floats:
        """Depth (n, s) of the dot in each press."""
        return np.array([self.press(i).depth_mm for i in range(len(self.layout.places))])

    @property
    def force_N(self) -> Floats:
        """Force (n, s) on the dot in each press."""
        return np.array([self.press(i).force_N for i in range(len(self.layout.places))])

    @property
    def ratio(self) -> Floats:
        """Voltage of each segment over that of the pressed one, with its sign, (n, s, n); NaN where that has none."""
        own = np.array([self.signal_V[i, :, i] for i in range(len(self.signal_V))])
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(own[:, :, None] == 0.0, np.nan, self.signal_V / own[:, :, None])

    @property
    def crosstalk_percent(self) -> Floats:
        """Voltage (n, n) at full load in percent of that of the pressed segment: 100 on the diagonal."""
        return np.asarray(100.0 * self.ratio[:, -1])

    @property
    def crosstalk_dB(self) -> Floats:
        """20 log10 of the size of the voltage ratio at full load, (n, n); -inf where a segment reads nothing."""
        with np.errstate(divide="ignore"):
            return np.asarray(20.0 * np.log10(np.abs(self.ratio[:, -1])))

    @property
    def largest_crosstalk_percent(self) -> float:
        """The largest size of an entry beside the diagonal at full load; 0 for one segment."""
        size = np.abs(self.crosstalk_percent)
        return float(np.max(size[~np.eye(len(size), dtype=bool)], initial=0.0))

    def asymmetry_percent(self) -> float:
        """Largest difference between a charge and that with both segments exchanged, of the largest charge.

        It is no error: only segments that are images of each other must read each other alike.
        """
        at_full = self.charge_pC[:, -1]
        return float(100.0 * np.abs(at_full - at_full.T).max() / np.abs(at_full).max())

    def summary(self) -> dict[str, Any]:
        """The part of array.json that the matrix gives."""
        places = self.layout.places
        return {
            "segments": [[place.row, place.column] for place in places],
            "labels": [place.label for place in places],
            "centres_mm": [[place.x_mm, place.y_mm] for place in places],
            "capacitance_pF": self.press(0).capacitance_pF,
            "solved": [places[number].label for number in self.solved],
            "indentation_mm": self.depth_mm,
            "reaction_force_N": self.force_N,
            "charge_matrix_pC": self.charge_pC[:, -1],
            "voltage_matrix_V": self.voltage_V[:, -1],
            "readout_voltage_matrix_V": self.signal_V[:, -1] if self.press(0).readout_voltage_V is not None else None,
            "crosstalk_percent": self.crosstalk_percent,
            "crosstalk_dB": self.crosstalk_dB,
            "largest_crosstalk_percent": self.largest_crosstalk_percent,
            "asymmetry_percent": self.asymmetry_percent(),
            "charge_history_pC": self.charge_pC,
            "voltage_history_V": self.voltage_V,
        }


def matrix_presses(case: ArrayCase) -> dict[str, PreparedPress]:
    """Presses that are no image of another one, by their names."""
    places = [case.layout.places[number] for number in case.solved_numbers]
    return {f"the press of {place.label}": case.press_over(place) for place in places}


def crosstalk(case: ArrayCase, solve: ArrayPresses) -> CrosstalkMatrix:
    """Solve every press that is no image of another one. StoppedPressError for one that does not converge."""
    return CrosstalkMatrix(case, dict(zip(case.solved_numbers, solve(matrix_presses(case)).values(), strict=True)))
