"""How far an ordinary rig, a law and another good code may be off: a Gaussian process in parts of unknown size.

After Kennedy and O'Hagan, J. R. Stat. Soc. B 63 (2001) 425. Each part is relative to the signal of its channel:
    shape over a press: a few cosines over each press of a run, times the signal
    shape over depth, the same in all runs: the error of a model, and most of what two good codes differ by
    rate, the derivative of the signal over time: a small memory of the rig
    play, the signal less what a play operator makes of it: rate-independent hysteresis of a stage or load cell
    drift, a few cosines over each run
    first touch, what a dot that touches some micrometres later would change there: softness of a surface
    the rest, random in each phase, with the spectrum of a random walk, of flicker, or white
All but the rest are columns with normal weights. The sizes of columns and rest, for forces and voltages apart, are not
known: what is judged with a discrepancy integrates over them (inference/held_out_scores.py).
"""

from collections.abc import Sequence
from itertools import accumulate

import numpy as np

from diagnose.fit.discrepancy import depth_columns, error_scale_signals, smooth_columns
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.relative_errors import RelativeErrors, plain_noise_variance
from diagnose.fit.samples import SampleBlock, Samples
from diagnose.forward import Signals
from foundation.arrays import Floats, Ints

VISIBLE_ERROR = 0.01
"""Root mean square error over the signal, above noise, up to which flaws of an ordinary rig may explain it."""
PLAY_THRESHOLDS = (0.1, 0.3)  # of the largest signal of a channel
PARTS = {"rate": 0.5, "play": 0.5, "drift": 0.3}
"""Size of a part over that of the shapes, root mean squares over the signal."""
SOFT_TOUCH_MM = 0.002
"""By how much an ordinary surface gives way at first; one sigma."""
TOUCH_SHARE = 0.1  # of the deepest press: over this depth the softness of the first touch fades
FLOOR = 0.05  # of the root mean square of a press: what counts as signal where there is none
DRIFT_ORDERS = 2
SPECTRA = (2.0, 1.0, 0.0)
"""Powers of the frequency with which the rest may fall: a random walk, flicker, white."""


class RigDiscrepancy:
    """Discrepancies of all samples.

    columns : (n, k) whitened, of size one. quantity : (k,) number of the kind of channel of each, -1 for a column whose
    size is known. rough : (s, n) variance of the rest at size one for each of SPECTRA. kinds : units of the quantities,
    "N", "V", "mm". kind : (n,) number of the quantity. errors : relative to the signals.
    """

    def __init__(self, model: ObservedModel, values: Floats) -> None:
        """values : (p,) nuisances of the baseline. All parts are relative to its signals, in the size of what was
        recorded.
        """
        samples = model.samples
        self.samples = samples
        units = [name.rpartition("_")[2] for name in samples.channels]
        self.kinds = tuple(dict.fromkeys(units))
        of_channel = np.array([self.kinds.index(unit) for unit in units])
        channel = samples.kind[samples.block_of]
        self.kind: Ints = of_channel[channel]
        # smooth: columns of what was measured would hold its very noise
        self._signals = _of_recorded_size(model.signals(values), samples)
        noise = plain_noise_variance(samples)
        self.rough, squares = self._rough_variance(error_scale_signals(self._signals), noise)
        self.errors = RelativeErrors(noise, squares, channel, np.ones(len(samples), dtype=bool))
        self.columns, self.quantity = self._columns(of_channel, model, values)

    def _rough_variance(self, signals: Sequence[Signals], noise: Floats) -> tuple[Floats, Floats]:
        """(s, n) at size one, whitened, and the squares (n,) of the signals."""
        samples = self.samples
        found, squares = np.empty((len(SPECTRA), len(samples))), np.empty(len(samples))
        for block in samples.blocks:
            seen = signals[block.run][block.channel][block.observed_mask]
            squares[block.rows] = seen**2
            presses = samples.press[block.rows]
            floor = np.empty(len(seen))
            for press in np.unique(presses):
                own = presses == press
                floor[own] = FLOOR * float(np.sqrt(np.mean(seen[own] ** 2)))
            size = np.maximum(np.abs(seen), floor) ** 2
            for piece in samples.pieces_of(block):
                rows = slice(piece.samples.start - block.rows.start, piece.samples.stop - block.rows.start)
                order = 1.0 + np.arange(rows.stop - rows.start)
                for spectrum, power in enumerate(SPECTRA):
                    part = order**-power / np.sum(order**-power)
                    found[spectrum, piece.samples] = float(size[rows].sum()) * part / noise[piece.samples]
        return found, squares

    def _columns(self, of_channel: Ints, model: ObservedModel, values: Floats) -> tuple[Floats, Ints]:
        samples, ones = self.samples, [1.0] * len(self.samples.channels)
        found: list[Floats] = []
        quantity: list[int] = []
        for each in (smooth_columns, depth_columns):
            columns = each(samples, self._signals, ones)[0]
            found += list(columns.T)
        for column in found:  # each is of one channel
            quantity.append(int(self.kind[int(np.argmax(np.abs(column)))]))
        common = {(part, name): np.zeros(len(samples)) for part in ("rate", "play") for name in samples.channels}
        for block in samples.blocks:
            number = int(of_channel[samples.channels.index(block.channel)])
            for part, wave in self._waves(block):
                column = PARTS[part] * samples.block_vector(block, block.whitening(wave))
                found.append(column)
                quantity.append(number)
                if part in ("rate", "play"):
                    common[part, block.channel] += column
        for (_, name), column in common.items():
            found.append(column)
            quantity.append(int(of_channel[samples.channels.index(name)]))
        for column in _soft_touches(model, values):
            found.append(column)
            quantity.append(-1)
        return np.column_stack(found), np.array(quantity)

    def _waves(self, block: SampleBlock) -> list[tuple[str, Floats]]:
        """Parts with their shapes (t,), of the root mean square of the block's signal."""
        run = self.samples.recording.runs[block.run]
        signal = self._signals[block.run][block.channel]
        size = float(np.sqrt(np.mean(signal**2)))
        largest = float(np.abs(signal).max(initial=0.0))
        found = [("rate", np.gradient(signal, run.time_s) if len(signal) > 1 else np.zeros(len(signal)))]
        found += [("play", signal - played(signal, share * largest)) for share in PLAY_THRESHOLDS]
        turn = np.pi * (run.time_s - run.time_s[0]) / max(float(np.ptp(run.time_s)), np.finfo(float).tiny)
        found += [("drift", np.cos(order * turn)) for order in range(1, 1 + DRIFT_ORDERS)]
        scaled = []
        for part, wave in found:
            own = float(np.sqrt(np.mean(wave**2)))
            scaled.append((part, wave * (size / own if own > 0.0 else 0.0)))
        return scaled


def _of_recorded_size(signals: Sequence[Signals], samples: Samples) -> list[dict[str, Floats]]:
    """Signals of all runs, those of each channel times one factor that makes them as large as what was recorded."""
    recorded, predicted = np.zeros(len(samples.channels)), np.zeros(len(samples.channels))
    for block in samples.blocks:
        number, seen = samples.channels.index(block.channel), block.observed_mask
        recorded[number] += float((samples.recording.runs[block.run].channels[block.channel][seen] ** 2).sum())
        predicted[number] += float((signals[block.run][block.channel][seen] ** 2).sum())
    factor = np.sqrt(np.divide(recorded, predicted, out=np.ones_like(recorded), where=predicted > 0.0))
    scale = dict(zip(samples.channels, factor.tolist(), strict=True))
    return [{name: scale.get(name, 1.0) * values for name, values in run.items()} for run in signals]


def played(signal: Floats, threshold: float) -> Floats:
    """Signal (t,) behind a play of a width: it follows only what turns by more (Visintin, Differential Models of
    Hysteresis, 1994).
    """
    follow = accumulate(signal.tolist(), lambda at, value: min(max(at, value - threshold), value + threshold))
    return np.fromiter(follow, dtype=np.float64, count=len(signal))


def _soft_touches(model: ObservedModel, values: Floats) -> list[Floats]:
    """Column (n,) of a first touch that gives way, common to all runs; none where no depth drives."""
    column = np.zeros(len(model.samples))
    for number, run in enumerate(model.runs):
        if run.drive != "displacement_mm" or model.samples.recording.specimen is not None:
            continue
        depth = np.maximum(run.drive_values, 0.0)
        reach = TOUCH_SHARE * float(depth.max(initial=0.0))
        if reach <= SOFT_TOUCH_MM:
            continue
        given = SOFT_TOUCH_MM * -np.expm1(-depth / SOFT_TOUCH_MM) * np.exp(-depth / reach)
        try:
            softer = model.imagined_signals(number, run.drive_values - given, values, ())
            stated = model.imagined_signals(number, run.drive_values, values, ())
        except ValueError:
            continue
        column += model.run_vector(number, {name: softer[name] - stated[name] for name in run.answers})
    return [column] if column.any() else []
