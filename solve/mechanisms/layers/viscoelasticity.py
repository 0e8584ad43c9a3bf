"""A Prony series of the stress, or of branches of rubber that flow.

Equation, source and typical values: docs/mechanisms.md#viscoelasticity.
"""

from typing import Self

from pydantic import Field, model_validator

from geometry.parameters import Positive, require_one_of_each
from solve.materials.multiplicative import MultiplicativeMaxwell
from solve.materials.prony import Prony
from solve.mechanisms.base import BONDS, MEDIA, MechanismType, Moduli, Parameters, Traits, register, with_law
from solve.model import Model


class Viscoelasticity(Parameters):
    """A Prony series."""

    relative_moduli: Moduli = Field(description="share of the instantaneous stress that each term relaxes")
    relaxation_times_s: tuple[Positive, ...] = Field(description="one for each modulus")
    flowing_share: float = Field(
        0.0,
        ge=0.0,
        le=1.0,
        description="of each term, the share that is a branch of rubber that flows, for large strain",
    )

    @model_validator(mode="after")
    def _series(self) -> Self:
        require_one_of_each("term", relative_moduli=self.relative_moduli, relaxation_times_s=self.relaxation_times_s)
        if sum(self.relative_moduli) >= 1.0:
            raise ValueError(f"relative_moduli = {list(self.relative_moduli)}: their sum must be below 1")
        return self


def switch_on(model: Model, component: str, values: Viscoelasticity) -> Model:
    """The model with this physics at a component. ValueError where a share should flow of what is no rubber."""
    series, share = Prony(values.relative_moduli, values.relaxation_times_s), values.flowing_share
    if share > 0.0:
        if component not in MEDIA or model.materials[component].law.compressible:
            raise ValueError(f"parameters.flowing_share = {share:g}: '{component}' is no medium of rubber; must be 0")
        series = MultiplicativeMaxwell(values.relative_moduli, values.relaxation_times_s, share)
    return with_law(model, component, series)


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
            "relaxation_times_s": "0.1, 1, 10 with the above",
            "flowing_share": "1 of soft adhesives and tapes at strains above one; in a press it hardly matters",
        },
        traits=Traits(memory=True, acts_on_tables=True),
    )
)
