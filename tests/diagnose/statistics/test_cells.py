"""Cells: Parseval, chi-square energies, frequencies."""

import numpy as np
import pytest
from scipy.fft import dct
from scipy.stats import chi2, kstest

from diagnose.statistics.cells import FilterBank, octave_edges_Hz, time_segments
from diagnose.statistics.hypotheses import pool_membership

STEP_S = 0.01
RUN = np.repeat([0, 1], [300, 340])
PHASE = np.concatenate([np.repeat([1, 2, 3], 100), np.repeat([1, 2, 3], [120, 20, 200])])
PIECES = time_segments({"run": RUN, "phase": PHASE}, np.full(640, STEP_S))
BANK = FilterBank(PIECES, octave_edges_Hz(3.0, STEP_S))


def test_segments_are_cut_where_a_label_or_the_rate_changes():
    assert [p.samples.stop - p.samples.start for p in PIECES] == [100, 100, 100, 120, 20, 200]
    assert dict(PIECES[4].labels) == {"run": 1, "phase": 2}
    assert len(time_segments({"run": np.zeros(6, int)}, np.array([1.0, 1.0, 2.0, 2.0, 2.0, 2.0]))) == 2


def test_energies_add_up_to_the_sum_of_squares():
    values = np.random.default_rng(1).standard_normal(640)
    assert BANK.energies(values).sum() == pytest.approx(values @ values, rel=1e-13)
    assert BANK.degrees.sum() == 640
    assert BANK.degrees.min() >= 1


def test_the_transform_is_orthonormal():
    matrix = BANK.coefficients(np.eye(640))
    np.testing.assert_allclose(matrix @ matrix.T, np.eye(640), atol=1e-12)


def test_a_piece_shows_in_its_own_coefficients_alone():
    """Also where pieces of one length are transformed together."""
    values = np.random.default_rng(5).standard_normal((640, 2))
    for piece in PIECES:
        inside = np.zeros(640, bool)
        inside[piece.samples] = True
        found = BANK.coefficients(np.where(inside[:, None], values, 0.0))
        np.testing.assert_array_equal(found[~inside], 0.0)
        own = dct(values[piece.samples], norm="ortho", axis=0)
        np.testing.assert_allclose(found[inside], own, rtol=1e-12, atol=1e-13)


def test_white_noise_has_chi_square_energies():
    rng = np.random.default_rng(2)
    energies = np.array([BANK.energies(rng.standard_normal(640)) for _ in range(400)])
    p_values = [kstest(chi2.cdf(e, d), "uniform").pvalue for e, d in zip(energies.T, BANK.degrees, strict=True)]
    assert min(p_values) > 1e-3 / len(p_values)


def test_energies_of_different_cells_are_uncorrelated():
    rng = np.random.default_rng(3)
    energies = np.array([BANK.energies(rng.standard_normal(640)) for _ in range(400)])
    off = np.corrcoef(energies.T)[np.triu_indices(len(BANK.cells), 1)]
    assert np.abs(off).max() < 4.5 / np.sqrt(400)


def test_a_tone_shows_in_its_segment_and_band():
    """5 Hz in the unloading of run 1, with whole half-turns there; bands are octaves below 50 Hz."""
    time = STEP_S * np.arange(640)
    tone = np.where((RUN == 1) & (PHASE == 3), np.cos(2.0 * np.pi * 5.0 * (time - time[440] + 0.5 * STEP_S)), 0.0)
    energies = BANK.energies(tone)
    top = BANK.cells[int(np.argmax(energies))]
    assert dict(top.labels) == {"run": 1, "phase": 3}
    assert top.band_Hz[0] <= 5.0 < top.band_Hz[1]
    assert energies.max() == pytest.approx(tone @ tone, rel=1e-10)


def test_octaves_end_at_half_the_sampling_rate():
    edges = octave_edges_Hz(3.0, STEP_S)
    assert edges[0] == 0.0
    assert edges[-1] == 50.0
    np.testing.assert_allclose(edges[2:] / edges[1:-1], 2.0)
    assert 0.5 / 3.0 < edges[1] <= 1.0 / 3.0


def test_pooling_over_a_label_sums_its_cells():
    membership = pool_membership(BANK.cells, over={"run"}).toarray()
    values = np.random.default_rng(4).standard_normal(640)
    np.testing.assert_array_equal(membership.sum(axis=0), 1.0)
    assert len(membership) < len(BANK.cells)
    assert (membership @ BANK.energies(values)).sum() == pytest.approx(values @ values)
    for row in membership:
        assert len({(BANK.cells[n].labels["phase"], BANK.cells[n].band_Hz) for n in np.flatnonzero(row)}) == 1
    np.testing.assert_array_equal(pool_membership(BANK.cells, over={"run", "phase", "band_Hz"}).toarray(), 1.0)
