"""Designs with which a tab may begin, and the sizes from which the page sketches one."""

import tomllib
from collections.abc import Mapping
from importlib.resources import files
from typing import Any

from softdot.config.default_design import default_design, with_default_design

STARTS = (
    ("softdot.config", "default", "The default design", "A flat effector on two media, its sides clamped."),
    ("softdot.templates", "dome", "A dome", "A soft dome touches the dot first."),
    ("softdot.templates", "slice", "A slice", "Plane strain under a ridge: pressed in seconds."),
    ("softdot.studio", "array-cell", "An array", "Six segments under a Braille cell."),
)
"""Package, file, title and sentence of each."""
OWN_SIZE = 0.8
"""Of the segment: the width of an effector that does not state one."""


def starts() -> list[dict[str, Any]]:
    """Each with title, about, text (TOML) and sizes, the default design first."""
    found = []
    for package, name, title, about in STARTS:
        text = files(package).joinpath(f"{name}.toml").read_text("utf-8")
        found.append({"title": title, "about": about, "text": text, "sizes": sizes(text)})
    return found


def sizes(text: str) -> dict[str, Any] | None:
    """Lengths in mm: length, medium1, medium2, effector (shape, width, height) or None, columns of an array.

    None for a text that is no design. Nothing is checked: it is for a sketch.
    """
    try:
        tables = with_default_design(tomllib.loads(text))
        segment = {"length_mm": default_design()["segment"]["length_mm"], **tables["segment"]}
        found = {
            "length": float(segment["length_mm"]),
            "medium1": float(segment["medium1"]["thickness_mm"]),
            "medium2": float(segment["medium2"]["thickness_mm"]),
            "effector": _effector(segment),
            "columns": int(tables.get("array", {}).get("columns", 1)),
        }
    except (tomllib.TOMLDecodeError, AttributeError, KeyError, TypeError, ValueError):
        return None
    return found if _can_be_drawn(found) else None


def _effector(segment: Mapping[str, Any]) -> dict[str, Any] | None:
    stated = segment.get("effector")
    if not stated:
        return None
    shape, whole = stated["shape"], segment["length_mm"]
    width = whole if shape == "layer" else stated.get("length_mm" if shape == "block" else "diameter_mm")
    return {"shape": shape, "width": float(width or OWN_SIZE * whole), "height": float(stated["height_mm"])}


def _can_be_drawn(found: Mapping[str, Any]) -> bool:
    top = found["effector"] or {"width": 1.0, "height": 1.0}
    lengths = (found["length"], found["medium1"], found["medium2"], top["width"], top["height"])
    return all(0.0 < one < 1e4 for one in lengths) and 1 <= found["columns"] <= 12


def title(text: str) -> str:
    """The first comment of a design, without its mark; empty where there is none."""
    first = text.lstrip().split("\n", 1)[0]
    return first.lstrip("# ").rstrip(".")[:80] if first.startswith("#") else ""
