"""Mass that moves with the dot.

Equation, source and typical values: docs/mechanisms.md#inertia.
"""

from pydantic import Field

from geometry.parameters import NonNegative
from solve.mechanisms.base import MechanismType, Parameters, Traits, in_place, register, with_physics
from solve.model import Model
from solve.terms.inertia import MovingMass


class Inertia(Parameters):
    """Mass that moves with the dot."""

    moving_mass_g: NonNegative = Field(description="mass between the force sensor and the dot")


def switch_on(model: Model, component: str, values: Inertia) -> Model:
    """The model with this physics at a component."""
    return with_physics(model, terms=in_place(model.physics.terms, MovingMass(values.moving_mass_g)))


INERTIA = register(
    MechanismType(
        name="inertia",
        components=("rig",),
        parameters=Inertia,
        switch_on=switch_on,
        off={"moving_mass_g": 0.0},
        example={"moving_mass_g": 10.0},
        typical={
            "moving_mass_g": "the dot, its holder and half of the beam: 5 to 50 g (rule of thumb)",
        },
        traits=Traits(memory=True, acts_on_tables=True),
    )
)
