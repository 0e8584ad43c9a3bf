"""A sine added to the voltage.

Equation, source and typical values: docs/mechanisms.md#mains-hum.
"""

from pydantic import Field

from geometry.parameters import NonNegative, Positive
from solve.mechanisms.base import MechanismType, Parameters, Traits, register, with_physics
from solve.model import Model
from solve.readout.stages import Hum


class MainsHum(Parameters):
    """A sine added to the voltage."""

    frequency_Hz: Positive = Field(50.0, description="frequency of the mains")
    amplitude_V: NonNegative = Field(description="amplitude of the sine")


def switch_on(model: Model, component: str, values: MainsHum) -> Model:
    """The model with this physics at a component."""
    return with_physics(model, stages=(*model.physics.stages, Hum(values.frequency_Hz, values.amplitude_V)))


MAINS_HUM = register(
    MechanismType(
        name="mains-hum",
        components=("readout",),
        parameters=MainsHum,
        switch_on=switch_on,
        off={"amplitude_V": 0.0},
        example={"frequency_Hz": 50.0, "amplitude_V": 0.05},
        typical={
            "frequency_Hz": "50 or 60; default 50",
            "amplitude_V": "0.01 to 0.5 V for an unshielded film with an input of gigaohms (rule of thumb)",
        },
        traits=Traits(adds_up=True, electrical=True, acts_up_to="frequency_Hz", free_phase=True),
    )
)
