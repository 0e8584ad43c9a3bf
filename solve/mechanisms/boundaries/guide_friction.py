"""Friction of a guide or a seal beside the load path.

Equation, source and typical values: docs/mechanisms.md#guide-friction.
"""

from typing import Self

from pydantic import Field, model_validator

from geometry.parameters import NonNegative, Positive, require_one_of_each
from solve.mechanisms.base import MechanismType, Parameters, Traits, register, with_physics
from solve.model import Model
from solve.terms.guide import GuideFriction


class RubbingGuide(Parameters):
    """Sliders side by side."""

    friction_force_N: tuple[NonNegative, ...] = Field(description="Coulomb force of each slider")
    presliding_mm: tuple[Positive, ...] = Field(description="one for each force: travel at which it slips from rest")

    @model_validator(mode="after")
    def _sliders(self) -> Self:
        require_one_of_each("slider", friction_force_N=self.friction_force_N, presliding_mm=self.presliding_mm)
        return self


def switch_on(model: Model, component: str, values: RubbingGuide) -> Model:
    """The model with this physics at a component. ValueError where a force drives: who knows what a guide takes."""
    if not any(values.friction_force_N):
        return model
    if model.press.force_N is not None:
        raise ValueError("name = 'guide-friction': a force drives (press.force_N); it needs press.indentation_mm")
    guide = GuideFriction(values.friction_force_N, values.presliding_mm)
    return with_physics(model, added=(*model.physics.added, guide))


GUIDE_FRICTION = register(
    MechanismType(
        name="guide-friction",
        components=("rig",),
        parameters=RubbingGuide,
        switch_on=switch_on,
        off={"friction_force_N": [], "presliding_mm": []},
        example={"friction_force_N": [0.3], "presliding_mm": [0.02]},
        typical={
            "friction_force_N": "a linear ball guide: 0.1 to 2 N; an o-ring under pressure: tens of N (rules of thumb)",
            "presliding_mm": "rolling guides 0.001 to 0.1 mm; a seal of rubber 0.1 to 1 mm (rules of thumb)",
        },
        traits=Traits(adds_up=True, memory=True, acts_on_tables=True),
    )
)
