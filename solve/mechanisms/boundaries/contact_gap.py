"""Lost motion before the touch.

Equation, source and typical values: docs/mechanisms.md#contact-gap.
"""

from pydantic import Field

from geometry.parameters import NonNegative
from solve.mechanisms.base import MechanismType, Parameters, Traits, register, with_dot
from solve.model import Model


class ContactGap(Parameters):
    """Lost motion before the touch."""

    gap_mm: NonNegative = Field(description="travel of the rig before the dot touches")


def switch_on(model: Model, component: str, values: ContactGap) -> Model:
    """The model with this physics at a component."""
    return with_dot(model, gap_mm=model.dot.gap_mm + values.gap_mm)


CONTACT_GAP = register(
    MechanismType(
        name="contact-gap",
        components=("dot",),
        parameters=ContactGap,
        switch_on=switch_on,
        off={"gap_mm": 0.0},
        example={"gap_mm": 0.05},
        typical={
            "gap_mm": "0.01 to 0.1 (rule of thumb)",
        },
        traits=Traits(adds_up=True, acts_on_tables=True),
    )
)
