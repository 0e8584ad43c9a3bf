"""The layer as a hyperfoam.

Equation, source and typical values: docs/mechanisms.md#foam-densification.
"""

from pydantic import Field

from solve.materials.parameters import Hyperfoam
from solve.mechanisms.base import MEDIA, MechanismType, Parameters, Terms, Traits, layer_material, register, with_layer
from solve.model import Model


class FoamDensification(Parameters):
    """The layer as a hyperfoam."""

    mu_MPa: Terms = Field(description="modulus of each term")
    alpha: Terms = Field(description="exponent of each term")
    poisson_ratio: Terms = Field(description="Poisson's ratio of each term")


def switch_on(model: Model, component: str, values: FoamDensification) -> Model:
    """The model with this physics at a component."""
    density = layer_material(model, component).density_kg_m3
    new = Hyperfoam(mu_MPa=values.mu_MPa, alpha=values.alpha, poisson_ratio=values.poisson_ratio, density_kg_m3=density)
    return with_layer(model, component, new)


FOAM_DENSIFICATION = register(
    MechanismType(
        name="foam-densification",
        components=MEDIA,
        parameters=FoamDensification,
        switch_on=switch_on,
        off=None,
        example={"mu_MPa": [0.025], "alpha": [12.0], "poisson_ratio": [0.05]},
        typical={
            "mu_MPa": "0.025 for an open-cell foam of 50 kPa (rule of thumb)",
            "alpha": "8 to 20: soft plateau (rule of thumb); larger means an earlier and flatter plateau",
            "poisson_ratio": (
                "0 to 0.1; measured 0.5 at 5 % falling to −0.05 at 66 % compression (doi "
                "10.1016/j.ijengsci.2007.09.002)"
            ),
        },
        traits=Traits(),
    )
)
