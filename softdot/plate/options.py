"""The request for a plate: its kind, and the options that act for it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from foundation.errors import InputError
from geometry.braille_standards import QuantityName
from geometry.plates.braille_sizes import require_length

Kind = Literal["text", "dot", "height-series", "tip"]
KINDS: tuple[Kind, ...] = get_args(Kind)
KINDS_OF_OPTION: dict[str, tuple[Kind, ...]] = {
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
"""Option that acts for some kinds alone -> these kinds."""


@dataclass(frozen=True)
class PlateRequest:
    """A request for one plate.

    text : words or Unicode Braille, lines separated by newlines; None for the other kinds. given : sizes in mm that
    replace those of the standard. table : a table of liblouis; None for the built-in uncontracted English. width_cells
    : break longer lines at blanks; None refuses long lines. heights_mm, thickness_mm, margin_mm, thread : None for the
    usual ones.
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
    """InputError for an option that does not act for the kind of plate, and for numbers out of bounds."""
    if request.kind == "text" and not (request.text or "").strip():
        raise InputError("text: is empty, a plate needs at least one character")
    if request.kind != "text" and request.text is not None:
        raise InputError(f"text '{request.text}': --kind {request.kind} has no text, leave it out")
    own = {name: getattr(request, name, None) for name in KINDS_OF_OPTION} | dict(request.given)
    for name, value in own.items():
        if value is not None and request.kind not in KINDS_OF_OPTION.get(name, KINDS):
            allowed = ", ".join(KINDS_OF_OPTION[name])
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
