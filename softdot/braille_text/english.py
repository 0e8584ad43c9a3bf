"""Text to uncontracted English Braille cells, by the table english.toml."""

import re
import tomllib
import unicodedata
from functools import cache
from importlib.resources import files
from typing import Any

from foundation.errors import InputError

# a number with its points and commas; letters; Braille; anything else, one by one
TEXT_TOKEN = re.compile(r"(?:(?<![A-Za-z])\.)?[0-9][0-9.,]*|[A-Za-z]+|[\u2800-\u28ff]+|.", re.DOTALL)
DIGIT = re.compile("[0-9]")
"""Digits with cells in the table; others that Unicode calls so, such as \u00b2 or \u0663, have none."""
CAPITALS_OR_LETTERS = re.compile(r"[A-Z]+|[a-z]+")


def english_cells(text: str, advice: str) -> str:
    """One line of text as Unicode Braille cells; Braille characters pass through unchanged.

    InputError, which names the character, its place and then the advice, for a character that the table lacks.
    """
    cells, table = "", english_table()
    for token in TEXT_TOKEN.finditer(text):
        word, follows = token.group(), text[token.end() : token.end() + 1]
        if DIGIT.search(word):
            cells += _number(word, follows, table)
        elif word.isascii() and word.isalpha():
            cells += _letters(word, table)
        elif "\u2800" <= word[0] <= "\u28ff":
            cells += word
        elif word in table["signs"]:
            cells += table["signs"][word]
        else:
            raise InputError(
                f"text: {_character_name(word)} at place {token.start() + 1} is not in {table['name']}; {advice}"
            )
    return cells


@cache
def english_table() -> dict[str, Any]:
    """Cells of letters, digits, signs and indicators, with name and source."""
    return tomllib.loads(files(__package__).joinpath("english.toml").read_text("utf-8"))


def _number(number: str, follows: str, table: dict[str, Any]) -> str:
    """Digits behind the number sign; a letter from a to j that follows gets a sign, since it would read as a digit."""
    signs = table["indicators"]
    cells = "".join(table["digits"].get(character) or table["signs"][character] for character in number)
    return f"{signs['number']}{cells}{signs['letter'] if follows and follows in 'abcdefghij' else ''}"


def _letters(word: str, table: dict[str, Any]) -> str:
    """Letters, with a sign before one capital, or before and behind several."""
    signs, cells = table["indicators"], ""
    for run in CAPITALS_OR_LETTERS.finditer(word):
        letters = run.group()
        if letters.isupper():
            cells += signs["capital"] if len(letters) == 1 else signs["capital_word"]
        cells += "".join(table["letters"][letter] for letter in letters.lower())
        if letters.isupper() and len(letters) > 1 and run.end() < len(word):
            cells += signs["capitals_end"]
    return cells


def _character_name(character: str) -> str:
    """A character with its code and its Unicode name, for a message."""
    name = unicodedata.name(character, "control character")
    shown = f"'{character}' " if character.isprintable() else ""
    return f"{shown}(U+{ord(character):04X}, {name.lower()})"
