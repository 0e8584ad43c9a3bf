"""A resistance parallel to the read-out's.

Equation, source and typical values: docs/mechanisms.md#charge-leakage.
"""

from math import inf

from pydantic import Field

from geometry.parameters import Positive
from solve.mechanisms.base import (
    CHANNELS,
    MechanismType,
    Parameters,
    Traits,
    channels_of,
    register,
    with_physics,
    with_readout,
)
from solve.model import Model, Readout
from solve.readout.channel_parts import ChannelLeak


class ChargeLeakage(Parameters):
    """A resistance parallel to the read-out's."""

    resistance_MOhm: Positive = Field(description="resistance parallel to the input resistance")


def switch_on(model: Model, component: str, values: ChargeLeakage) -> Model:
    """The model with this physics at a component: an input of its own where that is a channel."""
    if component in CHANNELS:
        (channel,) = channels_of(component)
        leak = ChannelLeak(channel, 1.0 / values.resistance_MOhm)
        return with_physics(model, channels=(*model.physics.channels, leak))
    have = (model.readout or Readout()).input_resistance_MOhm
    conductance = 1.0 / values.resistance_MOhm + (1.0 / have if have is not None else 0.0)
    return with_readout(model, input_resistance_MOhm=1.0 / conductance)


CHARGE_LEAKAGE = register(
    MechanismType(
        name="charge-leakage",
        components=("readout", "film", *CHANNELS),
        parameters=ChargeLeakage,
        switch_on=switch_on,
        off={"resistance_MOhm": inf},
        example={"resistance_MOhm": 1000.0},
        typical={
            "resistance_MOhm": (
                "PVDF has more than 10^13 Ωm (MSI manual, p. 3): some TΩ for 40 mm² of 28 µm. Moisture, solder flux "
                "and cables are worse: 0.1 to 10 GΩ (rule of thumb)"
            ),
        },
        parallel_to_input=("readout", "film", *CHANNELS),
        traits=Traits(adds_up=True, electrical=True, acts_on_tables=True),
    )
)
