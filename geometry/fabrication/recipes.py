"""What to pour for a material (shrinkage, density, mix, release), and which components are cast or cut from sheet."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, Literal, get_args

from geometry.base import InputError
from geometry.fabrication.parameters import CastingNumbers, Component, Fabrication
from geometry.parameters import Segment
from geometry.stack import layers


@dataclass(frozen=True)
class Recipe:
    """How to cast one material.

    name : of what is poured; note : why it is another material than the one configured, or empty.
    shrinkage : linear, as a fraction of the mould. density_g_cm3 : cured.
    parts : shares of the components A and B; ratio_by : what they count.
    densities_g_cm3 : of the components.
    """

    name: str
    note: str
    shrinkage: float
    density_g_cm3: float
    parts: tuple[float, float]
    ratio_by: Literal["mass", "volume"]
    densities_g_cm3: tuple[float, float]
    pot_life_min: float | None
    cure_time_h: float | None
    release: str
    source: str

    def masses_g(self, mixed_g: float) -> tuple[tuple[str, float], ...]:
        """The mass of each component in a mix of the given mass."""
        scale = self.densities_g_cm3 if self.ratio_by == "volume" else (1.0, 1.0)
        shares = [part * density for part, density in zip(self.parts, scale, strict=True)]
        masses = [("A", shares[0]), ("B", shares[1])]
        return tuple((name, mixed_g * share / sum(shares)) for name, share in masses if share > 0.0)


def recipe_for(material: str, fabrication: Fabrication) -> Recipe | None:
    """The recipe of a material: your own, the built-in one, that of its stand-in, or None if it cannot be cast."""
    if material in fabrication.casting:
        return _own(material, fabrication.casting[material])
    sheet = _table()["sheets"].get(material, {})
    name = sheet.get("cast_as", material)
    if name in fabrication.casting:
        return _own(name, fabrication.casting[name])
    row = _table()["recipes"].get(name)
    return None if row is None else _built_in(name, sheet.get("note", ""), row)


def castable_materials(fabrication: Fabrication) -> tuple[str, ...]:
    """Names of the materials that can be cast."""
    stand_ins = [name for name, row in _table()["sheets"].items() if "cast_as" in row]
    return tuple(sorted({*_table()["recipes"], *stand_ins, *fabrication.casting}))


@cache
def _table() -> dict[str, Any]:
    return tomllib.loads(files(__package__).joinpath("casting.toml").read_text("utf-8"))


def _built_in(name: str, note: str, row: dict[str, Any]) -> Recipe:
    return Recipe(
        name=name,
        note=note,
        shrinkage=row["shrinkage_percent"] / 100.0,
        density_g_cm3=row["density_g_cm3"],
        parts=(row["parts"][0], row["parts"][1]),
        ratio_by=row["ratio_by"],
        densities_g_cm3=(row["density_g_cm3"], row["density_g_cm3"]),
        pot_life_min=row["pot_life_min"],
        cure_time_h=row["cure_time_h"],
        release=_table()["release"][row["release"]],
        source=f"{row['source']} (confidence {row['confidence']})",
    )


def _own(name: str, numbers: CastingNumbers) -> Recipe:
    density = numbers.density_g_cm3
    return Recipe(
        name=name,
        note="",
        shrinkage=numbers.shrinkage_percent / 100.0,
        density_g_cm3=density,
        parts=(numbers.parts_A, numbers.parts_B),
        ratio_by=numbers.ratio_by,
        densities_g_cm3=(numbers.density_A_g_cm3 or density, numbers.density_B_g_cm3 or density),
        pot_life_min=numbers.pot_life_min,
        cure_time_h=numbers.cure_time_h,
        release=numbers.release,
        source=f"fabrication.casting.{name} of the configuration",
    )


@dataclass(frozen=True)
class CastComponent:
    """name : "effector", "medium1" or "medium2"; material : of the configuration; recipe : what is poured."""

    name: Component
    material: str
    recipe: Recipe


def cast_components(segment: Segment, fabrication: Fabrication) -> tuple[CastComponent, ...]:
    """The components to cast, from the top down. InputError for one that can neither be cast nor cut."""
    materials = {layer.name: layer.material for layer in layers(segment)}
    for name, route in fabrication.routes.items():
        if name not in materials:
            raise InputError(f"fabrication.routes.{name} = '{route}': segment.{name} is absent")
    recipes = {
        name: _recipe(name, materials[name], segment, fabrication) for name in get_args(Component) if name in materials
    }
    return tuple(CastComponent(name, materials[name], recipe) for name, recipe in recipes.items() if recipe)


def sheet_components(segment: Segment, fabrication: Fabrication) -> tuple[str, ...]:
    """Names of the components to cut from sheet, from the top down; the film is not among them. InputError."""
    cast = {component.name for component in cast_components(segment, fabrication)}
    return tuple(layer.name for layer in reversed(layers(segment)) if layer.name not in {"film", *cast})


def _recipe(name: Component, material: str, segment: Segment, fabrication: Fabrication) -> Recipe | None:
    """The recipe of a component that is cast, None for one that is cut from sheet."""
    route = fabrication.routes.get(name, "auto")
    recipe = recipe_for(material, fabrication)
    if route == "cast" and recipe is None:
        known = ", ".join(castable_materials(fabrication))
        raise InputError(
            f"fabrication.routes.{name} = 'cast': no recipe for segment.{name}.material = '{material}'; give "
            f"[fabrication.casting.{material}] or one of {known}"
        )
    if recipe is not None and route != "sheet":
        return recipe
    if _is_dome(name, segment):
        why = "routes.effector = 'sheet'" if route == "sheet" else f"no recipe for casting '{material}'"
        raise InputError(
            f"segment.effector.shape = 'dome': {why}, and a dome cannot be cut from sheet; "
            f"cast it from a material with a recipe, or give [fabrication.casting.{material}]"
        )
    return None


def _is_dome(name: Component, segment: Segment) -> bool:
    return name == "effector" and segment.effector is not None and segment.effector.shape == "dome"
