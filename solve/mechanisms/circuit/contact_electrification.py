"""Charge that the touch leaves on the electrodes.

Equation, source and typical values: docs/mechanisms.md#contact-electrification.
"""

from pydantic import Field

from geometry.parameters import Finite, Positive
from solve.mechanisms.base import MechanismType, Parameters, Traits, in_place, register, with_physics
from solve.model import Model
from solve.readout.heat_and_touch import ContactCharge


class ContactElectrification(Parameters):
    """Charge that the touch leaves on the electrodes."""

    charge_pC: Finite = Field(description="charge at the largest contact area; by a power of the area before that")
    area_exponent: Positive = Field(1.0, le=10.0, description="of that power; 1: in proportion to the area")


def switch_on(model: Model, component: str, values: ContactElectrification) -> Model:
    """The model with this physics at a component."""
    touch = ContactCharge(values.charge_pC, values.area_exponent)
    return with_physics(model, added=in_place(model.physics.added, touch))


CONTACT_ELECTRIFICATION = register(
    MechanismType(
        name="contact-electrification",
        components=("film",),
        parameters=ContactElectrification,
        switch_on=switch_on,
        off={"charge_pC": 0.0},
        example={"charge_pC": 4000.0},
        typical={
            "charge_pC": "0.1 to 10 times the signal with an input of gigaohms (rule of thumb); either sign",
            "area_exponent": "1: every spot touched is charged alike; 0.5 to 2 where pressure matters (rule of thumb)",
        },
        traits=Traits(charge_alone=True, acts_on_tables=True),
    )
)
