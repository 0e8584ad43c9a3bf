"""The residual cut into cells of time and frequency, each with a chi-square energy under white noise.

Every segment (samples in a row with the same run, channel, phase, cycle, position) gets an orthonormal cosine transform
(DCT-II; Ahmed, Natarajan and Rao, IEEE Trans. Comput. 23 (1974) 90), and its coefficients are sorted into bands. The
transform keeps sums of squares (Parseval), so cells are disjoint, cover everything, and the energy of a cell of white
noise is chi-square with as many degrees of freedom as it has coefficients.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.fft import dct

from foundation.arrays import Floats, Ints


@dataclass(frozen=True)
class TimeSegment:
    """Samples in a row that share all labels. step_s : their sampling step."""

    labels: Mapping[str, int]
    samples: slice
    step_s: float


@dataclass(frozen=True)
class Cell:
    """One time segment in one band [low, high) Hz."""

    labels: Mapping[str, int]
    band_Hz: tuple[float, float]


def time_segments(labels: Mapping[str, Ints], step_s: Floats) -> tuple[TimeSegment, ...]:
    """Time segments of n samples, cut wherever one of the labels (n,) or the sampling step (n,) changes.

    Steps must be the nominal ones of each even stretch: their jitter would cut everywhere.
    """
    columns = [np.asarray(column) for column in (*labels.values(), step_s)]
    changes = np.any([np.diff(column) != 0 for column in columns], axis=0)
    edges = [0, *(np.flatnonzero(changes) + 1).tolist(), len(step_s)]
    return tuple(
        TimeSegment({name: int(values[a]) for name, values in labels.items()}, slice(a, b), float(step_s[a]))
        for a, b in pairwise(edges)
    )


def octave_edges_Hz(duration_s: float, step_s: float) -> Floats:
    """Edges (k,) of octaves in Hz from below one turn in the duration up to half the sampling rate; the first is 0."""
    nyquist = 0.5 / step_s
    octaves = max(1, int(np.ceil(np.log2(nyquist * duration_s))))
    return np.concatenate([[0.0], nyquist * 2.0 ** np.arange(-octaves, 1)])


class CosineTransform:
    """Orthonormal cosine transform (DCT-II) of successive time segments, each by itself.

    Segments of one length are transformed together, since a call takes longer than the transform of a short one.
    """

    def __init__(self, pieces: Sequence[TimeSegment]) -> None:
        lengths = np.array([piece.samples.stop - piece.samples.start for piece in pieces])
        first = np.cumsum(lengths) - lengths
        self._alike = [first[lengths == count][:, None] + np.arange(count) for count in np.unique(lengths)]

    def __call__(self, values: Floats) -> Floats:
        """Coefficients (n, ...) of samples (n, ...)."""
        found = np.empty(values.shape)
        for rows in self._alike:
            found[rows] = dct(values[rows], type=2, norm="ortho", axis=1)
        return found


class FilterBank:
    """Cosine transform from n samples to n coefficients, and their sorting into c cells.

    cells : in order. cell : (n,) number of the cell of each coefficient. degrees : (c,) number of coefficients in each
    cell.
    """

    def __init__(self, pieces: Sequence[TimeSegment], edges_Hz: Floats) -> None:
        """Sort the coefficients of time segments.

        edges_Hz : (k,) from 0 up; what lies above the last joins the highest band.
        """
        self.pieces = tuple(pieces)
        self._transform = CosineTransform(self.pieces)
        cells: list[Cell] = []
        numbers: list[Ints] = []
        for piece in self.pieces:
            band = _band_numbers(piece, edges_Hz)
            present, own = np.unique(band, return_inverse=True)
            numbers.append(own + len(cells))
            cells += [Cell(piece.labels, (float(edges_Hz[b]), float(edges_Hz[b + 1]))) for b in present]
        self.cells = tuple(cells)
        self.cell = np.concatenate(numbers)
        self.degrees = np.bincount(self.cell).astype(float)

    def coefficients(self, values: Floats) -> Floats:
        """Orthonormal coefficients (n,) or (n, k) of samples (n,) or (n, k)."""
        return self._transform(values)

    def energies(self, values: Floats) -> Floats:
        """Sums of squares (c,) over the coefficients of each cell, of samples (n,)."""
        return np.asarray(np.bincount(self.cell, self.coefficients(values) ** 2, len(self.cells)), dtype=np.float64)


def _band_numbers(piece: TimeSegment, edges_Hz: Floats) -> Ints:
    """Number of the band of each coefficient of a time segment: coefficient k of n has frequency k / (2 n step)."""
    count = piece.samples.stop - piece.samples.start
    frequency = np.arange(count) / (2.0 * count * piece.step_s)
    found = np.searchsorted(edges_Hz, frequency, side="right") - 1
    return np.asarray(np.clip(found, 0, len(edges_Hz) - 2), dtype=np.int64)
