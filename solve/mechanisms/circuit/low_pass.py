"""A low-pass behind the read-out, Butterworth's where no quality is given.

Equation, source and typical values: docs/mechanisms.md#low-pass.
"""

from math import inf
from typing import Annotated, Self

from pydantic import Field, model_validator

from geometry.parameters import NonNegative, Positive
from solve.mechanisms.base import (
    CHANNELS,
    MechanismType,
    Parameters,
    Traits,
    channels_of,
    register,
    with_physics,
)
from solve.model import Model
from solve.readout.channel_parts import ChannelStage
from solve.readout.filters import Filter


class LowPass(Parameters):
    """A low-pass behind the read-out, Butterworth's where no quality is given."""

    cutoff_Hz: Positive = Field(description="frequency at which half the power remains")
    order: Annotated[int, Field(ge=1, le=8)] = Field(1, description="order")
    quality: Annotated[float, Field(gt=0, le=10, allow_inf_nan=False)] | None = Field(
        None, description="quality for order 2: 0.5 two equal RC stages, 0.577 Bessel, 0.707 and none Butterworth"
    )
    delay_s: NonNegative = Field(0.0, description="dead time after the filter, such as that of a converter")

    @model_validator(mode="after")
    def _second_order(self) -> Self:
        if self.quality is not None and self.order != 2:
            raise ValueError(f"quality is for order = 2 only, order is {self.order}")
        return self


def switch_on(model: Model, component: str, values: LowPass) -> Model:
    """The model with this physics at a component."""
    own = Filter(values.cutoff_Hz, values.order, quality=values.quality, delay_s=values.delay_s)
    if component in CHANNELS:
        (channel,) = channels_of(component)
        return with_physics(model, channels=(*model.physics.channels, ChannelStage(channel, own)))
    return with_physics(model, stages=(*model.physics.stages, own))


LOW_PASS = register(
    MechanismType(
        name="low-pass",
        components=("readout", *CHANNELS),
        parameters=LowPass,
        switch_on=switch_on,
        off={"cutoff_Hz": inf},
        example={"cutoff_Hz": 60.0, "order": 2},
        typical={
            "cutoff_Hz": "60 Hz in the paper's rig",
            "order": "1 to 8; default 1",
            "quality": "for order 2 only: 0.5 two equal RC stages, 0.577 Bessel; default Butterworth's 0.707",
            "delay_s": (
                "latency of a converter; a third of the whole delay if order two represents a Bessel filter of "
                "order four"
            ),
        },
        traits=Traits(adds_up=True, electrical=True, acts_on_tables=True, acts_up_to="cutoff_Hz"),
    )
)
