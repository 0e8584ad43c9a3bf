"""Docstrings as Markdown that reads as they do in the source.

They are plain text. Lines such as "points : (n, 3) undeformed nodes" explain a parameter or an attribute; in Markdown
they would run together into one paragraph, so each becomes an item of a list.
"""

import re
from typing import Any

from griffe import Extension, Object

NAMES = r"[A-Za-z_]\w*(?:, [A-Za-z_]\w*)*"
EXPLAINED = re.compile(rf"({NAMES}) : (.*)")
NEXT_ON_LINE = re.compile(rf"[;.] (?={NAMES} : )")
CODE = re.compile(r"(`[^`]*`)")
SPECIAL = re.compile(r"[\\*_\[\]<$#]")


class PlainText(Extension):
    """Turns every docstring into Markdown before it is shown."""

    def on_object(self, *, obj: Object, **_: Any) -> None:
        """Called by griffe for each module, class, function and attribute that it has read."""
        if obj.docstring is not None:
            obj.docstring.value = as_markdown(obj.docstring.value)


def as_markdown(text: str) -> str:
    """The text of a docstring with its explained names as lists and nothing else taken for markup."""
    return "\n\n".join(_paragraph(paragraph) for paragraph in re.split(r"\n\s*\n", text))


def _paragraph(text: str) -> str:
    """One paragraph: its plain lines, its list and its formulas, which are set in by four spaces, each as a block."""
    blocks: list[list[str]] = []
    kind = ""
    for line in NEXT_ON_LINE.sub(".\n", text).splitlines():
        before, kind = kind, _kind(line, kind, blocks[-1][-1] if blocks else "")
        if kind == before:
            blocks[-1].append(_written(line, kind))
        else:
            blocks.append([_written(line, kind)])
    return "\n\n".join("\n".join(block) for block in blocks)


def _kind(line: str, before: str, last: str) -> str:
    """Whether a line explains names, is set in or is plain; what explains a name may go on in the lines below it."""
    if EXPLAINED.fullmatch(line.strip()):
        return "list"
    if before == "list" and not (last.endswith(".") and line[:1].isupper()):
        return "list"
    return "code" if line.startswith("    ") else "plain"


def _written(line: str, kind: str) -> str:
    """A line as Markdown."""
    if kind == "code":
        return line
    found = EXPLAINED.fullmatch(line.strip())
    if found:
        return f"- `{found[1]}` : {_plain(found[2])}"
    return ("    " if kind == "list" else "") + _plain(line.strip())


def _plain(text: str) -> str:
    """Text in which only `code` is markup."""
    parts = CODE.split(text)
    return "".join(part if part.startswith("`") else SPECIAL.sub(r"\\\g<0>", part) for part in parts)
