"""Relaxation of a whole history of the stress at one material point, by scans over time.

The formulas are those of solve.materials.inelastic, scanned over a history instead of stepped: tests hold both ways
together.
"""

from dataclasses import dataclass
from functools import lru_cache

import numba as nb
import numpy as np

from foundation.arrays import Floats
from solve.compiled import piece
from solve.materials.prony import Prony, branch_stress

NO_SERIES = Prony((), ())


@dataclass(frozen=True)
class Relaxation:
    """A Prony series of b branches at t times, at rest before the first sample.

    moduli : g_i (b,); fade : exp(-a), gain : (1 - exp(-a)) / a with a = dt / tau_i, (t, b), dt = 0 at first.
    """

    moduli: Floats
    fade: Floats
    gain: Floats

    @classmethod
    def from_series(cls, series: Prony, time_s: Floats) -> "Relaxation":
        """Relaxation by a Prony series at times (t,) in s."""
        fade, gain = _decay(series.relaxation_times, time_s.tobytes())
        return cls(np.array(series.relative_moduli, dtype=np.float64), fade, gain)

    @property
    def instantaneous_stiffness(self) -> Floats:
        """Derivative (t,) of the stress by the elastic stress at the same time."""
        return np.asarray(1.0 - self.moduli.sum() + self.gain @ self.moduli)

    def relaxed_stress(self, elastic: Floats, cauchy_green: Floats | None = None) -> Floats:
        """Stress (t, c) after the history (t, c) of the elastic stress; the strain does not matter."""
        return np.asarray(_relaxed_stress(elastic, self.moduli, self.fade, self.gain))

    def newton_step(
        self, residual: Floats, by_stress: Floats, stress_by: Floats, by_unknown: Floats, cauchy_green: Floats,
        strain_by: Floats,
    ) -> Floats:  # fmt: skip
        """Correction (t, m) of the unknowns that makes residual (t, m) vanish, memory included.

        by_stress (t, m, c) : derivative of the residual by the stress; stress_by (t, c, m) : of the elastic stress by
        the unknowns; by_unknown (t, m, m) : of the residual by the unknowns at fixed stress. The strain does not
        matter.
        """
        return np.asarray(_newton_step(residual, by_stress, stress_by, by_unknown, self.moduli, self.fade, self.gain))


@lru_cache(maxsize=64)
def _decay(relaxation_times: tuple[float, ...], clock: bytes) -> tuple[Floats, Floats]:
    """Fade and gain (t, b) of branches at times (t,), cached since fits change the moduli alone."""
    time_s = np.frombuffer(clock)
    return Prony((), relaxation_times).decay(np.diff(time_s, prepend=time_s[0]))


@nb.njit(cache=True)
def _relaxed_stress(elastic, moduli, fade, gain):  # type: ignore[no-untyped-def]
    samples, parts = elastic.shape
    branches = np.zeros((len(moduli), parts))
    stress = np.empty_like(elastic)
    rest = 1.0 - moduli.sum()
    for t in range(samples):
        for c in range(parts):
            change = elastic[t, c] - (elastic[t - 1, c] if t > 0 else 0.0)
            stress[t, c] = rest * elastic[t, c]
            for b in range(len(moduli)):
                branches[b, c] = branch_stress(branches[b, c], fade[t, b], moduli[b] * gain[t, b], change)
                stress[t, c] += branches[b, c]
    return stress


@nb.njit(cache=True)
def _newton_step(residual, by_stress, stress_by, by_unknown, moduli, fade, gain):  # type: ignore[no-untyped-def]
    """Newton's correction (t, m) by forward substitution in time.

    The correction of a sample depends on those before through the branches.
    """
    samples, size = residual.shape
    parts = stress_by.shape[1]
    branches, old, new = np.zeros((len(moduli), parts)), np.zeros(parts), np.zeros(parts)
    matrix, right, step = np.empty((size, size)), np.empty(size), np.empty_like(residual)
    for t in range(samples):
        instant = 1.0 - moduli.sum()
        for b in range(len(moduli)):
            instant += moduli[b] * gain[t, b]
        for i in range(size):
            right[i] = -residual[t, i]
            for c in range(parts):
                for b in range(len(moduli)):
                    right[i] -= by_stress[t, i, c] * (fade[t, b] * branches[b, c] - moduli[b] * gain[t, b] * old[c])
            for j in range(size):
                matrix[i, j] = by_unknown[t, i, j]
                for c in range(parts):
                    matrix[i, j] += instant * by_stress[t, i, c] * stress_by[t, c, j]
        solve_small_system(matrix, right, step[t])
        for c in range(parts):
            new[c] = 0.0
            for j in range(size):
                new[c] += stress_by[t, c, j] * step[t, j]
            for b in range(len(moduli)):
                branches[b, c] = branch_stress(branches[b, c], fade[t, b], moduli[b] * gain[t, b], new[c] - old[c])
            old[c] = new[c]
    return step


@piece()
def solve_small_system(matrix, right, out):  # type: ignore[no-untyped-def]
    """Solve matrix (m, m) x = right (m,) for one or two unknowns, into out (m,)."""
    if len(right) == 1:
        out[0] = right[0] / matrix[0, 0]
    else:
        determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
        out[0] = (right[0] * matrix[1, 1] - right[1] * matrix[0, 1]) / determinant
        out[1] = (right[1] * matrix[0, 0] - right[0] * matrix[1, 0]) / determinant
