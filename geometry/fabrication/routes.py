"""Which components are cast, which are cut from sheet."""

from dataclasses import dataclass
from typing import get_args

from geometry.errors import InputError
from geometry.fabrication.parameters import Component, Fabrication
from geometry.fabrication.recipes import Recipe, castable_materials, recipe_for
from geometry.parameters import Segment
from geometry.stack import layers


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
