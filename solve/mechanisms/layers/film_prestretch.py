"""The film was stretched before it was bonded.

Equation, source and typical values: docs/mechanisms.md#film-prestretch.
"""

from pydantic import Field

from solve.mechanisms.base import MechanismType, Parameters, Strain, Traits, register, with_physics
from solve.model import Model


class FilmPrestretch(Parameters):
    """The film was stretched before it was bonded."""

    strain_x: Strain = Field(0.0, description="nominal strain in x")
    strain_y: Strain = Field(0.0, description="nominal strain in y")


def switch_on(model: Model, component: str, values: FilmPrestretch) -> Model:
    """The model with this physics at a component."""
    return with_physics(model, prestretch=(values.strain_x, values.strain_y))


FILM_PRESTRETCH = register(
    MechanismType(
        name="film-prestretch",
        components=("film",),
        parameters=FilmPrestretch,
        switch_on=switch_on,
        off={"strain_x": 0.0, "strain_y": 0.0},
        example={"strain_x": 0.005},
        typical={
            "strain_x": "0.1 to 1 % (rule of thumb); the yield strain is 2 to 3 %",
            "strain_y": "as strain_x",
        },
        traits=Traits(),
    )
)
