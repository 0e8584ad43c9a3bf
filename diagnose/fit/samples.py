"""All samples of a recording as one vector of independent numbers of unit variance, sorted by run, press and band.

Each channel of each run is whitened by its noise model, cut at phases, presses and gaps, and each piece is transformed
by an orthonormal cosine transform (statistics/cells.py). Noise stays white, and a signal shows in few numbers.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from diagnose.forward import Signals
from diagnose.noise.model import NoiseModel, Whitening
from diagnose.signals.recording import Recording, Run
from diagnose.statistics.cells import CosineTransform, FilterBank, TimeSegment, octave_edges_Hz, time_segments
from diagnose.statistics.hypotheses import Hypotheses, membership_with_pools
from foundation.arrays import Bools, Floats, Ints

POOLS: tuple[frozenset[str], ...] = tuple(
    map(frozenset, [
        {"press"}, {"band_Hz"}, {"press", "band_Hz"}, {"press", "run"}, {"press", "run", "phase"},
        {"press", "band_Hz", "run", "phase"}, {"press", "band_Hz", "run", "phase", "channel", "piece"},
    ])
)  # fmt: skip


@dataclass(frozen=True)
class SampleBlock:
    """Samples of one channel of one run. rows : their part of the vector."""

    run: int
    channel: str
    whitening: Whitening
    rows: slice

    @property
    def observed_mask(self) -> Bools:
        """Flags (t,) of the samples that are there."""
        return self.whitening.observed


class Samples:
    """All samples of a recording as one vector of n coefficients.

    blocks : in order. bank : the transform. channels : names by number. press : (n,) number of the press. presses :
    (run, press within it) of each number. run, phase : (n,) of each coefficient.
    """

    def __init__(self, recording: Recording, noise: Mapping[tuple[str, str], NoiseModel]) -> None:
        self.recording, self.noise = recording, noise
        self.channels = tuple(dict.fromkeys(name for run in recording.runs for name in run.answers))
        self.blocks = tuple(_sample_blocks(recording, noise))
        labels, steps = _sample_labels(recording, self.blocks, self.channels)
        self.bank = FilterBank(time_segments(labels, steps), _band_edges_Hz(labels, steps))
        pairs = np.column_stack([labels["run"], labels["press"]])
        unique, number = np.unique(pairs, axis=0, return_inverse=True)
        self.presses = tuple((int(run), int(press)) for run, press in unique)
        self.press: Ints = np.asarray(number.ravel(), dtype=np.int64)
        self.run, self.phase = labels["run"], labels["phase"]
        self.kind = np.array([self.channels.index(block.channel) for block in self.blocks])

    def __len__(self) -> int:
        return len(self.press)

    def noise_summaries(self) -> dict[tuple[str, str], Mapping[str, Any]]:
        """Summaries of the noise models by (label, channel)."""
        return {key: law.summary() for key, law in self.noise.items()}

    def coefficients(self, signals: Sequence[Signals]) -> Floats:
        """Vector (n,), or (n, k), of the signals of all runs: channel -> (t,) or (t, k)."""
        white = np.concatenate([b.whitening(signals[b.run][b.channel]) for b in self.blocks])
        return self.bank.coefficients(white)

    def block_vector(self, block: SampleBlock, white: Floats) -> Floats:
        """Vector (n, ...) of whitened samples (m, ...) of one block, zero elsewhere."""
        out = np.zeros((len(self), *white.shape[1:]))
        out[block.rows] = self._block_transforms[block.rows.start](white)
        return out

    def pieces_of(self, block: SampleBlock) -> tuple[TimeSegment, ...]:
        """Time segments of one block."""
        rows = block.rows
        return tuple(piece for piece in self.bank.pieces if rows.start <= piece.samples.start < rows.stop)

    @cached_property
    def _block_transforms(self) -> Mapping[int, CosineTransform]:
        """Cosine transforms of the blocks, by their first row."""
        return {block.rows.start: CosineTransform(self.pieces_of(block)) for block in self.blocks}

    @cached_property
    def fold(self) -> Ints:
        """Labels (n,) of what is held out together: a press; a phase where there is one press only."""
        return self.press if len(self.presses) > 1 else self.phase

    @cached_property
    def recorded_vector(self) -> Floats:
        """Vector (n,) of what was measured."""
        return self.coefficients([
            {name: np.where(np.isfinite(run.channels[name]), run.channels[name], 0.0) for name in run.answers}
            for run in self.recording.runs
        ])  # fmt: skip

    @cached_property
    def block_of(self) -> Ints:
        """Numbers (n,) of the block of each coefficient."""
        return np.repeat(np.arange(len(self.blocks)), [b.rows.stop - b.rows.start for b in self.blocks])

    @cached_property
    def order_in_piece(self) -> Ints:
        """Numbers (n,) of half turns of each coefficient over its piece: 0, 1, 2 ..."""
        return np.concatenate([np.arange(p.samples.stop - p.samples.start) for p in self.bank.pieces])

    @cached_property
    def frequency_Hz(self) -> Floats:
        """Frequency (n,) of each coefficient in Hz."""
        lengths = [(p.samples.stop - p.samples.start, p.step_s) for p in self.bank.pieces]
        return np.concatenate([np.arange(count) / (2.0 * count * step) for count, step in lengths])

    @cached_property
    def noise_density(self) -> Floats:
        """One-sided power spectral density (n,) of the noise of its channel at each coefficient's frequency."""
        density = np.empty(len(self))
        for block in self.blocks:
            law = block.whitening.noise
            density[block.rows] = law.autoregression.spectral_density(self.frequency_Hz[block.rows], law.step_s)
        return density

    @cached_property
    def piece_of(self) -> Ints:
        """Numbers (n,) of the piece of each coefficient."""
        lengths = [p.samples.stop - p.samples.start for p in self.bank.pieces]
        return np.repeat(np.arange(len(lengths)), lengths)

    @cached_property
    def hypotheses(self) -> Hypotheses:
        """Hypotheses on every cell and on pools of cells; each noise model errs on its own in each band."""
        used: dict[tuple[int, tuple[float, float]], float] = {}
        keys = []
        for cell in self.bank.cells:
            run = self.recording.runs[cell.labels["run"]]
            model = self.noise[run.label, self.channels[cell.labels["channel"]]]
            keys.append((id(model), cell.band_Hz))
            used[keys[-1]] = noise_degrees(model)
        number = {key: n for n, key in enumerate(used)}
        return Hypotheses(
            membership_with_pools(self.bank.cells, POOLS),
            self.bank.degrees,
            np.array([number[key] for key in keys]),
            np.array(list(used.values())),
        )


def noise_degrees(model: NoiseModel) -> float:
    """Degrees of freedom of the noise power at one frequency; inf where the noise is stated.

    The density of an autoregression of order p from n samples has the relative variance 2 p / n, and twice that at the
    ends of the band (Berk, Ann. Stat. 2 (1974) 489); a chi-square of d degrees has 2 / d. The larger one, and one more
    parameter for the variance.
    """
    parameters = len(model.autoregression.coefficients) + 1
    return max(model.samples / (2.0 * parameters), 1.0) if model.samples else float("inf")


def used_mask(run: Run, channel: str) -> Bools:
    """Flags (t,) of samples that count: measured, and not at a limit that rig.toml states.

    A limit that it does not state is itself what has to be explained.
    """
    stated = run.readout is not None and run.readout.largest_V is not None
    return run.usable(channel) if stated else run.valid[channel]


def _sample_blocks(recording: Recording, noise: Mapping[tuple[str, str], NoiseModel]) -> list[SampleBlock]:
    found: list[SampleBlock] = []
    first = 0
    for number, run in enumerate(recording.runs):
        for channel in run.answers:
            whitening = noise[run.label, channel].whitening(used_mask(run, channel), run.time_s)
            last = first + int(whitening.observed.sum())
            found.append(SampleBlock(number, channel, whitening, slice(first, last)))
            first = last
    return found


def _sample_labels(
    recording: Recording, blocks: Sequence[SampleBlock], channels: Sequence[str]
) -> tuple[dict[str, Ints], Floats]:
    """Labels (n,) of every sample and the nominal step (n,) of its even piece."""
    columns: dict[str, list[Ints]] = {name: [] for name in ("run", "channel", "phase", "press", "piece")}
    steps = []
    for block in blocks:
        run, found = recording.runs[block.run], recording.phases[block.run]
        number, step = np.zeros(len(run.time_s), dtype=np.int64), np.empty(len(run.time_s))
        for n, piece in enumerate(run.pieces):
            number[piece] = n
            step[piece] = float(np.median(np.diff(run.time_s[piece]))) if piece.stop - piece.start > 1 else run.step_s
        own = {
            "run": np.full(len(step), block.run), "channel": np.full(len(step), channels.index(block.channel)),
            "phase": found.phase, "press": found.press, "piece": number,
        }  # fmt: skip
        for name, values in own.items():
            columns[name].append(values[block.observed_mask])
        steps.append(step[block.observed_mask])
    return {name: np.concatenate(parts) for name, parts in columns.items()}, np.concatenate(steps)


def _band_edges_Hz(labels: Mapping[str, Ints], steps: Floats) -> Floats:
    """Edges of octaves in Hz from one turn in the longest piece up."""
    longest = max((p.samples.stop - p.samples.start) * p.step_s for p in time_segments(labels, steps))
    return octave_edges_Hz(longest, float(steps.min()))
