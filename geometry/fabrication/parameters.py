"""The [fabrication] table, recipes of castable materials, and which components are cast or cut from sheet."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Annotated, Any, Literal, get_args

from pydantic import Field

from foundation.errors import InputError
from geometry.parameters import NonNegative, Positive, Segment, Table
from geometry.stack import layers

Printer = Literal["sla", "fdm"]
Component = Literal["effector", "medium1", "medium2"]
Route = Literal["auto", "cast", "sheet"]
Direction = Literal["+x", "-x", "+y", "-y"]
Count = Annotated[int, Field(ge=1, le=6)]
Size = Annotated[float, Field(gt=0, le=100)]
Gap = Annotated[float, Field(ge=0, le=10)]


class CastingNumbers(Table):
    """A castable material of your own, or your own numbers for a known one, with whatever a data sheet says."""

    shrinkage_percent: float = Field(ge=0.0, le=10.0, description="linear shrinkage of the cast part")
    density_g_cm3: float = Field(gt=0.1, le=5.0, description="density of the cured part")
    parts_A: Positive = Field(1.0, description="share of component A in the mix")
    parts_B: NonNegative = Field(1.0, description="share of component B in the mix; 0 for one component")
    ratio_by: Literal["mass", "volume"] = Field("mass", description="what the shares count")
    density_A_g_cm3: Positive | None = Field(
        None, description="density of component A; left out: that of the cured part"
    )
    density_B_g_cm3: Positive | None = Field(
        None, description="density of component B; left out: that of the cured part"
    )
    pot_life_min: Positive | None = Field(None, description="time to pour")
    cure_time_h: Positive | None = Field(None, description="time until the part leaves the mould")
    release: str = Field(
        "a thin coat of a release agent that suits the material", description="release agent, for the build sheet"
    )


class Fabrication(Table):
    """How the parts are made; no effect on the simulation."""

    printer: Printer = Field("sla", description="sla (resin, also dlp) or fdm (filament): the limits of what prints")
    routes: dict[Component, Route] = Field(
        {},
        description="how a component is made; auto: cast where a recipe is known for its material, else cut from sheet",
    )
    casting: dict[str, CastingNumbers] = Field(
        {}, description="material name -> numbers for casting it; adds to or overrides the built-in recipes"
    )
    mould_style: Literal["auto", "open", "split"] = Field(
        "auto",
        description="open: one cavity plate with draft; split: bars on a floor, walls without draft; auto: open "
        "while the draft stays within tolerance_mm",
    )
    draft_deg: float = Field(1.0, ge=0.0, le=10.0, description="draft of the walls of an open mould")
    tolerance_mm: Size = Field(
        0.05, description="largest deviation of a cast part from the design that draft may cause"
    )
    lid_face: Literal["base", "top"] = Field(
        "base", description="which face of a component is cast against the smooth lid"
    )
    cavities: tuple[Count, Count] | None = Field(
        None,
        description="cavities of one mould in x and y; none: 2 and 2, 1 and 1 for a layer that runs through an array. "
        "Islands of an array have one each",
    )
    mould_wall_mm: Size = Field(4.0, description="around the cavities and under them")
    land_mm: Size = Field(1.0, description="flat rim between a cavity and the overflow channel")
    overflow_mm: Size = Field(1.5, description="width of the overflow channels")
    vent_width_mm: Size = Field(0.5, description="width of the vents from a cavity to the overflow")
    vent_depth_mm: Size = Field(0.2, description="depth of the vents")
    pin_diameter_mm: Size = Field(3.0, description="alignment pins of moulds and jig")
    pin_clearance_mm: Gap = Field(0.15, description="gap between a pin and its hole, on each side")
    overfill_percent: float = Field(30.0, ge=0, le=1000, description="what is poured beyond the cavities")
    smallest_batch_g: float = Field(
        10.0, ge=0, le=10000, description="least amount that is weighed and mixed, however little is poured"
    )
    wall_mm: Size = Field(1.2, description="outer walls of the clamp frame and of the jig")
    floor_mm: Size = Field(2.0, description="floor of the clamp frame, of the open base and of the jig")
    side_clearance_mm: Gap = Field(0.3, description="frame: air beside layers that are not held")
    glue_gap_mm: Gap = Field(0.05, description="frame: glue line beside layers that are held")
    rim_glue_modulus_MPa: Annotated[float, Field(gt=0, le=100)] = Field(
        0.56,
        description="shear modulus of the glue beside layers that an elastic rim holds; over side_stiffness_N_per_mm3 "
        "it is the thickness of the glue line, in place of glue_gap_mm",
    )
    array: tuple[Count, Count] = Field((1, 1), description="segments of one frame in x and y")
    pitch_mm: Positive | None = Field(
        None,
        description="from centre to centre of neighbouring segments; needed for an array, and checked for one segment",
    )
    screw_diameter_mm: Size = Field(2.2, description="clearance holes of the screws that close the frame")
    cable_exit: Direction = Field("+x", description="side at which the film's tab leaves the frame")
    tab_width_mm: Size | None = Field(
        None, description="width of the film's tab; none: 1.6, or as much as its traces need"
    )
    trace_width_mm: Size = Field(0.3, description="least width of the traces from electrodes to pads")
    trace_gap_mm: Size = Field(
        0.2, description="least bare film between metal of one face; between the leads on the tab half as much again"
    )
    pad_pitch_mm: Annotated[float, Field(ge=0.5, le=10)] = Field(
        2.54, description="from pad to pad of the connector: 2.54 crimp contacts, 1 or 0.5 ZIF connectors"
    )
    film_flange_mm: Gap = Field(
        0.8, description="film beyond the footprint on each side, clamped in the frame; only where the film is held"
    )
    tab_length_mm: Size = Field(12.0, description="length of the film's tab beyond the footprint")
    tab_slot_mm: Size = Field(0.5, description="depth of the channel under the tab in the frame")
    shelf_mm: Size = Field(8.0, description="shelf for the tab and its cable tie beyond the frame")
    kerf_mm: Gap = Field(0.1, description="width of the cut of the laser or knife")
    adhesive_thickness_mm: Size = Field(0.05, description="adhesive sheet between the layers")
    sheet_mm: tuple[Positive, Positive] = Field((100.0, 100.0), description="stock sheet for cutting, x and y")


def release_note(kind: str) -> str:
    """How a mould is made to release a kind of rubber: "silicone" or "urethane"."""
    return str(_casting_table()["release"][kind])


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
    """The recipe of a material: the user's, the built-in one, that of its stand-in, or None if it cannot be cast."""
    if material in fabrication.casting:
        return _user_recipe(material, fabrication.casting[material])
    sheet = _casting_table()["sheets"].get(material, {})
    name = sheet.get("cast_as", material)
    if name in fabrication.casting:
        return _user_recipe(name, fabrication.casting[name])
    row = _casting_table()["recipes"].get(name)
    return None if row is None else _built_in_recipe(name, sheet.get("note", ""), row)


def castable_materials(fabrication: Fabrication) -> tuple[str, ...]:
    """Names of the materials that can be cast."""
    stand_ins = [name for name, row in _casting_table()["sheets"].items() if "cast_as" in row]
    return tuple(sorted({*_casting_table()["recipes"], *stand_ins, *fabrication.casting}))


@cache
def _casting_table() -> dict[str, Any]:
    return tomllib.loads(files(__package__).joinpath("casting.toml").read_text("utf-8"))


def _built_in_recipe(name: str, note: str, row: dict[str, Any]) -> Recipe:
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
        release=release_note(row["release"]),
        source=f"{row['source']} (confidence {row['confidence']})",
    )


def _user_recipe(name: str, numbers: CastingNumbers) -> Recipe:
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
    """A component to cast. name : "effector", "medium1" or "medium2"; recipe : that of what is poured."""

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
        name: _component_recipe(name, materials[name], segment, fabrication)
        for name in get_args(Component)
        if name in materials
    }
    return tuple(CastComponent(name, materials[name], recipe) for name, recipe in recipes.items() if recipe)


def sheet_components(segment: Segment, fabrication: Fabrication) -> tuple[str, ...]:
    """Names of the components to cut from sheet, from the top down; the film is not among them. InputError."""
    cast = {component.name for component in cast_components(segment, fabrication)}
    return tuple(layer.name for layer in reversed(layers(segment)) if layer.name not in {"film", *cast})


def _component_recipe(name: Component, material: str, segment: Segment, fabrication: Fabrication) -> Recipe | None:
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
