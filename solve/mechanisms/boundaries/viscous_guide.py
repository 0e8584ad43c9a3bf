"""Viscous friction of a guide, with Stribeck's fall at low speed.

Equation, source and typical values: docs/mechanisms.md#viscous-guide.
"""

from pydantic import Field

from geometry.parameters import NonNegative, Positive
from solve.mechanisms.base import MechanismType, Parameters, Traits, in_place, register, with_physics
from solve.model import Model
from solve.terms.guide_viscosity import ViscousGuide


class ViscousFriction(Parameters):
    """A viscous guide."""

    viscous_N_s_per_mm: NonNegative = Field(description="force per velocity")
    stribeck_N: NonNegative = Field(0.0, description="friction at low speed that fades as a film of oil forms")
    stribeck_mm_per_s: Positive = Field(1.0, description="speed at which that has faded to 1/e")


def switch_on(model: Model, component: str, values: ViscousFriction) -> Model:
    """The model with this physics at a component."""
    guide = ViscousGuide(values.viscous_N_s_per_mm, values.stribeck_N, values.stribeck_mm_per_s)
    return with_physics(model, terms=in_place(model.physics.terms, guide))


VISCOUS_GUIDE = register(
    MechanismType(
        name="viscous-guide",
        components=("rig",),
        parameters=ViscousFriction,
        switch_on=switch_on,
        off={"viscous_N_s_per_mm": 0.0, "stribeck_N": 0.0},
        example={"viscous_N_s_per_mm": 1.0, "stribeck_N": 0.5, "stribeck_mm_per_s": 0.5},
        typical={
            "viscous_N_s_per_mm": "a linear drive: 0.01 to 1; 0.2 of one with a carriage of 95 kg",
            "stribeck_N": "0 to 0.5 of the friction that is there at any speed (rule of thumb)",
            "stribeck_mm_per_s": "1 to 50 (Armstrong-Hélouvry et al., 1994)",
        },
        traits=Traits(memory=True, acts_on_tables=True),
    )
)
