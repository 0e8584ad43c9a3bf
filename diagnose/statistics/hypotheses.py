"""The family of hypotheses "no excess here": every cell, and cells pooled over labels, scored on one scale.

An energy over its degrees of freedom is F distributed when the noise variance itself was estimated. Paulson's cube
root (Ann. Math. Stat. 13 (1942) 233), which is Wilson and Hilferty's (PNAS 17 (1931) 684) for a known variance, turns
it into a nearly normal score. The score only has to compare cells of unlike size: levels come from bootstrap draws.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, eye_array, vstack

from diagnose.statistics.cells import Cell
from foundation.arrays import Floats, Ints


def pool_membership(cells: Sequence[Cell], over: Collection[str]) -> csr_array:
    """Sparse matrix (h, c) of 0 and 1 that sums c cells to h pools: all that agree but for the labels in `over`.

    The name "band_Hz" in `over` stands for the band of a cell.
    """
    labels = [{**cell.labels, "band_Hz": cell.band_Hz} for cell in cells]
    keys = [tuple((name, value) for name, value in sorted(own.items()) if name not in over) for own in labels]
    groups = {key: number for number, key in enumerate(dict.fromkeys(keys))}
    rows = [groups[key] for key in keys]
    return csr_array((np.ones(len(cells)), (rows, np.arange(len(cells)))))


def membership_with_pools(cells: Sequence[Cell], pools: Sequence[Collection[str]]) -> csr_array:
    """Sparse matrix (h, c) of every cell by itself first, in order, then of the pools of each pooling."""
    return vstack(
        [eye_array(len(cells), format="csr"), *(pool_membership(cells, over) for over in pools)], format="csr"
    )


@dataclass(frozen=True)
class Hypotheses:
    """Hypotheses "no excess here" on sums over cells. membership : (h, c) sparse, which cells each sums.

    degrees : (c,) degrees of freedom of the cells. noise : (c,) number of the noise model of each cell. noise_degrees :
    (g,) degrees of freedom with which each noise variance was estimated, inf where it is known.
    """

    membership: csr_array
    degrees: Floats
    noise: Ints
    noise_degrees: Floats

    def scores(self, energies: Floats) -> Floats:
        """Scores (..., h) of cell energies (..., c), nearly standard normal without an excess."""
        degrees = self.membership @ self.degrees
        ratio = np.cbrt(energies @ self.membership.T / degrees)
        own, estimated = 2.0 / (9.0 * degrees), 2.0 / (9.0 * self._pooled_noise_degrees())
        return np.asarray(((1.0 - estimated) * ratio - (1.0 - own)) / np.sqrt(estimated * ratio**2 + own))

    def _pooled_noise_degrees(self) -> Floats:
        """Degrees of freedom (h,) of the estimated noise variance of each sum (Satterthwaite 1946).

        The relative variances of the noise models that a sum uses are weighted by its cells.
        """
        parts = np.zeros((len(self.noise_degrees), len(self.degrees)))
        parts[self.noise, np.arange(len(self.degrees))] = self.degrees
        shares = np.asarray(self.membership @ parts.T)
        uncertain = (shares**2 / self.noise_degrees).sum(axis=1)
        return np.asarray(np.divide(shares.sum(axis=1) ** 2, uncertain, out=np.full(len(shares), np.inf),
                                    where=uncertain > 0.0))  # fmt: skip
