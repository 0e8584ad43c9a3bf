"""A region without bond.

Equation, source and typical values: docs/mechanisms.md#delamination.
"""

from pydantic import Field

from geometry.parameters import Finite, NonNegative
from solve.mechanisms.base import BONDS, MechanismType, Parameters, Traits, register, with_physics
from solve.model import Delamination, Model


class DelaminationPatch(Parameters):
    """A region without bond."""

    center_mm: tuple[Finite, Finite] = Field((0.0, 0.0), description="centre, x and y")
    diameter_mm: NonNegative = Field(description="diameter of the disc; plane strain: width of the strip")


def switch_on(model: Model, component: str, values: DelaminationPatch) -> Model:
    """The model with this physics at a component."""
    if values.diameter_mm == 0.0:
        return model
    patch = Delamination(component, values.center_mm, values.diameter_mm)
    return with_physics(model, delaminations=(*model.physics.delaminations, patch))


DELAMINATION = register(
    MechanismType(
        name="delamination",
        components=BONDS,
        parameters=DelaminationPatch,
        switch_on=switch_on,
        off={"diameter_mm": 0.0},
        example={"center_mm": [0.7, 0.0], "diameter_mm": 1.0},
        typical={
            "center_mm": "default [0, 0]",
            "diameter_mm": "must span several facets of the mesh",
        },
        traits=Traits(adds_up=True),
    )
)
