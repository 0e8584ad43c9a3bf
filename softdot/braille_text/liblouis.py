"""Text to Braille cells by a table of liblouis, through its Python binding or its program."""

import re
import shutil
import subprocess
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec

from foundation.errors import InputError

INSTALL_ADVICE = (
    "liblouis translates contracted Braille and other languages: install it (Debian and Ubuntu 'apt-get install "
    "liblouis-bin', Fedora 'dnf install liblouis-utils', macOS 'brew install liblouis') and name a table, "
    "such as --table en-ueb-g2.ctb"
)
DISPLAY_TABLE = "unicode.dis"
"""The table of liblouis by which cells are characters of Unicode."""
UNKNOWN_CHARACTER = re.compile("⠄⡳⠭[⠀-⣿]*?⠄")
"""The cells that liblouis writes for a character that its table lacks: the Braille of '\\xhhhh'."""
SIX_DOTS = re.compile("[⠀-⠿]+")
TIMEOUT_S = 60


@dataclass(frozen=True)
class Translator:
    """The liblouis of this machine. called_by : its Python binding or the path of its program."""

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
        raise InputError(f"--table '{table}': liblouis is not installed; {INSTALL_ADVICE}")
    cells = _translate(translator, text, table)
    if UNKNOWN_CHARACTER.search(cells):
        lacking = [c for c in dict.fromkeys(text) if UNKNOWN_CHARACTER.search(_translate(translator, c, table))]
        shown = ", ".join(f"'{c}' (U+{ord(c):04X}) at place {text.index(c) + 1}" for c in lacking)
        raise InputError(f"text: {shown} is not in the liblouis table '{table}'; choose another table by --table")
    return cells


def louis_words(words: list[str], table: str) -> list[str | None]:
    """Cells of many words by a table of liblouis, None where it lacks a character or makes cells of eight dots.

    InputError without liblouis, and for a table that it does not know.
    """
    translator = liblouis()
    if translator is None:
        raise InputError(f"--table '{table}': liblouis is not installed; {INSTALL_ADVICE}")
    if translator.called_by == "louis":
        cells = [_by_binding(word, table) for word in words]
    else:
        cells = _translate(translator, "\n".join(words), table).split("\n")
    return [one if one and SIX_DOTS.fullmatch(one) and not UNKNOWN_CHARACTER.search(one) else None for one in cells]


def _translate(translator: Translator, text: str, table: str) -> str:
    if translator.called_by == "louis":
        return _by_binding(text, table)
    tables = f"{DISPLAY_TABLE},{table}"
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
        return str(louis.translateString([DISPLAY_TABLE, table], text))
    except RuntimeError:
        raise _unknown_table(table) from None


def _unknown_table(table: str) -> InputError:
    return InputError(f"--table '{table}': liblouis cannot use it; name one of its tables, such as en-ueb-g2.ctb")
