"""Another law of the same layer: Yeoh or Mooney-Rivlin (c10 ...), Knowles (b, n), or Ogden (mu, alpha).

Equation, source and typical values: docs/mechanisms.md#hyperelastic-stiffening.
"""

from typing import Self

import numpy as np
from pydantic import Field, model_validator

from geometry.parameters import Finite
from solve.materials.parameters import Knowles, Material, MooneyRivlin, Ogden, Power, StiffeningRate, Yeoh
from solve.mechanisms.base import MEDIA, MechanismType, Parameters, Terms, Traits, layer_material, register, with_layer
from solve.model import Model


class HyperelasticStiffening(Parameters):
    """Another law of the same layer: Yeoh or Mooney-Rivlin (c10 ...), Knowles (b, n), or Ogden (mu, alpha)."""

    c10_MPa: Finite | None = Field(
        None, description="Yeoh, Mooney-Rivlin or Knowles; none: half the layer's shear modulus"
    )
    c01_MPa: Finite | None = Field(None, description="Mooney-Rivlin")
    c20_MPa: Finite | None = Field(None, description="Yeoh")
    c30_MPa: Finite | None = Field(None, description="Yeoh")
    b: StiffeningRate | None = Field(None, description="Knowles, how soon it stiffens with I1 - 3")
    n: Power | None = Field(None, description="Knowles, exponent; none: the exponential law of Fung")
    mu_MPa: Terms | None = Field(None, description="Ogden, one per term")
    alpha: Terms | None = Field(None, description="Ogden, one per term")

    @model_validator(mode="after")
    def _one_law(self) -> Self:
        polynomial = [self.c01_MPa, self.c20_MPa, self.c30_MPa]
        if (self.mu_MPa is None) != (self.alpha is None):
            raise ValueError("mu_MPa and alpha make an Ogden law together: give both")
        if self.n is not None and self.b is None:
            raise ValueError("n is the exponent of a law that needs b too: give both")
        laws = [self.c01_MPa, next((c for c in polynomial[1:] if c is not None), None), self.b, self.mu_MPa]
        if sum(law is not None for law in laws) > 1 or (self.mu_MPa is not None and self.c10_MPa is not None):
            raise ValueError(
                "c01_MPa, or c20_MPa and c30_MPa, or b and n, or mu_MPa and alpha: give the constants of one law"
            )
        return self


def switch_on(model: Model, component: str, values: HyperelasticStiffening) -> Model:
    """The model with this physics at a component."""
    old = layer_material(model, component)
    common = {"poisson_ratio": float(np.ravel(old.poisson_ratio)[0]), "density_kg_m3": old.density_kg_m3}
    c10 = values.c10_MPa if values.c10_MPa is not None else 0.5 * old.shear_modulus_MPa
    new: Material
    if values.mu_MPa is not None:
        new = Ogden(mu_MPa=values.mu_MPa, alpha=values.alpha, **common)
    elif values.b is not None:
        new = Knowles(c10_MPa=c10, b=values.b, n=values.n, **common)
    elif values.c01_MPa is not None:
        new = MooneyRivlin(c10_MPa=c10, c01_MPa=values.c01_MPa, **common)
    else:
        new = Yeoh(c10_MPa=c10, c20_MPa=values.c20_MPa or 0.0, c30_MPa=values.c30_MPa or 0.0, **common)
    return with_layer(model, component, new)


HYPERELASTIC_STIFFENING = register(
    MechanismType(
        name="hyperelastic-stiffening",
        components=MEDIA,
        parameters=HyperelasticStiffening,
        switch_on=switch_on,
        off={**dict.fromkeys(HyperelasticStiffening.model_fields), "c20_MPa": 0.0},
        example={"c20_MPa": 0.1, "c30_MPa": 0.05},
        typical={
            "c10_MPa": "library of silicones: 0.0036 (Ecoflex 00-10) to 0.163 (RTV615)",
            "c01_MPa": "a fifth to a half of c10_MPa (rule of thumb)",
            "c20_MPa": (
                "RTV615: 0.0139, 0.00094; Dragon Skin 30: 0.0064, −0.00015 (fits to the Soft Robotics Materials "
                "Database, doi 10.1089/soro.2019.0115)"
            ),
            "c30_MPa": (
                "RTV615: 0.0139, 0.00094; Dragon Skin 30: 0.0064, −0.00015 (fits to the Soft Robotics Materials "
                "Database, doi 10.1089/soro.2019.0115)"
            ),
            "b": "silicones 0.05 to 0.3 (c20 / c10 of the library, times 2); soft tissue 1 to 40 (rule of thumb)",
            "n": "1 neo-Hookean, 2 Yeoh's quadratic, none exponential",
            "mu_MPa": "natural rubber: 0.63, 0.0012, −0.01 with 1.3, 5, −2 (often used; rule of thumb)",
            "alpha": "natural rubber: 0.63, 0.0012, −0.01 with 1.3, 5, −2 (often used; rule of thumb)",
        },
        traits=Traits(),
    )
)
