"""Coulomb friction of the dot.

Equation, source and typical values: docs/mechanisms.md#friction.
"""

from typing import Annotated

from pydantic import Field

from solve.mechanisms.base import MechanismType, Parameters, Traits, in_place, register, with_physics
from solve.model import Model
from solve.terms.friction import DotFriction


class Friction(Parameters):
    """Coulomb friction of the dot."""

    coefficient: Annotated[float, Field(ge=0, le=3, allow_inf_nan=False)] = Field(description="coefficient of friction")


def switch_on(model: Model, component: str, values: Friction) -> Model:
    """The model with this physics at a component."""
    return with_physics(model, terms=in_place(model.physics.terms, DotFriction(values.coefficient)))


FRICTION = register(
    MechanismType(
        name="friction",
        components=("dot",),
        parameters=Friction,
        switch_on=switch_on,
        off={"coefficient": 0.0},
        example={"coefficient": 0.5},
        typical={
            "coefficient": "0.3 to 1 for dry rubber on plastic (rule of thumb); measure it",
        },
        traits=Traits(memory=True, path_dependent=True, unsymmetric=True),
    )
)
