"""Other channels leak into this one, or two into each other.

Equation, source and typical values: docs/mechanisms.md#crosstalk.
"""

from typing import Annotated

from pydantic import Field

from geometry.parameters import NonNegative
from solve.mechanisms.base import (
    CHANNEL_PAIRS,
    CHANNELS,
    MechanismType,
    Parameters,
    Traits,
    channels_of,
    register,
    with_physics,
)
from solve.model import Model
from solve.readout.channel_parts import ChannelPart, Coupling, MutualCapacitance


class Crosstalk(Parameters):
    """Other channels leak into this one, or two into each other."""

    coupling: Annotated[float, Field(gt=-1, lt=1, allow_inf_nan=False)] = Field(
        0.0, description="one channel: share of the other channels' voltage that adds to this one"
    )
    capacitance_pF: NonNegative = Field(0.0, description="two channels: capacitance between their inputs")


def switch_on(model: Model, component: str, values: Crosstalk) -> Model:
    """The model with this physics at a component. ValueError for a number that is of the other kind of component."""
    channels = channels_of(component)
    if len(channels) == 1:
        _refuse("capacitance_pF", values.capacitance_pF, "two channels", "one takes coupling")
        return _with(model, Coupling(channels[0], values.coupling))
    _refuse("coupling", values.coupling, "one channel", "two take capacitance_pF")
    one, other = channels
    return _with(model, MutualCapacitance(one, other, values.capacitance_pF))


def _with(model: Model, part: ChannelPart) -> Model:
    """The model with a part in place of another one of the same kind between the same channels."""
    known = model.physics.channels
    others = (one for one in known if type(one) is not type(part) or one.channels != part.channels)
    return with_physics(model, channels=(*others, part))


def _refuse(name: str, value: float, what: str, instead: str) -> None:
    if value != 0.0:
        raise ValueError(f"parameters.{name} = {value:g}: is of {what}, {instead}")


CROSSTALK = register(
    MechanismType(
        name="crosstalk",
        components=(*CHANNELS, *CHANNEL_PAIRS),
        parameters=Crosstalk,
        switch_on=switch_on,
        off={"coupling": 0.0, "capacitance_pF": 0.0},
        example={"coupling": 0.2},
        typical={
            "coupling": "measure it: drive one channel, read the others",
            "capacitance_pF": "50 pF for each metre of ribbon cable, 0.1 to 5 pF between traces (rule of thumb)",
        },
        parallel_to_input=CHANNEL_PAIRS,
        traits=Traits(electrical=True, acts_on_tables=True),
    )
)
