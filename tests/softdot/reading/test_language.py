"""Words of a language beside what voltages say of cells."""

from itertools import product

import numpy as np
import pytest

from softdot.braille_text.words import Words, words_of
from softdot.cli import main
from softdot.reading.cells import cells_of
from softdot.reading.language import UNLISTED, complete

A, B, C = 1, 3, 9
FEW = Words(
    {1: (np.array([[A]]), np.array([0.3])), 2: (np.array([[A, B], [B, C]]), np.array([0.5, 0.2]))},
    np.bincount([A, B, C], [0.4, 0.4, 0.2], 64),
)


def weight(line, shares):
    """Of a line of words with blanks between them, by hand."""
    total = float(np.prod(shares[np.arange(len(line)), line]))
    for word in "".join(map(chr, line)).split(chr(0)):
        cells = [ord(one) for one in word]
        listed = {tuple(own): share for own, share in zip(*FEW.by_length.get(len(cells), ((), ())), strict=True)}
        unlisted = UNLISTED * np.prod(FEW.letters[cells])
        total *= (1.0 - UNLISTED) * listed.get(tuple(cells), 0.0) + unlisted if cells else 1.0
    return total


def test_the_probability_of_a_cell_is_that_of_all_lines_with_it():
    shares = np.full((4, 64), 1e-4)
    shares[:, [0, A, B, C]] += np.random.default_rng(3).dirichlet(np.ones(4), 4)
    shares /= shares.sum(axis=1, keepdims=True)
    lines = {line: weight(line, shares) for line in product((0, A, B, C), repeat=4)}
    found = complete(shares.argmax(axis=1), shares, np.zeros(4, dtype=bool), FEW, 0.9)
    for place in range(4):
        each = [sum(w for line, w in lines.items() if line[place] == cell) for cell in (0, A, B, C)]
        assert found.cells[place] == (0, A, B, C)[int(np.argmax(each))]
        assert found.probability[place] == pytest.approx(max(each) / sum(lines.values()), rel=1e-9)


def test_words_complete_what_is_uncertain_and_leave_what_is_certain():
    true = cells_of("the baby was qxzt 42")
    certain = np.ones(len(true), dtype=bool)
    certain[[1, 7, 14, 18]] = False  # of the, baby, qxzt and 42
    shares = np.where(certain[:, None], np.eye(64)[true], 1.0 / 64.0)
    shares[1, cells_of("j")[0]] = 0.5  # what voltages alone take for likelier
    found = complete(shares.argmax(axis=1), shares / shares.sum(axis=1, keepdims=True), certain, words_of("en"), 0.9)
    np.testing.assert_array_equal(found.cells[certain], true[certain])
    assert found.completed.nonzero()[0].tolist() == [1, 7]
    np.testing.assert_array_equal(found.cells[[1, 7]], true[[1, 7]])
    assert not complete(true, np.eye(64)[true], np.zeros(len(true), dtype=bool), words_of("en"), 0.9).completed.any()


def test_a_language_that_cannot_act_is_refused_by_name(kernel_folder, tmp_path, capfd):
    for more, said in (
        (["--decoders", "model", "--language", "en"], "--language = 'en': acts on what the decoder hand reads"),
        (["--decoders", "hand", "--language", "fr"], "--language = 'fr': is not known, allowed are en, de"),
        (["--decoders", "hand", "--language", "de"], "--language = 'de': needs a table of liblouis"),
        (["--language", "en", "--study"], "--language = 'en': acts only on a line that is read"),
    ):
        assert main(["read", "dot", "--kernel", str(kernel_folder), "-o", str(tmp_path / "out"), *more]) == 2
        assert said in capfd.readouterr().err
        assert not (tmp_path / "out").exists()
