"""The dot stands elsewhere.

Equation, source and typical values: docs/mechanisms.md#dot-offset.
"""

from pydantic import Field

from geometry.parameters import Finite
from solve.mechanisms.base import MechanismType, Parameters, Traits, register, with_dot
from solve.model import Model


class DotOffset(Parameters):
    """The dot stands elsewhere."""

    offset_mm: tuple[Finite, Finite] = Field(description="added to the dot's position, x and y")


def switch_on(model: Model, component: str, values: DotOffset) -> Model:
    """The model with this physics at a component."""
    x, y = model.dot.offset_mm
    return with_dot(model, offset_mm=(x + values.offset_mm[0], y + values.offset_mm[1]))


DOT_OFFSET = register(
    MechanismType(
        name="dot-offset",
        components=("dot",),
        parameters=DotOffset,
        switch_on=switch_on,
        off={"offset_mm": [0.0, 0.0]},
        example={"offset_mm": [0.4, 0.0]},
        typical={
            "offset_mm": "0.1 to 0.3 by hand (rule of thumb)",
        },
        traits=Traits(adds_up=True, changes_geometry=True, on_middle_mesh=True),
    )
)
