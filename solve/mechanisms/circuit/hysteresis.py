"""Hysteresis of the film without rate: charge that comes behind a play.

Equation, source and typical values: docs/mechanisms.md#hysteresis.
"""

from typing import Self

from pydantic import Field, model_validator

from geometry.parameters import Positive, require_one_of_each
from solve.mechanisms.base import MechanismType, Parameters, Terms, Traits, in_place, register, with_physics
from solve.model import Model
from solve.readout.hysteresis import FilmHysteresis


class Hysteresis(Parameters):
    """Shares of the charge behind plays."""

    play_shares: Terms = Field(description="share of the charge that comes behind each play")
    play_pC: tuple[Positive, ...] = Field(description="one for each share: half the width of its play")
    push_shares: Terms = Field((), description="share of the charge of a push alone that comes behind each play")
    push_play_pC: tuple[Positive, ...] = Field((), description="one for each share of a push")

    @model_validator(mode="after")
    def _plays(self) -> Self:
        require_one_of_each("play", play_shares=self.play_shares, play_pC=self.play_pC)
        require_one_of_each("play", push_shares=self.push_shares, push_play_pC=self.push_play_pC)
        return self


def switch_on(model: Model, component: str, values: Hysteresis) -> Model:
    """The model with this physics at a component."""
    film = FilmHysteresis(values.play_shares, values.play_pC, values.push_shares, values.push_play_pC)
    return with_physics(model, added=in_place(model.physics.added, film))


HYSTERESIS = register(
    MechanismType(
        name="hysteresis",
        components=("film",),
        parameters=Hysteresis,
        switch_on=switch_on,
        off={"play_shares": [], "play_pC": [], "push_shares": [], "push_play_pC": []},
        example={
            "play_shares": [0.1, 0.1],
            "play_pC": [1000.0, 4000.0],
            "push_shares": [0.05],
            "push_play_pC": [2000.0],
        },
        typical={
            "play_shares": "0.02 to 0.3 in all, of soft PZT under MPa; PVDF less (Damjanovic 1997; rule of thumb)",
            "push_shares": "0 where a push and a pull make the same loop, as of poled films (from symmetry)",
            "push_play_pC": "as play_pC",
            "play_pC": "up to half of the largest charge: a wider play never shows in a press (from its definition)",
        },
        traits=Traits(memory=True, charge_alone=True, acts_on_tables=True),
    )
)
