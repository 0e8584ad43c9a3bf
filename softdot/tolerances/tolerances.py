"""The tolerances of a segment: one row for each quantity that may be off."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from foundation.arrays import Floats
from geometry.dot_size import dot_size, dot_size_from_base, dot_standard
from geometry.fabrication.parameters import cast_components, sheet_components
from geometry.parameters import SIZED_DOTS, Dot, Segment
from geometry.stack import Layer, layers
from softdot.config.schema import Config
from softdot.tolerances.factors import factor_key

LAYER_NAMES = {"medium1": "medium 1", "medium2": "medium 2"}
"""Layer -> its name in the budget."""
DIFFERENCE_STEP_MM = 1e-6
"""Step of the central differences of a dot's radius."""
PERMITTIVITY_ROW = "permittivity of the film"
"""The constant that moves the voltage V = Q / C and not the charge."""


@dataclass(frozen=True)
class Tolerance:
    """A quantity and how far it may be off.

    nominal, plus_minus : in unit; unit "%" is of the nominal value, which is then None. slopes : key of the
    configuration with factors -> change of that key per unit of the quantity. counted : False where another row holds
    the same error. note : a remark for the reader.
    """

    label: str
    nominal: float | None
    plus_minus: float
    unit: str
    source: str
    confidence: str
    slopes: Mapping[str, float] = field(default_factory=dict)
    counted: bool = True
    note: str = ""

    def changes(self, share: float) -> dict[str, float]:
        """Change of each key where the quantity is off by a share of its plus or minus."""
        return {key: share * self.plus_minus * slope for key, slope in self.slopes.items()}

    def effect(self, by_key: Mapping[str, Sequence[float]]) -> Floats:
        """Change (q,) of quantities at the upper end, to first order. by_key : their derivatives (q,) by each key."""
        parts = [slope * np.array(by_key[key]) for key, slope in self.slopes.items()]
        return np.asarray(self.plus_minus * sum(parts))


def tolerances(config: Config) -> list[Tolerance]:
    """Tolerances of all quantities that change the press to first order."""
    return [
        *_thicknesses(config),
        *_moduli(config, _cast_materials(config)),
        *_film(config),
        *_dot(config),
        *([] if config.segment.film.electrodes else _footprint(config.segment)),
        _press(config),
        *_interfaces(config),
    ]


def material_tolerances(config: Config) -> list[Tolerance]:
    """The tolerances of the constants of the stated materials."""
    return [*_moduli(config, {}), *_film(config)]


def shifts(config: Config) -> list[Tolerance]:
    """Quantities whose effect has no useful derivative, and is found by presses at both ends.

    It vanishes to first order by symmetry, or the edges of electrodes would pass whole points of the mesh.
    """
    return [*placement_shifts(config), *(_footprint(config.segment) if config.segment.film.electrodes else [])]


def placement_shifts(config: Config) -> list[Tolerance]:
    """Those of shifts that move the dot or turn the film, and change no size."""
    offset, angle = table()["dot"]["offset"], table()["film"]["draw_angle"]
    axes = (0,) if config.segment.section == "plane-strain" else (0, 1)
    found = [
        _row(
            f"dot offset in {'xy'[axis]}", config.dot.offset_mm[axis], offset["mm"], "mm", offset,
            {f"dot.offset_mm[{axis}]": 1.0},
        )
        for axis in (() if config.dot.shape == "plate" else axes)
    ]  # fmt: skip
    turned = {"segment.film.draw_angle_deg": 1.0}
    nominal = config.segment.film.draw_angle_deg
    return [*found, _row("draw direction of the film", nominal, angle["deg"], "°", angle, turned)]


@cache
def table() -> dict[str, Any]:
    """The content of tolerances.toml."""
    return tomllib.loads(files(__package__).joinpath("tolerances.toml").read_text("utf-8"))


def _row(
    label: str,
    nominal: float | None,
    plus_minus: float,
    unit: str,
    entry: Mapping[str, Any],
    slopes: Mapping[str, float] | None = None,
    **more: Any,
) -> Tolerance:
    source = table()["sources"].get(entry["source"], entry["source"])
    return Tolerance(label, nominal, plus_minus, unit, source, entry["confidence"], slopes or {}, **more)


def _percent_row(label: str, entry: Mapping[str, Any], key: str, value: float = 1.0) -> Tolerance:
    """A tolerance in percent of the nominal value of a key."""
    return _row(label, None, 100 * entry["share"], "%", entry, {key: value / 100})


def _thicknesses(config: Config) -> list[Tolerance]:
    found = []
    for layer in reversed(layers(config.segment)):
        entry = table()["thickness"][_process(layer.name, config)]
        unit, scale = ("µm", 1e3) if layer.name == "film" else ("mm", 1.0)
        nominal = scale * layer.thickness_mm
        plus_minus = scale * entry["mm"] if "mm" in entry else entry["share"] * nominal
        key = factor_key(config, layer.name, "thickness_factor")
        found.append(_row(f"thickness of {_layer_name(layer)}", nominal, plus_minus, unit, entry, {key: 1.0 / nominal}))
    return found


def _process(layer: str, config: Config) -> str:
    if layer == "film":
        return "film"
    cut = layer in sheet_components(config.segment, config.fabrication)
    return "sheet" if cut else f"cast-{config.fabrication.printer}"


def _cast_materials(config: Config) -> dict[str, str]:
    """Layer -> the material that its recipe casts, for the layers that are cast."""
    return {one.name: one.recipe.name for one in cast_components(config.segment, config.fabrication)}


def _moduli(config: Config, poured: Mapping[str, str]) -> list[Tolerance]:
    """Tolerances of the moduli of the layers. poured : layer -> the material that is cast in its place."""
    found = []
    for layer in reversed(layers(config.segment)):
        material = poured.get(layer.name, layer.material)
        entry = table()["film"]["modulus"] if layer.name == "film" else _modulus_entry(material)
        found.append(
            _percent_row(f"modulus of {_layer_name(layer)}", entry, factor_key(config, layer.name, "modulus_factor"))
        )
    return found


def _modulus_entry(material: str) -> Mapping[str, Any]:
    rows: list[Mapping[str, Any]] = table()["modulus"]
    return next(row for row in rows if material in row.get("materials", [material]))


def _film(config: Config) -> list[Tolerance]:
    segment, rows = config.segment, table()["film"]
    permittivity = f"materials.{segment.film.material}.relative_permittivity"
    nominal = config.layer_materials()["film"].relative_permittivity  # type: ignore[union-attr]
    raised = {
        factor_key(config, layer, "thickness_factor"): sign / getattr(segment, layer).thickness_mm
        for layer, sign in (("medium1", -1.0), ("medium2", 1.0))
    }
    note = "medium 2 thicker and medium 1 thinner by the same; already in the two thicknesses"
    height = _row(
        "height of the film in the stack", segment.medium2.thickness_mm, rows["height"]["mm"], "mm", rows["height"],
        raised, counted=False, note=note,
    )  # fmt: skip
    return [
        _percent_row("piezoelectric constants of the film", rows["d31"], factor_key(config, "film", "d31_factor")),
        _percent_row(PERMITTIVITY_ROW, rows["permittivity"], permittivity, nominal),
        height,
    ]


def _dot(config: Config) -> list[Tolerance]:
    """Tolerances of the dot's size. A higher dot on a plate that stops at the same height is also pressed in deeper."""
    dot = config.dot
    if dot.shape not in SIZED_DOTS:  # a plate has no size, that of a profile was measured
        return []
    size = dot_size(dot)
    deeper = {"press.indentation_mm": 1.0} if config.press.force_N is None else {}
    height, base = _dot_entry(dot, "height_mm", "height"), _dot_entry(dot, "base_diameter_mm", "base_diameter")
    key = factor_key(config, "dot", "radius_factor")
    if dot.radius_mm is not None:
        slope = {key: 1.0 / size.radius_mm}
        across = _row("radius of the dot", size.radius_mm, base["mm"] / 2, "mm", base, slope)
        return [_row("height of the dot", size.height_mm, height["mm"], "mm", height, deeper), across]
    diameter = _base_diameter(dot)
    by_height, by_base = (
        (
            dot_size_from_base(diameter + d, size.height_mm + h).radius_mm
            - dot_size_from_base(diameter - d, size.height_mm - h).radius_mm
        )
        / (2 * DIFFERENCE_STEP_MM * size.radius_mm)
        for d, h in ((0.0, DIFFERENCE_STEP_MM), (DIFFERENCE_STEP_MM, 0.0))
    )
    note = "its plate stops at the same height, so that a higher dot also goes in deeper" if deeper else ""
    return [
        _row("height of the dot", size.height_mm, height["mm"], "mm", height, {key: by_height, **deeper}, note=note),
        _row("base diameter of the dot", diameter, base["mm"], "mm", base, {key: by_base}),
    ]


def _base_diameter(dot: Dot) -> float:
    chosen = dot_standard(dot)
    if chosen is not None:
        return chosen.nominal_mm("base_diameter_mm")
    assert dot.base_diameter_mm is not None
    return dot.base_diameter_mm


def _dot_entry(dot: Dot, quantity: Any, name: str) -> Mapping[str, Any]:
    """The tolerance that the dot's standard allows, half its range, or else the table's own number."""
    chosen = dot_standard(dot)
    size = None if chosen is None else chosen.quantities[quantity]
    if size is None or size.minimum_mm is None or size.maximum_mm is None or size.minimum_mm == size.maximum_mm:
        entry: Mapping[str, Any] = table()["dot"][name]
        return entry
    source = f"half the range of {chosen.title} ({size.source})"  # type: ignore[union-attr]
    return {"mm": (size.maximum_mm - size.minimum_mm) / 2, "source": source, "confidence": size.confidence}


def _footprint(segment: Segment) -> list[Tolerance]:
    entry = table()["footprint"]
    sides = (("length", segment.length_mm), ("width", segment.width_mm))
    rows = ((f"{side} of the segment", size, {f"segment.{side}_mm": 1.0}) for side, size in sides)
    return [_row(label, size, entry["mm"], "mm", entry, slopes) for label, size, slopes in rows]


def _press(config: Config) -> Tolerance:
    press, rows = config.press, table()["press"]
    if press.force_N is not None:
        return _percent_row("force of the press", rows["force"], "press.force_N", press.force_N)
    depth = rows["depth"]
    return _row("depth of the press", press.depth_mm, depth["mm"], "mm", depth, {"press.indentation_mm": 1.0})


def _interfaces(config: Config) -> list[Tolerance]:
    """Tolerances of bonds, elastic sides and the cable, where the configuration has them."""
    segment, rows, found = config.segment, table()["interfaces"], []
    for number, bond in enumerate(segment.bonds):
        for way in ("normal", "shear"):
            name = f"{way}_stiffness_N_per_mm3"
            label = f"{way} stiffness of the bond {bond.between[0]}–{bond.between[1]}"
            found.append(_percent_row(label, rows["bonds"], f"segment.bonds[{number}].{name}", getattr(bond, name)))
    if segment.boundary == "elastic" and segment.side_stiffness_N_per_mm3 > 0.0:
        key = "segment.side_stiffness_N_per_mm3"
        found.append(_percent_row("stiffness of the sides", rows["sides"], key, segment.side_stiffness_N_per_mm3))
    readout = config.readout
    if readout is not None and readout.mode == "voltage" and readout.input_capacitance_pF > 0.0:
        key, entry = "readout.input_capacitance_pF", rows["cable_capacitance"]
        found.append(_percent_row("capacitance of cable and amplifier", entry, key, readout.input_capacitance_pF))
    return found


def _layer_name(layer: Layer) -> str:
    return LAYER_NAMES.get(layer.name, f"the {layer.name}")
