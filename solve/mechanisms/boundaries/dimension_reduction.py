"""A ridge for a cap, or the reverse.

Equation, source and typical values: docs/mechanisms.md#dimension-reduction.
"""

from dataclasses import replace

from geometry.parameters import SIZED_DOTS
from solve.mechanisms.base import MechanismType, Parameters, Traits, register, with_dot
from solve.model import Model


class DimensionReduction(Parameters):
    """A ridge for a cap, or the reverse."""


def switch_on(model: Model, component: str, values: DimensionReduction) -> Model:
    """The model with this physics at a component."""
    if model.dot.shape not in SIZED_DOTS:
        raise ValueError(f"name = 'dimension-reduction': a {model.dot.shape} is the same in both")
    shape, section = ("ridge", "plane-strain") if model.dot.shape == "cap" else ("cap", "solid")
    return with_dot(replace(model, segment=model.segment.model_copy(update={"section": section})), shape=shape)


DIMENSION_REDUCTION = register(
    MechanismType(
        name="dimension-reduction",
        components=("dot",),
        parameters=DimensionReduction,
        switch_on=switch_on,
        off=None,
        typical={},
        traits=Traits(changes_geometry=True, on_middle_mesh=True),
    )
)
