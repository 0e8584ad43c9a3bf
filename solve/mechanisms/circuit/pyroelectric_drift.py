"""A temperature step of the film.

Equation, source and typical values: docs/mechanisms.md#pyroelectric-drift.
"""

from pydantic import Field

from geometry.parameters import Finite, Positive
from solve.mechanisms.base import MechanismType, Parameters, Traits, register, with_physics
from solve.model import Model, Pyroelectric


class PyroelectricDrift(Parameters):
    """A temperature step of the film."""

    temperature_step_K: Finite = Field(description="final change of temperature")
    time_constant_s: Positive = Field(1.0, description="time constant of the approach after first touch")
    conduction_share: float = Field(
        0.0,
        ge=0.0,
        le=1.0,
        description="of the step, what is conducted into a half-space; the rest comes exponentially",
    )


def switch_on(model: Model, component: str, values: PyroelectricDrift) -> Model:
    """The model with this physics at a component."""
    heat = Pyroelectric(values.temperature_step_K, values.time_constant_s, values.conduction_share)
    return with_physics(model, pyroelectric=heat)


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
            "conduction_share": "1 on thick layers, 0 on thin ones; default 0",
        },
        traits=Traits(memory=True, acts_on_tables=True),
    )
)
