"""Plasticity of the film.

Equation, source and typical values: docs/mechanisms.md#film-yield.
"""

from math import inf

from pydantic import Field

from geometry.parameters import NonNegative, Positive
from solve.materials.film_yield import Yield
from solve.mechanisms.base import (
    MechanismType,
    Parameters,
    Traits,
    register,
    with_law,
)
from solve.model import Model


class FilmYield(Parameters):
    """Plasticity of the film."""

    yield_stress_MPa: Positive = Field(description="von Mises stress at which the film yields")
    hardening_modulus_MPa: NonNegative = Field(0.0, description="0: perfectly plastic")


def switch_on(model: Model, component: str, values: FilmYield) -> Model:
    """The model with this physics at a component."""
    return with_law(model, component, Yield(values.yield_stress_MPa, values.hardening_modulus_MPa))


FILM_YIELD = register(
    MechanismType(
        name="film-yield",
        components=("film",),
        parameters=FilmYield,
        switch_on=switch_on,
        off={"yield_stress_MPa": inf},
        example={"yield_stress_MPa": 45.0},
        typical={
            "yield_stress_MPa": "45 to 55 along the draw direction (MSI manual, p. 3)",
            "hardening_modulus_MPa": "0, perfectly plastic; default 0",
        },
        traits=Traits(memory=True, path_dependent=True, shows_on_return=True),
    )
)
