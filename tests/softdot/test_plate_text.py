"""Text into cells: the rules of Unified English Braille, and liblouis where it is installed."""

import shutil

import pytest

from foundation.errors import InputError
from softdot.braille_text.english import english_table
from softdot.braille_text.liblouis import liblouis
from softdot.braille_text.lines import translate
from tests.cases import for_each

# examples of The Rules of Unified English Braille, 2013: sections 4.1, 6.1-6.5, 7, 8.3-8.6
RULES = {
    "abcdefghijklmnopqrstuvwxyz": "⠁⠃⠉⠙⠑⠋⠛⠓⠊⠚⠅⠇⠍⠝⠕⠏⠟⠗⠎⠞⠥⠧⠺⠭⠽⠵",
    "1234567890": "⠼⠁⠃⠉⠙⠑⠋⠛⠓⠊⠚",
    "3.9": "⠼⠉⠲⠊",
    "8,093": "⠼⠓⠂⠚⠊⠉",
    ".7": "⠼⠲⠛",
    "4m": "⠼⠙⠍",
    "4b": "⠼⠙⠰⠃",
    "4B": "⠼⠙⠠⠃",
    "O'Neill": "⠠⠕⠄⠠⠝⠑⠊⠇⠇",
    "McDonald": "⠠⠍⠉⠠⠙⠕⠝⠁⠇⠙",
    "FBI": "⠠⠠⠋⠃⠊",
    "CDs": "⠠⠠⠉⠙⠠⠄⠎",
    "Well, (no) - yes!": "⠠⠺⠑⠇⠇⠂⠀⠐⠣⠝⠕⠐⠜⠀⠤⠀⠽⠑⠎⠖",
    "50%": "⠼⠑⠚⠨⠴",
    "⠿a⠿": "⠿⠁⠿",
}


@pytest.fixture(autouse=True)
def fresh_liblouis():
    """liblouis is looked for again in each test."""
    liblouis.cache_clear()
    yield
    liblouis.cache_clear()


@for_each(("text", "cells"), RULES.items())
def test_uncontracted_english(text, cells):
    assert translate(text).lines == (cells,)


def test_cells_follow_the_decades_of_braille():
    """The second ten letters are the first with dot 3, u to z but w with dots 3 and 6, digits are a to j."""
    letters, digits = english_table()["letters"], english_table()["digits"]
    for first, second in zip("abcdefghij", "klmnopqrst", strict=True):
        assert ord(letters[second]) == ord(letters[first]) | 0x04
    for first, third in zip("abcde", "uvxyz", strict=True):
        assert ord(letters[third]) == ord(letters[first]) | 0x24
    assert [digits[digit] for digit in "1234567890"] == [letters[letter] for letter in "abcdefghij"]


@for_each(
    ("text", "words"),
    [
        ("naïve", r"'ï' \(U\+00EF, latin small letter i with diaeresis\) at place 3"),
        ("ab\tc", r"^text: \(U\+0009, control character\) at place 3"),
        ("日本", r"'日' .* at place 1 .*liblouis.*apt-get install liblouis-bin.*--table"),
    ],
)
def test_a_character_without_a_cell_is_named_with_its_place_and_the_remedy(text, words):
    with pytest.raises(InputError, match=words):
        translate(text)


def test_lines_are_kept_and_broken_at_blanks_only():
    assert translate("ab\ncd").lines == ("⠁⠃", "⠉⠙")
    assert translate("ab cd ef", width_cells=5).lines == ("⠁⠃⠀⠉⠙", "⠑⠋")
    assert translate("a" * 40).lines == ("⠁" * 40,)
    with pytest.raises(InputError, match=r"line 2 has 41 cells, at most 40 .* break it by --width-cells"):
        translate("a\n" + "a" * 41)
    with pytest.raises(InputError, match="--width-cells = 3: the word ⠁⠃⠉⠙ has 4 cells"):
        translate("ab abcd", width_cells=3)


def fake_liblouis(folder, monkeypatch):
    """A lou_translate that says a version, knows one table and writes z for every letter."""
    program = folder / "lou_translate"
    program.write_text(
        "#!/bin/sh\n"
        'case "$*" in\n'
        '--version) echo "lou_translate (Liblouis) 9.8.7" ;;\n'
        "'--forward unicode.dis,known.ctb') sed -e 's/[a-z]/⠵/g' -e 's/中/⠄⡳⠭⠙⠑⠃⠙⠄/g' ;;\n"
        '*) echo "Cannot resolve table" >&2 ;;\n'
        "esac\n",
        "utf-8",
    )
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(folder), prepend=":")
    monkeypatch.setattr("softdot.braille_text.liblouis.find_spec", lambda _: None)


def test_a_table_is_given_to_liblouis(tmp_path, monkeypatch):
    fake_liblouis(tmp_path, monkeypatch)
    found = translate("abc\nd", "known.ctb")
    assert found.lines == ("⠵⠵⠵", "⠵")
    assert (found.table, found.liblouis) == ("known.ctb", "9.8.7")
    with pytest.raises(InputError, match=r"--table 'other.ctb': liblouis cannot use it"):
        translate("abc", "other.ctb")
    with pytest.raises(InputError, match=r"'中' \(U\+4E2D\) at place 2 is not in the liblouis table 'known.ctb'"):
        translate("a中", "known.ctb")


def test_a_table_without_liblouis_says_how_to_install_it(monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.setattr("softdot.braille_text.liblouis.find_spec", lambda _: None)
    with pytest.raises(InputError, match=r"--table 'en-ueb-g2.ctb': liblouis is not installed; .*apt-get install"):
        translate("abc", "en-ueb-g2.ctb")


@pytest.mark.skipif(shutil.which("lou_translate") is None, reason="liblouis is not installed")
@pytest.mark.parametrize("text", [text for text in RULES if "⠿" not in text])
def test_liblouis_translates_alike(text):
    assert translate(text, "en-ueb-g1.ctb").lines == translate(text).lines


@pytest.mark.skipif(shutil.which("lou_translate") is None, reason="liblouis is not installed")
def test_liblouis_contracts():
    assert translate("the knowledge", "en-ueb-g2.ctb").lines == ("⠮⠀⠅",)
