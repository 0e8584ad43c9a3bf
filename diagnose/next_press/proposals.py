"""Presses that a laboratory can make: those of the recording once more, or one of them with changes."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from diagnose.next_press.press_shape import Shape, recorded_shape
from diagnose.signals.recording import Recording, Run

LONGEST_S, MOST_SAMPLES = 120.0, 60_000
FEWEST_RISE_SAMPLES = 10  # a rise that is faster is not seen


@dataclass(frozen=True)
class Proposal:
    """A press that could be made. run : with its drive as samples and no answers. text : what to do, one sentence.

    changes : key -> new value, against the run that it varies. number : the run of the recording that it repeats, None
    for a new one. removes : the mechanism that it keeps away, so that no model has it; "" for none.
    """

    text: str
    changes: Mapping[str, Any]
    run: Run
    number: int | None = None
    removes: str = ""


@dataclass(frozen=True)
class PressSetup:
    """A shape of press at a run of the recording. words, changes : how it differs from the press as it was."""

    run: Run
    shape: Shape
    words: tuple[str, ...] = ()
    changes: Mapping[str, Any] = field(default_factory=dict)
    removes: str = ""

    def with_change(self, words: str, changes: Mapping[str, Any], **parts: Any) -> "PressSetup":
        """This press with another run, shape or removal (parts), and with words and changes that say so."""
        return replace(self, words=(*self.words, words), changes={**self.changes, **changes}, **parts)

    @property
    def feasible(self) -> bool:
        """Whether it is over in time and its rise is sampled well enough."""
        duration, step = self.shape.duration_s, self.run.step_s
        fastest = min(self.shape.rise_s, self.shape.fall_s)
        return duration <= min(LONGEST_S, MOST_SAMPLES * step) and fastest >= FEWEST_RISE_SAMPLES * step

    def proposal(self) -> Proposal:
        """Proposal of this press, with its drive as samples at the rate of the run."""
        text = f"Press as in “{self.run.label}”" + (
            f", but {' and '.join(self.words)}." if self.words else " once more."
        )
        return Proposal(text, self.changes, self._imagined_run(), removes=self.removes)

    def _imagined_run(self) -> Run:
        run = self.run
        time, drive = self.shape.sample(run.step_s)
        unknown, everywhere = np.full(len(time), np.nan), np.ones(len(time), dtype=bool)
        return replace(
            run,
            file="next-press.csv",
            time_s=time,
            channels={name: drive if name == run.drive else unknown for name in run.channels},
            valid=dict.fromkeys(run.channels, everywhere),
            saturated=dict.fromkeys(run.channels, ~everywhere),
            covariates={},
        )


def base_setup(recording: Recording) -> PressSetup | None:
    """Deepest whole press of the recording, one driven by a displacement if any is; None without a whole press."""
    found = [(run, recorded_shape(recording, number)) for number, run in enumerate(recording.runs)]
    setups = [PressSetup(run, shape) for run, shape in found if shape is not None]
    return max(setups, key=lambda setup: (setup.run.drive == "displacement_mm", setup.shape.deep), default=None)


def repeat_proposals(recording: Recording) -> list[Proposal]:
    """Proposals to repeat each run of the recording."""
    return [Proposal(f"Repeat “{run.label}”.", {}, run, number) for number, run in enumerate(recording.runs)]
