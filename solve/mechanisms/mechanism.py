"""One piece of physics beyond the baseline, as a configuration names it in [[mechanisms]], and a model with it."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, Self

from pydantic import Field, ValidationError, model_validator

from foundation.nearest_name import nearest_name_hint
from geometry.parameters import Table
from solve.mechanisms.base import Traits, in_short
from solve.mechanisms.layers.viscoelasticity import VISCOELASTICITY
from solve.mechanisms.registry import MECHANISMS
from solve.model import Model


class Mechanism(Table):
    """One piece of physics beyond the baseline, switched on at one component."""

    name: str = Field(
        VISCOELASTICITY.name, description="which physics", json_schema_extra={"enum": list[Any](MECHANISMS)}
    )
    component: str = Field(
        "medium2", description="where: a layer, a bond, sides, dot, rig, readout, channel-N or channel-N-channel-M"
    )
    parameters: dict[str, Any] = Field({}, description="its numbers, by name with their unit")

    @model_validator(mode="after")
    def _refuse_unknown_names(self) -> Self:
        if self.name not in MECHANISMS:
            raise ValueError(f"name = '{self.name}': {nearest_name_hint(self.name, MECHANISMS)}")
        kind = MECHANISMS[self.name]
        if self.component not in kind.components:
            raise ValueError(
                f"component = '{self.component}': {self.name} acts on {', '.join(in_short(kind.components))}"
            )
        for name in self.parameters:
            if name not in kind.parameters.model_fields:
                allowed = ", ".join(kind.parameters.model_fields) or "no parameters"
                raise ValueError(f"parameters.{name}: {self.name} takes {allowed}")
        self.values()
        return self

    @property
    def traits(self) -> Traits:
        """Traits of the physics, which others ask for in place of its name."""
        return MECHANISMS[self.name].traits

    def values(self) -> Any:
        """The checked parameters, an instance of the mechanism's table. ValueError with one sentence."""
        try:
            return MECHANISMS[self.name].parameters.model_validate(self.parameters)
        except ValidationError as error:
            raise ValueError(_sentence(self.name, error)) from None

    @property
    def is_off(self) -> bool:
        """Whether its values change nothing."""
        return MECHANISMS[self.name].is_off(self.values())


def with_mechanisms(model: Model, mechanisms: Iterable[Mechanism]) -> Model:
    """The model with these mechanisms, one after the other; with off values it is unchanged in effect.

    ValueError where the model has no such component.
    """
    for one in mechanisms:
        changed = MECHANISMS[one.name].switch_on(model, one.component, one.values())
        model = replace(changed, mechanisms=(*model.mechanisms, one))
    return model


def refuse_repeated(mechanisms: Sequence[Mechanism]) -> None:
    """ValueError for a mechanism twice at one component, where no definition says what two of it are."""
    places: dict[tuple[str, str], int] = {}
    for number, one in enumerate(mechanisms):
        first = places.setdefault((one.name, one.component), number)
        if first != number and not one.traits.adds_up:
            raise ValueError(
                f"mechanisms[{number}].name = '{one.name}': mechanisms[{first}] is the same at '{one.component}', and "
                "two of it do not add up; state it once"
            )


def _sentence(name: str, error: ValidationError) -> str:
    """The first problem: parameters.NAME = value: what is allowed."""
    first = error.errors()[0]
    where = ".".join(["parameters", *(str(part) for part in first["loc"])])
    text = first["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
    if first["type"] == "missing":
        return f"{where} is missing: {name} needs it"
    if first["type"] == "value_error":  # our own text begins with the name of the parameter
        return f"{where}.{text}"
    return f"{where} = {first['input']!r}: {text}"
