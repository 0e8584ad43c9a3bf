"""A temperature step of the film.

Equation, source and typical values: docs/mechanisms.md#pyroelectric-drift.
"""

from pydantic import Field

from geometry.parameters import Finite, Positive
from solve.mechanisms.base import MechanismType, Parameters, Traits, in_place, register, with_physics
from solve.model import Model
from solve.readout.heat_and_touch import Pyroelectric


class PyroelectricDrift(Parameters):
    """A temperature step of the film."""

    temperature_step_K: Finite = Field(description="final change of temperature")
    time_constant_s: Positive = Field(1.0, description="time constant of the exponential approach after first touch")


def switch_on(model: Model, component: str, values: PyroelectricDrift) -> Model:
    """The model with this physics at a component."""
    heat = Pyroelectric(values.temperature_step_K, values.time_constant_s)
    return with_physics(model, added=in_place(model.physics.added, heat))


PYROELECTRIC_DRIFT = register(
    MechanismType(
        name="pyroelectric-drift",
        components=("film",),
        parameters=PyroelectricDrift,
        switch_on=switch_on,
        off={"temperature_step_K": 0.0},
        example={"temperature_step_K": 5.0, "time_constant_s": 0.5},
        typical={
            "temperature_step_K": (
                "a finger is about 10 K warmer than the room (rule of thumb); p: PVDF 30, P(VDF-TrFE) 40 µC/m²K "
                "(MSI manual, p. 3)"
            ),
            "time_constant_s": "0.1 to 10 s by the layers between dot and film (rule of thumb); default 1",
        },
        traits=Traits(memory=True, charge_alone=True, acts_on_tables=True),
    )
)
