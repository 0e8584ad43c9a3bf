"""Other channels leak into this one.

Equation, source and typical values: docs/mechanisms.md#crosstalk.
"""

from typing import Annotated

from pydantic import Field

from solve.mechanisms.base import CHANNELS, MechanismType, Parameters, Traits, register, with_physics
from solve.model import Model


class Crosstalk(Parameters):
    """Other channels leak into this one."""

    coupling: Annotated[float, Field(gt=-1, lt=1, allow_inf_nan=False)] = Field(
        description="share of the other channels' voltage that adds to this one"
    )


def switch_on(model: Model, component: str, values: Crosstalk) -> Model:
    """The model with this physics at a component."""
    channel = int(component.removeprefix("channel-"))
    return with_physics(model, crosstalk={**model.physics.crosstalk, channel: values.coupling})


CROSSTALK = register(
    MechanismType(
        name="crosstalk",
        components=CHANNELS,
        parameters=Crosstalk,
        switch_on=switch_on,
        off={"coupling": 0.0},
        example={"coupling": 0.2},
        typical={
            "coupling": "measure it: drive one channel, read the others",
        },
        traits=Traits(electrical=True, acts_on_tables=True),
    )
)
