"""Stiffness of a bond, directly or as a layer of glue.

Equation, source and typical values: docs/mechanisms.md#adhesive-compliance.
"""

from math import inf
from typing import Annotated, Self

from pydantic import Field, model_validator

from geometry.parameters import STATED, ActsWith, BondStiffness, Positive
from solve.mechanisms.base import (
    BONDS,
    MechanismType,
    Parameters,
    Traits,
    register,
    with_physics,
)
from solve.model import Model
from solve.physics import BondLine
from solve.terms.bond import layer_stiffness


class AdhesiveCompliance(Parameters):
    """Stiffness of a bond, directly or as a layer of glue."""

    normal_stiffness_N_per_mm3: BondStiffness | None = Field(None, description="traction per opening")
    shear_stiffness_N_per_mm3: BondStiffness | None = Field(None, description="traction per slip")
    thickness_um: Positive | None = Field(None, description="thickness of the glue, instead of the stiffnesses")
    youngs_modulus_MPa: Positive | None = Field(None, description="modulus of the glue")
    poisson_ratio: Annotated[float, Field(ge=0, lt=0.5), ActsWith(thickness_um=STATED)] = Field(
        0.45, description="Poisson's ratio of the glue"
    )

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        stiffness = (self.normal_stiffness_N_per_mm3, self.shear_stiffness_N_per_mm3)
        glue = (self.thickness_um, self.youngs_modulus_MPa)
        if (None in stiffness) == (None in glue) or (stiffness.count(None) == 1 or glue.count(None) == 1):
            raise ValueError(
                "normal_stiffness_N_per_mm3 and shear_stiffness_N_per_mm3, or thickness_um and youngs_modulus_MPa: "
                "give one pair"
            )
        return self


def switch_on(model: Model, component: str, values: AdhesiveCompliance) -> Model:
    """The model with this physics at a component."""
    return with_physics(model, bonds={**model.physics.bonds, component: BondLine(*_stiffness(values))})


def _stiffness(values: AdhesiveCompliance) -> tuple[float, float]:
    """Normal and shear stiffness, as stated or of the layer of glue."""
    if values.thickness_um is not None and values.youngs_modulus_MPa is not None:
        return layer_stiffness(values.thickness_um, values.youngs_modulus_MPa, values.poisson_ratio)
    assert values.normal_stiffness_N_per_mm3 is not None
    assert values.shear_stiffness_N_per_mm3 is not None
    return values.normal_stiffness_N_per_mm3, values.shear_stiffness_N_per_mm3


ADHESIVE_COMPLIANCE = register(
    MechanismType(
        name="adhesive-compliance",
        components=BONDS,
        parameters=AdhesiveCompliance,
        switch_on=switch_on,
        off={"normal_stiffness_N_per_mm3": inf, "shear_stiffness_N_per_mm3": inf},
        example={"thickness_um": 30.0, "youngs_modulus_MPa": 0.15},
        typical={
            "normal_stiffness_N_per_mm3": "from the glue below: 3 to 400",
            "shear_stiffness_N_per_mm3": "0.2 to 35",
            "thickness_um": "spray glue 10 to 50, double-sided tape 50 to 150 (rule of thumb)",
            "youngs_modulus_MPa": (
                "0.1 to 1; pressure-sensitive glues have G below 0.1 MPa (arrowoodmaterials.com, 2025)"
            ),
            "poisson_ratio": "default 0.45; with 0.49 the normal stiffness is 4.5 times larger",
        },
        traits=Traits(),
    )
)
