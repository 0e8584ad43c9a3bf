"""What is asked of softdot plate: a text in Braille cells (plain English, or liblouis), and its solid."""

import re
import shutil
import subprocess
import tomllib
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from typing import Any, Literal, get_args

from geometry.base import InputError
from geometry.braille_standards import QuantityName
from geometry.plates.braille_sizes import BrailleSizes, braille_sizes, require_length
from geometry.plates.height_series import HEIGHTS_MM, height_series
from geometry.plates.indenter import THREADS, indenter_tip
from geometry.plates.plate import THICKNESS_MM, Plate
from geometry.plates.text_plate import MARGIN_MM, text_plate

# a number with its points and commas; letters; Braille; anything else, one by one
TOKEN = re.compile(r"(?:(?<![A-Za-z])\.)?[0-9][0-9.,]*|[A-Za-z]+|[\u2800-\u28ff]+|.", re.DOTALL)
DIGIT = re.compile("[0-9]")
"""Of the table: other characters that Unicode calls digits, such as \u00b2 or \u0663, have no cells here."""
CAPITALS = re.compile(r"[A-Z]+|[a-z]+")


def english_cells(text: str, advice: str) -> str:
    """One line of text as Unicode Braille cells; Braille characters pass through as they are.

    InputError, which names the character, its place and then the advice, for what the table does not hold.
    """
    cells, table = "", english_table()
    for token in TOKEN.finditer(text):
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
            raise InputError(f"text: {_named(word)} at place {token.start() + 1} is not in {table['name']}; {advice}")
    return cells


@cache
def english_table() -> dict[str, Any]:
    """Cells of letters, digits, signs and indicators, with name and source."""
    return tomllib.loads(files(__package__).joinpath("english.toml").read_text("utf-8"))


def _number(number: str, follows: str, table: dict[str, Any]) -> str:
    """Digits behind the number sign; a letter from a to j that follows would read as a digit without a sign."""
    signs = table["indicators"]
    cells = "".join(table["digits"].get(character) or table["signs"][character] for character in number)
    return f"{signs['number']}{cells}{signs['letter'] if follows and follows in 'abcdefghij' else ''}"


def _letters(word: str, table: dict[str, Any]) -> str:
    """Letters with a sign before one capital, or before and behind several."""
    signs, cells = table["indicators"], ""
    for run in CAPITALS.finditer(word):
        letters = run.group()
        if letters.isupper():
            cells += signs["capital"] if len(letters) == 1 else signs["capital_word"]
        cells += "".join(table["letters"][letter] for letter in letters.lower())
        if letters.isupper() and len(letters) > 1 and run.end() < len(word):
            cells += signs["capitals_end"]
    return cells


def _named(character: str) -> str:
    """The character with its code and its Unicode name."""
    name = unicodedata.name(character, "control character")
    shown = f"'{character}' " if character.isprintable() else ""
    return f"{shown}(U+{ord(character):04X}, {name.lower()})"


INSTALL = (
    "liblouis translates contracted Braille and other languages: install it (Debian and Ubuntu 'apt-get install "
    "liblouis-bin', Fedora 'dnf install liblouis-utils', macOS 'brew install liblouis') and name a table, "
    "such as --table en-ueb-g2.ctb"
)
DISPLAY = "unicode.dis"
UNKNOWN = re.compile("⠄⡳⠭[⠀-⣿]*?⠄")
"""What liblouis writes for a character that its table lacks: the Braille of '\\xhhhh'."""
TIMEOUT_S = 60


@dataclass(frozen=True)
class Translator:
    """How liblouis is called: its Python binding or its program; version as it says."""

    called_by: str
    version: str


@cache
def liblouis() -> Translator | None:
    """The liblouis of this machine, or None."""
    binding = find_spec("louis")
    if binding is not None and binding.origin:  # without origin: some folder of that name
        import louis  # type: ignore[import-not-found]

        return Translator("louis", str(louis.version()))
    program = shutil.which("lou_translate")
    if program is None:
        return None
    said = subprocess.run([program, "--version"], capture_output=True, encoding="utf-8", timeout=TIMEOUT_S, check=False)
    found = re.search(r"\d+(\.\d+)+", said.stdout + said.stderr)
    return Translator(program, found.group() if found else "unknown")


def louis_cells(text: str, table: str) -> str:
    """One line of text as Unicode Braille cells by a table of liblouis.

    InputError without liblouis, for a table that it does not know, and for characters that the table lacks.
    """
    translator = liblouis()
    if translator is None:
        raise InputError(f"--table '{table}': liblouis is not installed; {INSTALL}")
    cells = _translate(translator, text, table)
    if UNKNOWN.search(cells):
        lacking = [c for c in dict.fromkeys(text) if UNKNOWN.search(_translate(translator, c, table))]
        shown = ", ".join(f"'{c}' (U+{ord(c):04X}) at place {text.index(c) + 1}" for c in lacking)
        raise InputError(f"text: {shown} is not in the liblouis table '{table}'; choose another table by --table")
    return cells


def _translate(translator: Translator, text: str, table: str) -> str:
    if translator.called_by == "louis":
        return _by_binding(text, table)
    tables = f"{DISPLAY},{table}"
    done = subprocess.run(
        [translator.called_by, "--forward", tables], input=text, capture_output=True, timeout=TIMEOUT_S,
        encoding="utf-8", check=False,
    )  # fmt: skip
    cells = done.stdout.rstrip("\n")
    if done.returncode or (text and not cells):
        raise _unknown_table(table)
    return cells


def _by_binding(text: str, table: str) -> str:
    import louis

    try:
        return str(louis.translateString([DISPLAY, table], text))
    except RuntimeError:
        raise _unknown_table(table) from None


def _unknown_table(table: str) -> InputError:
    return InputError(f"--table '{table}': liblouis cannot use it; name one of its tables, such as en-ueb-g2.ctb")


LONGEST_LINE = 40
"""Cells on a line of a Braille page; a longer line is broken only when asked."""
BLANK = "\u2800"


@dataclass(frozen=True)
class Translation:
    """Lines of Unicode Braille cells; table : what they were translated by; liblouis : its version, if used."""

    lines: tuple[str, ...]
    table: str
    liblouis: str | None


def translate(text: str, table: str | None = None, width_cells: int | None = None) -> Translation:
    """Translate line by line; lines longer than width_cells are broken at blanks. InputError."""
    rows = text.strip("\n").split("\n")
    if table is None:
        lines = [english_cells(row, INSTALL) for row in rows]
        return Translation(_fit(lines, width_cells), english_table()["name"], None)
    lines = [louis_cells(row, table) for row in rows]
    found = liblouis()
    return Translation(_fit(lines, width_cells), table, found.version if found else None)


def _fit(lines: list[str], width_cells: int | None) -> tuple[str, ...]:
    stripped = [line.rstrip(BLANK) for line in lines]
    if width_cells is not None:
        return tuple(part for line in stripped for part in _broken(line, width_cells))
    for number, line in enumerate(stripped, 1):
        if len(line) > LONGEST_LINE:
            raise InputError(
                f"text: line {number} has {len(line)} cells, at most {LONGEST_LINE} are allowed on a line; "
                f"break it by --width-cells N"
            )
    return tuple(stripped)


def _broken(line: str, width: int) -> list[str]:
    """One line broken at blanks into lines of at most width cells. InputError for a longer word."""
    parts = [""]
    for word in line.split(BLANK):
        if len(word) > width:
            raise InputError(f"--width-cells = {width}: the word {word} has {len(word)} cells and cannot be broken")
        longer = f"{parts[-1]}{BLANK}{word}" if parts[-1] else word
        if len(longer) <= width:
            parts[-1] = longer
        else:
            parts.append(word)
    return parts


Kind = Literal["text", "dot", "height-series", "tip"]
KINDS: tuple[Kind, ...] = get_args(Kind)
ONLY_FOR: dict[str, tuple[Kind, ...]] = {
    "table": ("text",),
    "width_cells": ("text",),
    "dot_pitch_mm": ("text",),
    "cell_pitch_mm": ("text",),
    "line_pitch_mm": ("text",),
    "margin_mm": ("text",),
    "height_mm": ("text", "dot", "tip"),
    "heights_mm": ("height-series",),
    "thickness_mm": ("text", "dot", "height-series"),
    "thread": ("tip",),
}
"""Options that say something for some kinds alone."""


@dataclass(frozen=True)
class PlateRequest:
    """One plate.

    text : words or Unicode Braille, lines separated by newlines; None for the other kinds.
    given : sizes in mm that replace those of the standard.
    table : a table of liblouis; None for the built-in uncontracted English.
    width_cells : break longer lines at blanks; None refuses long lines.
    heights_mm, thickness_mm, margin_mm, thread : None for the usual ones.
    """

    standard: str
    kind: Kind = "text"
    text: str | None = None
    given: Mapping[QuantityName, float] = field(default_factory=dict)
    table: str | None = None
    width_cells: int | None = None
    heights_mm: tuple[float, ...] | None = None
    thickness_mm: float | None = None
    margin_mm: float | None = None
    thread: str | None = None


def check_request(request: PlateRequest) -> None:
    """InputError for an option that says nothing for this kind, and for numbers out of bounds."""
    if request.kind == "text" and not (request.text or "").strip():
        raise InputError("text: is empty, a plate needs at least one character")
    if request.kind != "text" and request.text is not None:
        raise InputError(f"text '{request.text}': --kind {request.kind} has no text, leave it out")
    own = {name: getattr(request, name, None) for name in ONLY_FOR} | dict(request.given)
    for name, value in own.items():
        if value is not None and request.kind not in ONLY_FOR.get(name, KINDS):
            allowed = ", ".join(ONLY_FOR[name])
            raise InputError(f"{_option(name)}: has no meaning for --kind {request.kind}, only for {allowed}")
    for name in ("thickness_mm", "margin_mm"):
        if (length := getattr(request, name)) is not None:
            require_length(_option(name), length)
    for height in request.heights_mm or ():
        require_length("--heights-mm", height)
    if request.width_cells is not None and request.width_cells < 1:
        raise InputError(f"--width-cells = {request.width_cells}: must be at least 1")


def _option(name: str) -> str:
    return f"--{name.replace('_', '-')}"


@dataclass(frozen=True)
class BuiltPlate:
    """A plate with what it was built from; translation : None for a plate without text."""

    request: PlateRequest
    plate: Plate
    sizes: BrailleSizes
    translation: Translation | None


def build_plate(request: PlateRequest) -> BuiltPlate:
    """Check, translate and build. InputError for everything that cannot be built."""
    check_request(request)
    sizes = braille_sizes(request.standard, request.given)
    thickness = request.thickness_mm or THICKNESS_MM
    if request.kind == "text":
        translation = translate(request.text or "", request.table, request.width_cells)
        margin = request.margin_mm or MARGIN_MM
        return BuiltPlate(request, text_plate(translation.lines, sizes, thickness, margin), sizes, translation)
    base = sizes["base_diameter_mm"]
    if request.kind == "tip":
        plate = indenter_tip(base, sizes["height_mm"], request.thread or next(iter(THREADS)))
    elif request.kind == "dot":
        plate = height_series(base, (sizes["height_mm"],), thickness)
    else:
        plate = height_series(base, request.heights_mm or HEIGHTS_MM, thickness)
    return BuiltPlate(request, plate, sizes, None)
