"""A wrong number in the configuration.

Equation, source and typical values: docs/mechanisms.md#property-error.
"""

from dataclasses import replace
from typing import Any

from pydantic import Field

from geometry.dot_at_rest import resolve_dot
from geometry.parameters import SIZED_DOTS, Positive
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.mechanisms.base import (
    MEDIA,
    MechanismType,
    Parameters,
    Traits,
    layer_material,
    register,
    with_dot,
    with_layer,
)
from solve.model import Model


class PropertyError(Parameters):
    """A wrong number in the configuration."""

    modulus_factor: Positive = Field(1.0, description="factor on every modulus of the layer")
    thickness_factor: Positive = Field(1.0, description="factor on the thickness of the layer")
    d31_factor: Positive = Field(1.0, description="film: factor on d31, d32 and d33")
    radius_factor: Positive = Field(1.0, description="dot: factor on its radius")
    height_factor: Positive = Field(1.0, description="dot: factor on its height")


ACTS = {"dot": ("radius_factor", "height_factor"), "film": ("modulus_factor", "thickness_factor", "d31_factor")}
"""Component -> its factors; the others have a modulus and a thickness."""


def switch_on(model: Model, component: str, values: PropertyError) -> Model:
    """The model with this physics at a component. ValueError for a factor on what the component does not have."""
    acts = ACTS.get(component, ("modulus_factor", "thickness_factor"))
    flat = component == "dot" and model.dot.shape not in SIZED_DOTS
    for name, value in values:
        if value != 1.0 and (flat or name not in acts):
            instead = f"a {model.dot.shape} has neither radius nor height" if flat else f"it takes {' and '.join(acts)}"
            raise ValueError(f"parameters.{name} = {value:g}: acts not on '{component}'; {instead}")
    if component == "dot":
        return with_dot(model, **_scaled_dot(model, values.radius_factor, values.height_factor))
    material = layer_material(model, component)
    changed = material.model_copy(update=_scaled_constants(material, values))
    return _thicker(with_layer(model, component, changed), component, values.thickness_factor)


def _scaled_constants(material: Material, values: Any) -> dict[str, Any]:
    """The material with every modulus times modulus_factor and, of a film, every piezoelectric constant times
    d31_factor.
    """
    changes: dict[str, Any] = {}
    for name in type(material).model_fields:
        value = getattr(material, name)
        if name.endswith("_MPa") and name != "yield_stress_MPa" and value is not None:
            factor = values.modulus_factor
            changes[name] = tuple(factor * v for v in value) if isinstance(value, tuple) else factor * value
    if isinstance(material, PiezoelectricFilm):
        for name in ("d31_pC_per_N", "d32_pC_per_N", "d33_pC_per_N"):
            changes[name] = values.d31_factor * getattr(material, name)
    return changes


def _thicker(model: Model, component: str, factor: float) -> Model:
    key = {"film": "thickness_um", "effector": "height_mm"}.get(component, "thickness_mm")
    layer = getattr(model.segment, component)
    changed = layer.model_copy(update={key: factor * getattr(layer, key)})
    return replace(model, segment=model.segment.model_copy(update={component: changed}))


def _scaled_dot(model: Model, radius_factor: float, height_factor: float) -> dict[str, Any]:
    if radius_factor == height_factor == 1.0:
        return {}
    shape = resolve_dot(model.dot, model.segment)
    return {
        "standard": None,
        "base_diameter_mm": None,
        "radius_mm": radius_factor * shape.radius_mm,
        "height_mm": height_factor * shape.height_mm,
    }


PROPERTY_ERROR = register(
    MechanismType(
        name="property-error",
        components=(*MEDIA, "film", "dot"),
        parameters=PropertyError,
        switch_on=switch_on,
        off=dict.fromkeys(PropertyError.model_fields, 1.0),
        example={"modulus_factor": 1.3},
        typical={
            "modulus_factor": (
                "silicones ±30 %, soft Ecoflex ±50 %: measurements and data sheets differ by up to a factor of 3.5 "
                "(Soft Robotics Materials Database, doi 10.1089/soro.2019.0115)"
            ),
            "thickness_factor": "±10 % of a sheet of 0.5 mm (rule of thumb)",
            "d31_factor": "±20 % from lot to lot (rule of thumb)",
            "radius_factor": "Braille standards allow ±10 % and more (sizes)",
            "height_factor": "Braille standards allow ±10 % and more (sizes)",
        },
        traits=Traits(adds_up=True, acts_on_tables=True, changes_geometry=True, on_middle_mesh=True, wrong_number=True),
    )
)
