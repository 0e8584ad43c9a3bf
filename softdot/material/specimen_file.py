"""The file of a testing machine: nominal strain and stress of one specimen over time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.convert.files import read_table
from softdot.convert.settings import without_brackets
from softdot.convert.text_table import TextTable
from softdot.material.quantities import quantity_of, size_of, split_unit, unit_factor

Kind = Literal["tension", "compression", "shear", "planar", "equibiaxial"]
KINDS: tuple[str, ...] = get_args(Kind)
LARGEST_PLAIN_STRAIN = 30.0  # 3000 %: no rubber stretches so far, a larger strain without a unit is in percent
FEWEST_SAMPLES = 8


@dataclass(frozen=True)
class SpecimenTest:
    """Nominal strain and stress_MPa (t,), positive while the specimen is loaded; time_s (t,) or None.

    has_plain_strain : whether the file has a strain without a unit.
    """

    file: Path
    kind: str
    time_s: Floats | None
    strain: Floats
    stress_MPa: Floats
    sizes: Mapping[str, float]
    has_plain_strain: bool = False


def read_test(file: Path, kind: str, sizes: Mapping[str, float], columns: str | None = None) -> SpecimenTest:
    """Read the test of a specimen. sizes : of it, before those that the file states. columns : a header by hand.

    InputError for a file that cannot be read, a quantity or a size that is missing, and a curve of another kind.
    """
    table = read_table(file)
    first, names, units = _header(table)
    if columns is not None:
        names, units = [name.strip() for name in columns.split(",")], []
    found = _columns(table, first, names, units)
    plain = any(split_unit(name)[1] is None and quantity_of(name, None) == ("strain", 1.0) for name in names)
    stated = {**_sizes_above(table, first), **sizes}
    time = found.get("time_s")
    strain, stress = _strain(found, stated, file), _stress(found, stated, kind, file)
    kept = np.isfinite(strain) & np.isfinite(stress)
    if time is not None:
        kept &= np.isfinite(time) & (np.maximum.accumulate(np.concatenate([[-np.inf], time[:-1]])) < time)
    if kept.sum() < FEWEST_SAMPLES:
        raise InputError(f"'{file}': has {kept.sum()} samples of strain and stress; {FEWEST_SAMPLES} are needed")
    strain, stress = _oriented(strain[kept], stress[kept], kind, file)
    return SpecimenTest(file, kind, None if time is None else time[kept], strain, stress, stated, plain and not units)


def _header(table: TextTable) -> tuple[int, list[str], list[str]]:
    """Row of the first sample, names of the columns and, where they have a row of their own, units. InputError."""
    filled = [row for row, cells in enumerate(table.rows) if any(cells)]

    def numbers(row: int) -> int:
        return sum(table.is_number(cell) for cell in table.rows[row])

    first = next((row for row, after in pairwise(filled) if numbers(row) >= 2 and numbers(after) == numbers(row)), None)
    if first is None:
        raise InputError(f"'{table.file}': has no columns of numbers")
    above = [list(table.rows[row]) for row in filled if row < first]
    bare = [without_brackets(cell) for cell in above[-1]] if above else []
    if len(above) > 1 and any(bare) and all(unit_factor(cell) for cell in bare if cell):
        return first, above[-2], bare
    return first, above[-1] if above else [], []


def _columns(table: TextTable, first: int, names: Sequence[str], units: Sequence[str]) -> dict[str, Floats]:
    """Quantity -> values (t,). InputError for two columns of one quantity."""
    rows = [row for row in range(first, len(table.rows)) if any(table.rows[row])]
    places: dict[str, tuple[int, float]] = {}
    width = max(len(names), len(units))
    for place, cell in enumerate([*names, *[""] * (width - len(names))]):
        name, unit = split_unit(cell)
        if place < len(units) and units[place]:
            unit = units[place]
        found = quantity_of(name, unit)
        if found is None:
            continue
        if found[0] in places:
            raise InputError(
                f"{table.place(first)}: columns {places[found[0]][0] + 1} and {place + 1} are both {found[0]}; "
                '--columns "time (s),,strain (%),stress (MPa)" names those that count and leaves the others empty'
            )
        places[found[0]] = place, found[1]
    return {quantity: factor * table.column(rows, place) for quantity, (place, factor) in places.items()}


def _sizes_above(table: TextTable, first: int) -> dict[str, float]:
    """Sizes of the specimen that rows above the samples state: 'Width (mm);6', 'b0;6;mm', 'Width: 6 mm'."""
    sizes: dict[str, float] = {}
    for row in range(first):
        texts = [text for cell in table.rows[row] for text in cell.replace(":", " ").split(" ") if text]
        number = next((n for n, text in enumerate(texts) if n and table.is_number(text)), None)
        if number is None:
            continue
        name, unit = split_unit(" ".join(texts[:number]).replace("=", "").strip())
        unit = unit or (without_brackets(texts[number + 1]) if number + 1 < len(texts) else None)
        found = size_of(name, unit) if unit else None
        if found is not None:
            sizes[found[0]] = found[1] * float(texts[number].replace(",", "."))
    return sizes


def _strain(found: Mapping[str, Floats], sizes: Mapping[str, float], file: Path) -> Floats:
    """Nominal strain (t,). InputError."""
    if "strain" in found:
        strain = found["strain"]
        if np.nanmax(np.abs(strain)) > LARGEST_PLAIN_STRAIN:
            raise InputError(f"'{file}': the strain reaches {np.nanmax(np.abs(strain)):g}; is it in %? Write its unit")
        return strain
    if "stretch" in found:
        return np.asarray(found["stretch"] - 1.0)
    if "displacement_mm" not in found:
        raise InputError(
            f"'{file}': no column is a strain or a displacement with its unit, such as Strain (%) or Extension (mm); "
            '--columns "time (s),strain (%),stress (MPa)" names them'
        )
    if "gauge_length_mm" not in sizes:
        raise InputError(f"'{file}': gauge_length_mm is not stated; a displacement needs --gauge-length-mm")
    return np.asarray(found["displacement_mm"] / sizes["gauge_length_mm"])


def _stress(found: Mapping[str, Floats], sizes: Mapping[str, float], kind: str, file: Path) -> Floats:
    """Nominal stress (t,) in MPa. InputError."""
    if "stress_MPa" in found:
        return found["stress_MPa"]
    if "force_N" not in found:
        raise InputError(
            f"'{file}': no column is a stress or a force with its unit, such as Stress (MPa) or Load (N); "
            '--columns "time (s),strain (%),stress (MPa)" names them'
        )
    area = sizes.get("area_mm2")
    if area is None and kind in ("tension", "planar") and {"width_mm", "thickness_mm"} <= sizes.keys():
        area = sizes["width_mm"] * sizes["thickness_mm"]
    if area is None:
        needs = "--area-mm2" + (", or --width-mm and --thickness-mm" if kind in ("tension", "planar") else "")
        raise InputError(f"'{file}': the area is not stated; a force needs {needs}")
    return np.asarray(found["force_N"] / area)


def _oriented(strain: Floats, stress: Floats, kind: str, file: Path) -> tuple[Floats, Floats]:
    """Strain and stress, positive where the specimen is loaded most. InputError for a curve of another kind."""
    most = int(np.argmax(np.abs(strain)))
    signs = np.sign(strain[most]), np.sign(stress[most])
    if kind in ("tension", "planar", "equibiaxial") and (signs[0] < 0.0 or signs[1] < 0.0):
        what = "strain" if signs[0] < 0.0 else "stress"
        raise InputError(f"'{file}': the {what} is negative where it is largest; a block needs --kind compression")
    strain, stress = signs[0] * strain, signs[1] * stress
    if not strain[most] > 0.0 or not stress[most] > 0.0:
        raise InputError(f"'{file}': strain or stress is zero throughout")
    if kind == "compression" and strain[most] >= 1.0:
        raise InputError(f"'{file}': a compressive strain of {100 * strain[most]:.4g} % leaves nothing of the block")
    return strain, stress
