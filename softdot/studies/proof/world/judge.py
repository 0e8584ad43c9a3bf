"""How large an effect is against the noise, once every declared nuisance has taken its part; how far from rivals.

Signals are whitened by the true noise. With the sensitivities T to the nuisances, scaled by their widths, an effect e
keeps e' (1 + T T')^-1 e of its energy: the least of |e - T x|^2 + |x|^2.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.reality import Reality, Signals, baseline, channels, keys, noise_law, noise_of, record
from softdot.studies.proof.world.rigs import BENCHES


def whiten(signals: Sequence[Signals], bench: Bench) -> Floats:
    """Answers of all runs, one after the other, in units of the innovations of their noise."""
    sigma = noise_of(bench)
    parts = [noise_law(name).whiten(run[name]) / sigma[name] for run in signals for name in channels(bench)]
    return np.concatenate(parts)


@dataclass(frozen=True)
class Judge:
    """Measures effects on a bench; its nuisances are those of what the experimenter believes."""

    bench: Bench

    @cached_property
    def _tangents(self) -> Floats:
        """Changes (t, k) of the signals by the nuisances, by secants over one sigma."""
        belief = baseline(self.bench)
        base, columns = whiten(record(belief, self.bench), self.bench), []
        for name, width in self.bench.nuisance:
            for key in keys(name, self.bench):
                there = record(replace(belief, nuisance={key: width}), self.bench)
                columns.append(whiten(there, self.bench) - base)
        return np.stack(columns, axis=1)

    @cached_property
    def _half(self) -> tuple[Floats, Floats]:
        """Directions (t, k) and factors (k,) of (1 + T T')^-1/2 - 1."""
        left, values, _ = np.linalg.svd(self._tangents, full_matrices=False)
        return left, 1.0 / np.sqrt(1.0 + values**2) - 1.0

    def residual(self, reality: Reality, without: Reality) -> Floats:
        """Difference (t,) between two realities that nuisances cannot explain."""
        effect = whiten(record(reality, self.bench), self.bench) - whiten(record(without, self.bench), self.bench)
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
    """Share of the energy of an effect, (label of run, channel) -> share."""
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
