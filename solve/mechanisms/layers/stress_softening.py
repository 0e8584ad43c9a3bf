"""Ogden-Roxburgh softening.

Equation, source and typical values: docs/mechanisms.md#stress-softening.
"""

from typing import Annotated

from pydantic import Field

from geometry.parameters import NonNegative, Positive
from solve.materials.mullins import Softening
from solve.mechanisms.base import MEDIA, MechanismType, Parameters, Traits, register, with_law
from solve.model import Model


class StressSoftening(Parameters):
    """Ogden-Roxburgh softening."""

    loss_ratio: Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)] = Field(
        description="largest relative loss of stress, 1/r: second against first cycle well below the deepest press"
    )
    energy_MPa: NonNegative = Field(0.0, description="m: energy below which nothing softens")
    beta: Positive = Field(0.3, description="width of the transition back to the first curve")


def switch_on(model: Model, component: str, values: StressSoftening) -> Model:
    """The model with this physics at a component."""
    return with_law(model, component, Softening(values.loss_ratio, values.energy_MPa, values.beta))


STRESS_SOFTENING = register(
    MechanismType(
        name="stress-softening",
        components=MEDIA,
        parameters=StressSoftening,
        switch_on=switch_on,
        off={"loss_ratio": 0.0},
        example={"loss_ratio": 0.4},
        typical={
            "loss_ratio": (
                "0.1 to 0.4 for filled rubber of 5 MPa (rule of thumb); Ecoflex, Sylgard and Smooth-Sil show it "
                "(doi 10.1089/soro.2015.0002)"
            ),
            "energy_MPa": "0; default 0. Energy below which nothing softens",
            "beta": "default 0.3; smaller means a sharper return to the first curve",
        },
        traits=Traits(memory=True, path_dependent=True, shows_on_return=True),
    )
)
