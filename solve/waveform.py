"""How the indentation, or the force, follows time."""

from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field, PrivateAttr

from foundation.arrays import Floats
from geometry.parameters import ActsWith, NonNegative, Positive, Table

if TYPE_CHECKING:
    pass


class Waveform(Table):
    """How the indentation (or the force) follows time."""

    shape: Literal["ramp", "half-sine", "raised-cosine", "trapezoid", "file"] = Field(
        "ramp", description="ramp: up, then hold; trapezoid: up, hold, down; file: two CSV columns time_s, fraction"
    )
    rise_s: Positive = Field(
        0.5, description="time from touch to full depth; file: to its first row, where that is pressed already"
    )
    hold_s: Annotated[NonNegative, ActsWith(shape=("ramp", "trapezoid"))] = Field(0.0, description="time at full depth")
    fall_s: Annotated[Positive, ActsWith(shape=("trapezoid",))] = Field(0.5, description="time of the release")
    file: Annotated[str | None, ActsWith(needed=True, shape=("file",))] = Field(None, description="the CSV file")
    _samples: Floats | None = PrivateAttr(None)
    _each_solved: bool = PrivateAttr(False)

    @classmethod
    def through(cls, time_s: Floats, fraction: Floats, each_solved: bool = False) -> "Waveform":
        """Straight lines through fractions (t,) at increasing times (t,), as a file would state them."""
        made = cls.model_construct(shape="file")
        made._samples, made._each_solved = np.column_stack([time_s, fraction]), each_solved
        return made

    def lacks(self, name: str) -> bool:
        """Whether a key is missing; the file is not where its rows were given in its place."""
        return self._samples is None and super().lacks(name)

    @property
    def each_solved(self) -> bool:
        """Whether a state is solved at each of the samples, those in a hold too."""
        return self._each_solved

    @property
    def samples(self) -> Floats | None:
        """Times and fractions (t, 2) of a waveform that was made through them, else None."""
        return self._samples
