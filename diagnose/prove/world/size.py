"""How large an effect is against the noise, once every declared nuisance has taken its part; how far from rivals.

Signals are whitened by the true noise. With the sensitivities T to the nuisances, scaled by their widths, an effect e
keeps e' (1 + T T')^-1 e of its energy: the least of |e - T x|^2 + |x|^2.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from diagnose.prove.world.bench import BENCHES, Bench
from diagnose.prove.world.made import Floats
from diagnose.prove.world.noise import noises
from diagnose.prove.world.reality import Reality, Signals, baseline, record

PER_RUN = {"gain", "force_gain", "lag_s", "offset_V", "offset_N", "offset_mm"}


def whitened(signals: Sequence[Signals], bench: Bench) -> Floats:
    """All answers of all runs, one after the other, in units of the innovations of their noise."""
    parts = [noises()[name].whitened(run[name]) / noise_of(bench)[name] for run in signals for name in channels(bench)]
    return np.concatenate(parts)


def channels(bench: Bench) -> tuple[str, ...]:
    """Answers that this bench records."""
    return ("force_N", "voltage_V") if bench.force else ("voltage_V",)


def noise_of(bench: Bench) -> Mapping[str, float]:
    """One sigma of each channel."""
    return {"force_N": bench.noise * bench.peak_N, "voltage_V": bench.noise * bench.peak_V}


@dataclass(frozen=True)
class Judge:
    """Measures effects on a bench; its nuisances are those of what the experimenter believes."""

    bench: Bench

    @cached_property
    def _tangents(self) -> Floats:
        """(t, k) by secants over one sigma."""
        belief = baseline(self.bench)
        base, columns = whitened(record(belief, self.bench), self.bench), []
        for name, width in self.bench.nuisance:
            for key in [(name, run) for run in range(len(self.bench.runs))] if name in PER_RUN else [name]:
                there = record(replace(belief, nuisance={key: width}), self.bench)
                columns.append(whitened(there, self.bench) - base)
        return np.stack(columns, axis=1)

    @cached_property
    def _half(self) -> tuple[Floats, Floats]:
        """Directions (t, k) and factors (k,) of (1 + T T')^-1/2 - 1."""
        left, values, _ = np.linalg.svd(self._tangents, full_matrices=False)
        return left, 1.0 / np.sqrt(1.0 + values**2) - 1.0

    def left(self, reality: Reality, without: Reality) -> Floats:
        """What nuisances cannot explain (t,) of the difference between two realities."""
        effect = whitened(record(reality, self.bench), self.bench) - whitened(record(without, self.bench), self.bench)
        directions, factors = self._half
        return np.asarray(effect + directions @ (factors * (directions.T @ effect)))

    @staticmethod
    def rms(left: Floats) -> float:
        """Per sample."""
        return float(np.sqrt(np.mean(left**2)))

    @staticmethod
    def separation(truth: Floats, rivals: Sequence[Floats]) -> float:
        """Sigmas between an effect and the nearest combination of a rival's, all as left by the nuisances."""
        family = np.stack(rivals, axis=1)
        best, *_ = np.linalg.lstsq(family, truth, rcond=None)
        return float(np.linalg.norm(truth - family @ best))


def shares(left: Floats, bench: Bench) -> dict[tuple[str, str], float]:
    """(label of run, channel) -> its share of the energy of an effect."""
    found, start, total = {}, 0, float(left @ left) or 1.0
    for run in bench.runs:
        for name in channels(bench):
            count = len(run.times(bench.rate_Hz))
            part = left[start : start + count]
            found[run.label, name] = float(part @ part) / total
            start += count
    return found


@lru_cache(maxsize=16)
def judge_of(name: str) -> Judge:
    """The judge of a bench, made once."""
    return Judge(BENCHES[name])
