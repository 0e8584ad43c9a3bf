"""Where and at which frequency: the residual cut into cells, each with a chi-square energy under white noise.

Every segment (samples in a row with the same run, channel, phase, cycle, position) gets an orthonormal cosine
transform (DCT-II; Ahmed, Natarajan and Rao, IEEE Trans. Comput. 23 (1974) 90), and its coefficients are sorted into
bands. The transform keeps sums of squares (Parseval), so cells are disjoint, cover everything, and the energy of a cell
of white noise is chi-square with as many degrees of freedom as it has coefficients.

The family of hypotheses "no excess here": every cell, and cells pooled over labels, scored on one scale.

An energy over its degrees of freedom is F distributed when the noise variance itself was estimated. Paulson's cube
root (Ann. Math. Stat. 13 (1942) 233), which is Wilson and Hilferty's (PNAS 17 (1931) 684) for a known variance, turns
it into a nearly normal score. The score only has to compare cells of unlike size: levels come from bootstrap draws.

The error of the whole family of cells, by a parametric bootstrap of their maximum.

Draws follow the null exactly: white noise, less the directions that refitted free nuisances take away, over a noise
variance that was itself estimated. They need no samples: in each cell the noise splits into its part along the
nuisances (normal) and the rest (chi-square).
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.fft import dct
from scipy.linalg import qr
from scipy.sparse import csr_array, eye_array, vstack

from geometry.arrays import Floats, Ints


@dataclass(frozen=True)
class TimeSegment:
    """Samples in a row that share all labels. step_s : their sampling step."""

    labels: Mapping[str, int]
    samples: slice
    step_s: float


@dataclass(frozen=True)
class Cell:
    """One segment in one band [low, high) Hz."""

    labels: Mapping[str, int]
    band_Hz: tuple[float, float]


def segments(labels: Mapping[str, Ints], step_s: Floats) -> tuple[TimeSegment, ...]:
    """Cut n samples wherever one of the labels (n,) or the sampling step (n,) changes.

    Steps must be the nominal ones of each even stretch: their jitter would cut everywhere.
    """
    columns = [np.asarray(column) for column in (*labels.values(), step_s)]
    changes = np.any([np.diff(column) != 0 for column in columns], axis=0)
    edges = [0, *(np.flatnonzero(changes) + 1).tolist(), len(step_s)]
    return tuple(
        TimeSegment({name: int(values[a]) for name, values in labels.items()}, slice(a, b), float(step_s[a]))
        for a, b in pairwise(edges)
    )


def octave_edges(duration_s: float, step_s: float) -> Floats:
    """Edges (k,) of octaves in Hz from below one turn in the duration up to half the sampling rate; the first is 0."""
    nyquist = 0.5 / step_s
    octaves = max(1, int(np.ceil(np.log2(nyquist * duration_s))))
    return np.concatenate([[0.0], nyquist * 2.0 ** np.arange(-octaves, 1)])


class CosineTransform:
    """Orthonormal coefficients (DCT-II) of pieces in a row, each by itself.

    Pieces of one length are transformed together, since a call takes longer than the transform of a short piece.
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
    """The transform from n samples to n coefficients and their sorting into cells.

    cells : in order. cell : (n,) the cell of each coefficient. degrees : (c,) coefficients in each cell.
    """

    def __init__(self, pieces: Sequence[TimeSegment], edges_Hz: Floats) -> None:
        """edges_Hz : (k,) ascending from 0; what lies above the last one joins the highest band."""
        self.pieces = tuple(pieces)
        self._transform = CosineTransform(self.pieces)
        cells: list[Cell] = []
        numbers: list[Ints] = []
        for piece in self.pieces:
            band = _bands(piece, edges_Hz)
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
        """Sum of squares (c,) in each cell of samples (n,)."""
        return np.asarray(np.bincount(self.cell, self.coefficients(values) ** 2, len(self.cells)), dtype=np.float64)


def _bands(piece: TimeSegment, edges_Hz: Floats) -> Ints:
    """The band of each coefficient of a segment: coefficient k of n has frequency k / (2 n step)."""
    count = piece.samples.stop - piece.samples.start
    frequency = np.arange(count) / (2.0 * count * piece.step_s)
    found = np.searchsorted(edges_Hz, frequency, side="right") - 1
    return np.asarray(np.clip(found, 0, len(edges_Hz) - 2), dtype=np.int64)


def pooled(cells: Sequence[Cell], over: Collection[str]) -> csr_array:
    """Membership (h, c), 0 or 1: sums over all cells that agree but for the labels (or "band_Hz") in `over`."""
    labels = [{**cell.labels, "band_Hz": cell.band_Hz} for cell in cells]
    keys = [tuple((name, value) for name, value in sorted(own.items()) if name not in over) for own in labels]
    groups = {key: number for number, key in enumerate(dict.fromkeys(keys))}
    rows = [groups[key] for key in keys]
    return csr_array((np.ones(len(cells)), (rows, np.arange(len(cells)))))


def with_pools(cells: Sequence[Cell], pools: Sequence[Collection[str]]) -> csr_array:
    """Membership of every cell by itself first, in order, then of each pooling."""
    return vstack([eye_array(len(cells), format="csr"), *(pooled(cells, over) for over in pools)], format="csr")


@dataclass(frozen=True)
class Hypotheses:
    """membership : (h, c) sparse, which cells each sums. degrees : (c,) of the cells.

    noise : (c,) number of the noise model of each cell. noise_degrees : (g,) degrees of freedom with which each noise
    variance was estimated, inf where it is known.
    """

    membership: csr_array
    degrees: Floats
    noise: Ints
    noise_degrees: Floats

    def scores(self, energies: Floats) -> Floats:
        """Scores (..., h) of cell energies (..., c), nearly standard normal without an excess."""
        degrees = self.membership @ self.degrees
        ratio = np.cbrt(energies @ self.membership.T / degrees)
        own, estimated = 2.0 / (9.0 * degrees), 2.0 / (9.0 * self._noise_degrees())
        return np.asarray(((1.0 - estimated) * ratio - (1.0 - own)) / np.sqrt(estimated * ratio**2 + own))

    def _noise_degrees(self) -> Floats:
        """Of each sum (h,): the relative variances of the noise models it uses, weighted (Satterthwaite 1946)."""
        parts = np.zeros((len(self.noise_degrees), len(self.degrees)))
        parts[self.noise, np.arange(len(self.degrees))] = self.degrees
        shares = np.asarray(self.membership @ parts.T)
        uncertain = (shares**2 / self.noise_degrees).sum(axis=1)
        return np.asarray(np.divide(shares.sum(axis=1) ** 2, uncertain, out=np.full(len(shares), np.inf),
                                    where=uncertain > 0.0))  # fmt: skip


def null_energies(hypotheses: Hypotheses, cell: Ints, free: Floats, draws: int, rng: np.random.Generator) -> Floats:
    """Cell energies (draws, c) of noise alone.

    cell : (n,) of each coefficient. free : (n, f) coefficients of the orthonormal directions of the free nuisances.
    """
    count = len(hypotheses.degrees)
    by_cell = free[np.argsort(cell, kind="stable")]
    roots = [_root(rows) for rows in np.split(by_cell, np.cumsum(np.bincount(cell))[:-1])]
    along = [rng.standard_normal((draws, len(root))) for root in roots]
    fitted = sum((part @ root for part, root in zip(along, roots, strict=True)), np.zeros((draws, free.shape[1])))
    energies = np.empty((draws, count))
    for c, (part, root) in enumerate(zip(along, roots, strict=True)):
        rest = hypotheses.degrees[c] - len(root)
        energies[:, c] = ((part - fitted @ root.T) ** 2).sum(axis=1)
        if rest > 0.0:
            energies[:, c] += rng.chisquare(rest, draws)
    return energies / _variances(hypotheses.noise_degrees, draws, rng)[:, hypotheses.noise]


def step_down(observed: Floats, null: Floats) -> Floats:
    """Family-wise p-values (h,) of scores (h,) given null draws (b, h) of all of them.

    Step-down maxT (Westfall and Young, Resampling-Based Multiple Testing, 1993, algorithm 4.1'; Ge, Dudoit and Speed,
    Test 12 (2003) 1). The smallest is the p-value of the maximum statistic. Counts include the observation (Phipson
    and Smyth, Stat. Appl. Genet. Mol. Biol. 9 (2010) 39): no p-value is below 1 / (b + 1).
    """
    order = np.argsort(observed)[::-1]
    largest_left = np.maximum.accumulate(null[:, order[::-1]], axis=1)[:, ::-1]
    exceeded = (1 + (largest_left >= observed[order]).sum(axis=0)) / (1 + len(null))
    adjusted = np.empty(len(observed))
    adjusted[order] = np.maximum.accumulate(exceeded)
    return adjusted


def _root(rows: Floats) -> Floats:
    """(min(d, f), f) with the same inner products as rows (d, f)."""
    return np.asarray(qr(rows, mode="economic")[1])


def _variances(degrees: Floats, draws: int, rng: np.random.Generator) -> Floats:
    """Estimates (draws, g) of a unit variance with these degrees of freedom (g,)."""
    known = np.isinf(degrees)
    estimated = np.ones((draws, len(degrees)))
    estimated[:, ~known] = rng.chisquare(degrees[~known], (draws, int((~known).sum()))) / degrees[~known]
    return estimated
