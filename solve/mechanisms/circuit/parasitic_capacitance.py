"""A capacitance parallel to the read-out's.

Equation, source and typical values: docs/mechanisms.md#parasitic-capacitance.
"""

from pydantic import Field

from geometry.parameters import NonNegative
from solve.mechanisms.base import MechanismType, Parameters, Traits, register, with_readout
from solve.model import Model, Readout


class ParasiticCapacitance(Parameters):
    """A capacitance parallel to the read-out's."""

    capacitance_pF: NonNegative = Field(description="capacitance added to that of the input")


def switch_on(model: Model, component: str, values: ParasiticCapacitance) -> Model:
    """The model with this physics at a component."""
    have = (model.readout or Readout()).input_capacitance_pF
    return with_readout(model, input_capacitance_pF=have + values.capacitance_pF)


PARASITIC_CAPACITANCE = register(
    MechanismType(
        name="parasitic-capacitance",
        components=("readout",),
        parameters=ParasiticCapacitance,
        switch_on=switch_on,
        off={"capacitance_pF": 0.0},
        example={"capacitance_pF": 100.0},
        typical={
            "capacitance_pF": (
                "oscilloscope input 10 to 20 pF, amplifier up to 100 pF, cable about 100 pF/m (rule of thumb); a "
                "film of 2.5 × 2.5 mm and 28 µm itself has 24 pF"
            ),
        },
        parallel_to_input=("readout",),
        traits=Traits(adds_up=True, electrical=True, acts_on_tables=True),
    )
)
