"""A spring between displacement sensor and dot.

Equation, source and typical values: docs/mechanisms.md#rig-compliance.
"""

from pydantic import Field

from geometry.parameters import NonNegative
from solve.mechanisms.base import MechanismType, Parameters, Traits, in_place, register, with_physics
from solve.model import Model
from solve.terms.rig import RigSpring


class RigCompliance(Parameters):
    """A spring between displacement sensor and dot."""

    compliance_mm_per_N: NonNegative = Field(description="compliance of the rig")


def switch_on(model: Model, component: str, values: RigCompliance) -> Model:
    """The model with this physics at a component."""
    return with_physics(model, terms=in_place(model.physics.terms, RigSpring(values.compliance_mm_per_N)))


RIG_COMPLIANCE = register(
    MechanismType(
        name="rig-compliance",
        components=("rig",),
        parameters=RigCompliance,
        switch_on=switch_on,
        off={"compliance_mm_per_N": 0.0},
        example={"compliance_mm_per_N": 0.005},
        typical={
            "compliance_mm_per_N": (
                "the paper's acrylic beam (2 × 9 mm, 2.8 GPa) bends 0.02 mm/N at 10 mm free length and 0.5 mm/N at "
                "30 mm, l^3 / (3 E I)"
            ),
        },
        traits=Traits(acts_on_tables=True),
    )
)
