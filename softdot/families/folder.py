"""The files of a family: family.json, the arrays of its presses with a checksum, and its page."""

import hashlib
import json
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from foundation.errors import InputError
from softdot.families.family import Family, Region
from softdot.families.gradient_process import Scales
from softdot.families.quantity import FamilyQuantity
from softdot.families.space import FamilySpace
from softdot.json_files import plain, write_json
from softdot.output import Product
from softdot.version import installed_version

ARRAYS, PAGE = "family.npz", "family.html"
FAMILY = Product("softdot-family/1", "family.json", frozenset({"family.json", ARRAYS, PAGE}))


def write_family(family: Family, folder: Path) -> dict[str, Any]:
    """Write what a family answers from into an empty folder and return the content of family.json."""
    buffer = BytesIO()
    np.savez_compressed(buffer, **_arrays(family))
    content = buffer.getvalue()
    (folder / ARRAYS).write_bytes(content)
    summary: dict[str, Any] = plain({
        "format": FAMILY.format,
        "softdot_version": installed_version(),
        "axes": [
            {"keys": one.keys, "name": one.name, "low": one.low, "high": one.high} for one in family.space.ranges
        ],
        "quantities": list(family.quantities),
        **family.facts,
        "reasons": family.region.reasons,
        "space": family.space.tables,
        "sha256_of_arrays": hashlib.sha256(content).hexdigest(),
    })  # fmt: skip
    write_json(folder / FAMILY.summary, summary)
    return summary


def _arrays(family: Family) -> dict[str, Any]:
    """Presses, hyperparameters and places of a family, by the names under which its file holds them."""
    arrays: dict[str, Any] = {"places": family.places, "good": family.region.good, "refused": family.region.refused}
    for number, one in enumerate(family.quantities.values()):
        arrays |= {f"values_{number}": one.values, f"slopes_{number}": one.slopes}
        if one.process is not None:
            arrays[f"scales_{number}"] = one.process.scales.logs
    return arrays


def load_family(folder: Path | str) -> Family:
    """The family in the folder of `softdot family`. InputError for one that cannot be read, or is damaged."""
    place = Path(folder)
    try:
        facts = json.loads((place / FAMILY.summary).read_bytes())
        content = (place / ARRAYS).read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"'{folder}': holds no '{Path(error.filename).name}', as a family does") from None
    except (OSError, ValueError) as error:
        raise InputError(f"'{folder}': cannot be read as a family ({error})") from None
    if not isinstance(facts, dict) or facts.get("format") != FAMILY.format:
        raise InputError(f"'{place / FAMILY.summary}': is not of the format {FAMILY.format}")
    if hashlib.sha256(content).hexdigest() != facts.get("sha256_of_arrays"):
        raise InputError(f"'{place / ARRAYS}': is damaged, or of another family than family.json; make it again")
    with np.load(BytesIO(content), allow_pickle=False) as arrays:
        return _family(facts, arrays)


def _family(facts: Mapping[str, Any], arrays: Mapping[str, Any]) -> Family:
    """The family of undamaged files, its factorisation made again. InputError."""
    quantities = {}
    for number, name in enumerate(facts["quantities"]):
        scales = f"scales_{number}"
        quantities[name] = FamilyQuantity(
            arrays["places"], arrays[f"values_{number}"], arrays[f"slopes_{number}"],
            Scales.of(arrays[scales]) if scales in arrays else None,
        )  # fmt: skip
    region = Region(arrays["good"], arrays["refused"], tuple(facts["reasons"]))
    return Family(FamilySpace(facts["space"]), quantities, region, facts)
