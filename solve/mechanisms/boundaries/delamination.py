"""A region without bond, in the middle or along the rim.

Equation, source and typical values: docs/mechanisms.md#delamination.
"""

from typing import Self

from pydantic import Field, model_validator

from geometry.parameters import Finite, NonNegative, Positive
from solve.mechanisms.base import BONDS, MechanismType, Parameters, Traits, register, with_physics
from solve.model import Model
from solve.physics import Delamination


class DelaminationPatch(Parameters):
    """A region without bond."""

    center_mm: tuple[Finite, Finite] = Field((0.0, 0.0), description="centre, x and y")
    diameter_mm: NonNegative = Field(0.0, description="diameter of the disc; plane strain: width of the strip")
    bonded_diameter_mm: Positive | None = Field(
        None, description="the rim has come apart, up to a disc (a strip) of this size; none: it is bonded"
    )

    @model_validator(mode="after")
    def _apart(self) -> Self:
        if self.bonded_diameter_mm is not None and self.bonded_diameter_mm <= self.diameter_mm:
            raise ValueError(
                f"bonded_diameter_mm = {self.bonded_diameter_mm:g}: must be above diameter_mm = {self.diameter_mm:g}"
            )
        return self


def switch_on(model: Model, component: str, values: DelaminationPatch) -> Model:
    """The model with this physics at a component."""
    patches = [Delamination(component, values.center_mm, values.diameter_mm)] if values.diameter_mm > 0.0 else []
    if values.bonded_diameter_mm is not None:
        patches.append(Delamination(component, values.center_mm, values.bonded_diameter_mm, outside=True))
    return with_physics(model, delaminations=(*model.physics.delaminations, *patches)) if patches else model


DELAMINATION = register(
    MechanismType(
        name="delamination",
        components=BONDS,
        parameters=DelaminationPatch,
        switch_on=switch_on,
        off={"diameter_mm": 0.0, "bonded_diameter_mm": None},
        example={"center_mm": [0.7, 0.0], "diameter_mm": 1.0},
        typical={
            "center_mm": "default [0, 0]",
            "diameter_mm": "in a solid it must span several facets of the mesh",
            "bonded_diameter_mm": "glue that lets go from the edge inwards; what is left must span several facets",
        },
        traits=Traits(adds_up=True),
    )
)
