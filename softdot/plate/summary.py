"""The content of plate.json: every number with its unit in its name."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from export.printability import Printability
from softdot.json_files import plain
from softdot.output import Product
from softdot.plate.build import BuiltPlate
from softdot.version import installed_version


def summary_of(built: BuiltPlate, answers: Sequence[Printability], product: Product) -> dict[str, Any]:
    """Numbers of the plate with their units in their names, in plain data."""
    plate, sizes = built.plate, built.sizes
    words: dict[str, Any] = plain(
        {
            "format": product.format,
            "softdot_version": installed_version(),
            "kind": built.request.kind,
            **_text(built),
            "standard": {"name": sizes.standard, "title": sizes.title},
            "dimensions": {name: asdict(size) for name, size in sizes.known.items()},
            "size_mm": plate.size_mm,
            "volume_mm3": plate.part.volume_mm3,
            "dots": [asdict(dot) for dot in plate.dots],
            "printability": [answer.as_dict() for answer in answers],
            "files": sorted(product.entries),
            "warnings": _warnings(built),
        }
    )
    return words


def _text(built: BuiltPlate) -> dict[str, Any]:
    translation = built.translation
    if translation is None:
        return {}
    return {
        "text": built.request.text,
        "cells": translation.lines,
        "translation": {"table": translation.table, "liblouis": translation.liblouis},
    }


def _warnings(built: BuiltPlate) -> list[str]:
    """A warning for each size that the standard leaves open or that its source only recalls."""
    return [
        f"{name} = {size.value_mm:g} is the {size.basis} of the standard {built.sizes.standard}"
        for name, size in built.sizes.known.items()
        if size.basis in ("middle of the range", "minimum")
    ]
