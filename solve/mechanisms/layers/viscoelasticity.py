"""A Prony series of the stress, or of branches of rubber that flow.

Equation, source and typical values: docs/mechanisms.md#viscoelasticity.
"""

from typing import Any, Self

from pydantic import Field, model_validator

from geometry.parameters import Positive, require_one_of_each
from solve.materials.inelastic import Prony
from solve.materials.multiplicative import MultiplicativeMaxwell
from solve.mechanisms.base import BONDS, MEDIA, MechanismType, Moduli, Parameters, Traits, register, with_physics
from solve.model import Model


class Viscoelasticity(Parameters):
    """A Prony series of the stress (relative_moduli), or of branches that flow (multiplicative_moduli)."""

    relative_moduli: Moduli = Field(description="share of the instantaneous stress that each term relaxes")
    multiplicative_moduli: Moduli = Field(
        (),
        description="in its place, for rubber at large strain: share of the shear modulus that each flowing branch has",
    )
    relaxation_times_s: tuple[Positive, ...] = Field(description="one for each modulus")

    @model_validator(mode="before")
    @classmethod
    def _one_series(cls, values: Any) -> Any:
        flows = isinstance(values, dict) and "multiplicative_moduli" in values
        return {"relative_moduli": (), **values} if flows else values

    @model_validator(mode="after")
    def _series(self) -> Self:
        if self.relative_moduli and self.multiplicative_moduli:
            raise ValueError("relative_moduli and multiplicative_moduli: give one of them")
        name = "multiplicative_moduli" if self.multiplicative_moduli else "relative_moduli"
        moduli = getattr(self, name)
        require_one_of_each("term", **{name: moduli}, relaxation_times_s=self.relaxation_times_s)
        if sum(moduli) >= 1.0:
            raise ValueError(f"{name} = {list(moduli)}: their sum must be below 1")
        return self


def switch_on(model: Model, component: str, values: Viscoelasticity) -> Model:
    """The model with this physics at a component. ValueError where branches should flow that are not of rubber."""
    series = Prony(values.relative_moduli, values.relaxation_times_s)
    if values.multiplicative_moduli:
        if component not in MEDIA or model.materials[component].law.compressible:
            raise ValueError(
                f"parameters.multiplicative_moduli: '{component}' must be a medium of rubber; use relative_moduli"
            )
        series = MultiplicativeMaxwell(values.multiplicative_moduli, values.relaxation_times_s)
    on = {component: series} if sum(series.relative_moduli) > 0.0 else {}
    return with_physics(model, viscosity={**model.physics.viscosity, **on})


VISCOELASTICITY = register(
    MechanismType(
        name="viscoelasticity",
        components=(*MEDIA, "film", *BONDS),
        parameters=Viscoelasticity,
        switch_on=switch_on,
        off={"relative_moduli": [], "relaxation_times_s": []},
        example={"relative_moduli": [0.15, 0.15], "relaxation_times_s": [0.1, 1.0]},
        typical={
            "relative_moduli": (
                "silicones: 0.05, 0.03, 0.02; unfilled natural rubber 2 to 3 % per decade of time, filled 5 to 10 % "
                "(rules of thumb)"
            ),
            "multiplicative_moduli": "as above; of a soft adhesive 0.9 in all",
            "relaxation_times_s": "0.1, 1, 10 with the above",
        },
        traits=Traits(memory=True, acts_on_tables=True),
    )
)
