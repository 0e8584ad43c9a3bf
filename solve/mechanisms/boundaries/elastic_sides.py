"""Springs at the held sides.

Equation, source and typical values: docs/mechanisms.md#elastic-sides.
"""

from dataclasses import replace

from pydantic import Field

from geometry.parameters import NonNegative
from solve.mechanisms.base import MechanismType, Parameters, Traits, register
from solve.model import Model


class ElasticSides(Parameters):
    """Springs at the held sides."""

    stiffness_N_per_mm3: NonNegative = Field(description="normal and tangential traction per displacement")


def switch_on(model: Model, component: str, values: ElasticSides) -> Model:
    """The model with this physics at a component."""
    changes = {"boundary": "elastic", "side_stiffness_N_per_mm3": values.stiffness_N_per_mm3}
    return replace(model, segment=model.segment.model_copy(update=changes))


ELASTIC_SIDES = register(
    MechanismType(
        name="elastic-sides",
        components=("sides",),
        parameters=ElasticSides,
        switch_on=switch_on,
        off=None,
        example={"stiffness_N_per_mm3": 5.0},
        typical={
            "stiffness_N_per_mm3": (
                "a wall of rubber: modulus over thickness, 5 for 1 MPa and 0.2 mm; a printed frame far more"
            ),
        },
        traits=Traits(),
    )
)
