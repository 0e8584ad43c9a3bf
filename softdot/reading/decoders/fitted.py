"""Least squares of the dots of several cells: amplitudes, and which of them are raised.

The voltages are a sum of templates with unknown amplitudes a, V = sum a_k T_k + noise. For white noise
    a = G^-1 c,   G_kl = <T_k, T_l>,   c_k = <V, T_k>.
Raised dots share one amplitude, the gain g, others have none: a_k = g b_k with b_k in {0, 1}. For known b the squares
are least for g = b.c / b.G b, and smaller by (b.c)^2 / b.G b than without any dot: what the dots explain.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from foundation.arrays import Floats, Ints
from softdot.reading.cells import DOTS
from softdot.reading.decoders.templates import DotTemplates, LagSpline, Posture
from softdot.reading.line import cell_pitch_mm, dot_places_mm
from softdot.reading.voltages import Reader, Voltages

RIDGE_SHARE = 1e-3
"""Ridge as a share of the mean diagonal of G: templates of far rows are nearly alike where the crosstalk is large."""
RAISED_SHARE, GAIN_ROUNDS = 0.5, 2
"""Share of the gain above which a dot counts as raised, and how often gain and dots are found in turn."""


@dataclass(frozen=True)
class CellFit:
    """Templates of one posture on some voltages, and their products. lag_mm (6,) : way of the array's middle from the
    middle of a cell to each of its dots.
    """

    templates: DotTemplates
    overlap: LagSpline
    matched: LagSpline
    lag_mm: Floats
    pitch_mm: float

    @property
    def pitch_s(self) -> float:
        """Time from cell to cell, s."""
        return self.pitch_mm / self.templates.posture.speed_mm_per_s

    @property
    def lag_s(self) -> Floats:
        """Times (6,) at which the dots are passed, after the middle of their cell, s."""
        return self.lag_mm / self.templates.posture.speed_mm_per_s

    def products(self, middles_s: Floats) -> Floats:
        """Products c (..., 6) of cells that are passed at these times."""
        return self.matched.at(np.asarray(middles_s)[..., None] + self.lag_s, _row_of_dots())

    def blocks(self, most: int) -> Floats:
        """Blocks of G between a cell and itself, the next one and so on, (most + 1, 6, 6)."""
        later = (
            self.pitch_s * np.arange(most + 1)[:, None, None] + self.lag_s[None, None, :] - self.lag_s[None, :, None]
        )
        return self.overlap.at(later, _row_of_dots()[:, None], _row_of_dots()[None, :])

    def matrix(self, count: int) -> Floats:
        """The matrix G (6 count, 6 count) of neighbouring cells, with its ridge."""
        blocks = self.blocks(count - 1)
        whole = np.zeros((count, DOTS, count, DOTS))
        for distance in range(count):
            for i in range(count - distance):
                whole[i, :, i + distance, :] = blocks[distance]
                whole[i + distance, :, i, :] = blocks[distance].T
        matrix = whole.reshape(count * DOTS, count * DOTS)
        return np.asarray(matrix + RIDGE_SHARE * np.mean(np.diag(matrix)) * np.eye(len(matrix)))


@dataclass(frozen=True)
class Track:
    """The track of a slide over a line.

    passed_s (c,) : time at which the array's middle passes each cell. fit : that of the voltages heard, which are means
    of `many` samples each.
    """

    fit: CellFit
    heard: Voltages
    many: int
    passed_s: Floats

    @property
    def posture(self) -> Posture:
        """Speed, offset and yaw of the array."""
        return self.fit.templates.posture

    def place_mm(self, time_s: Floats) -> Floats:
        """Place (t,) of the array's middle from that of the first cell; beyond the ends it moves at the mean speed."""
        pitch, passed = self.fit.pitch_mm, self.passed_s
        speed = self.posture.speed_mm_per_s
        inside = np.interp(time_s, passed, pitch * np.arange(len(passed)))
        before, behind = np.minimum(time_s - passed[0], 0.0), np.maximum(time_s - passed[-1], 0.0)
        return np.asarray(inside + speed * (before + behind))


def cell_fit(reader: Reader, templates: DotTemplates, heard: Voltages) -> CellFit:
    """The fit of voltages whose samples are as far apart as those of the templates."""
    places = dot_places_mm(reader.standard)[:, 0]
    return CellFit(templates, templates.overlap(), templates.match(heard), places, cell_pitch_mm(reader.standard))


def explained_squares(matrix: Floats, products: Floats) -> tuple[Floats, Floats]:
    """Squares that the dots explain (m,), and whether each is raised (m, k), for products c (m, k) of several places.

    Amplitudes above half of the gain count as raised; the gain is first the mean of the amplitudes, weighted by
    themselves.
    """
    amplitude = cho_solve(cho_factor(matrix), products.T).T
    positive = np.maximum(amplitude, 0.0)
    gain = (positive**2).sum(axis=1) / np.maximum(positive.sum(axis=1), 1e-300)
    best = np.zeros(len(products))
    for _ in range(GAIN_ROUNDS):
        raised = (amplitude > RAISED_SHARE * gain[:, None]).astype(np.float64)
        along = np.einsum("mk,mk->m", raised, products)
        square = np.maximum(np.einsum("mk,kl,ml->m", raised, matrix, raised, optimize=True), 1e-300)
        gain = np.maximum(along, 0.0) / square
        best = np.maximum(along, 0.0) ** 2 / square
    return best, raised


def _row_of_dots() -> Ints:
    """Row of each of the six dots, (6,)."""
    return np.arange(DOTS) % 3
