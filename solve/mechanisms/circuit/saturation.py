"""The amplifier's limit.

Equation, source and typical values: docs/mechanisms.md#saturation.
"""

from math import inf
from typing import Annotated

import numpy as np
from pydantic import Field

from geometry.parameters import Positive
from solve.mechanisms.base import (
    MechanismType,
    Parameters,
    Traits,
    register,
    with_physics,
)
from solve.model import Model
from solve.readout.stages import Saturation


class SaturationLimit(Parameters):
    """The amplifier's limit."""

    limit_V: Positive = Field(description="the voltage stays between plus and minus this")
    sharpness: Annotated[float, Field(ge=1, le=1000, allow_inf_nan=False)] | None = Field(
        None, description="sharpness of the knee: 2.5 is close to tanh; none: a hard limit"
    )


def switch_on(model: Model, component: str, values: SaturationLimit) -> Model:
    """The model with this physics at a component."""
    sharpness = np.inf if values.sharpness is None else values.sharpness
    return with_physics(model, stages=(*model.physics.stages, Saturation(values.limit_V, sharpness)))


SATURATION = register(
    MechanismType(
        name="saturation",
        components=("readout",),
        parameters=SaturationLimit,
        switch_on=switch_on,
        off={"limit_V": inf},
        example={"limit_V": 10.0},
        typical={
            "limit_V": "the supply of the amplifier; ±10 V is common (rule of thumb)",
            "sharpness": "p above: 2.5 is close to a hyperbolic tangent, 10 to most amplifiers (rule of thumb)",
        },
        traits=Traits(adds_up=True, electrical=True, acts_on_tables=True),
    )
)
