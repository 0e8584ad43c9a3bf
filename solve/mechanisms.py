"""The names of physics beyond the baseline: where each mechanism may sit and what it is given."""

from collections.abc import Sequence
from typing import Any, NamedTuple, Self

from pydantic import Field, ValidationError, model_validator

from geometry.base import nearest
from geometry.parameters import Table
from solve import mechanism_parameters as given

MEDIA = ("effector", "medium1", "medium2")
BONDS = ("bond-effector-medium1", "bond-medium1-film", "bond-film-medium2", "bond-base")
CHANNELS = tuple(f"channel-{n}" for n in range(1, 17))


class Kind(NamedTuple):
    """Where a mechanism may sit and the table of its parameters.

    adds_up : several at one component have one meaning, as their effects add up, multiply or stand in series.
    """

    components: tuple[str, ...]
    parameters: type[Table]
    adds_up: bool = False


MECHANISMS: dict[str, Kind] = {
    "charge-leakage": Kind(("readout", "film"), given.ChargeLeakage, adds_up=True),
    "parasitic-capacitance": Kind(("readout",), given.ParasiticCapacitance, adds_up=True),
    "low-pass": Kind(("readout",), given.LowPass, adds_up=True),
    "saturation": Kind(("readout",), given.Saturation, adds_up=True),
    "mains-hum": Kind(("readout",), given.MainsHum, adds_up=True),
    "pyroelectric-drift": Kind(("film",), given.PyroelectricDrift),
    "contact-electrification": Kind(("film",), given.ContactElectrification),
    "viscoelasticity": Kind((*MEDIA, "film", *BONDS), given.Viscoelasticity),
    "hyperelastic-stiffening": Kind(MEDIA, given.HyperelasticStiffening),
    "foam-densification": Kind(MEDIA, given.FoamDensification),
    "stress-softening": Kind(MEDIA, given.StressSoftening),
    "film-yield": Kind(("film",), given.FilmYield),
    "adhesive-compliance": Kind(BONDS, given.AdhesiveCompliance),
    "delamination": Kind(BONDS, given.DelaminationPatch, adds_up=True),
    "friction": Kind(("dot",), given.Friction),
    "elastic-sides": Kind(("sides",), given.ElasticSides),
    "dot-offset": Kind(("dot",), given.DotOffset, adds_up=True),
    "contact-gap": Kind(("dot",), given.ContactGap, adds_up=True),
    "rig-compliance": Kind(("rig",), given.RigCompliance),
    "film-prestretch": Kind(("film",), given.FilmPrestretch),
    "inertia": Kind(("rig",), given.Inertia),
    "crosstalk": Kind(CHANNELS, given.Crosstalk),
    "property-error": Kind((*MEDIA, "film", "dot"), given.PropertyError, adds_up=True),
    "dimension-reduction": Kind(("dot",), given.DimensionReduction),
}


def refuse_repeated(mechanisms: Sequence["Mechanism"]) -> None:
    """ValueError for a mechanism twice at one component, where no definition says what two of it are."""
    places: dict[tuple[str, str], int] = {}
    for number, one in enumerate(mechanisms):
        first = places.setdefault((one.name, one.component), number)
        if first != number and not MECHANISMS[one.name].adds_up:
            raise ValueError(
                f"mechanisms[{number}].name = '{one.name}': mechanisms[{first}] is the same at '{one.component}', and "
                "two of it do not add up; state it once"
            )


class Mechanism(Table):
    """One piece of physics beyond the baseline, switched on at one component."""

    name: str = Field("viscoelasticity", description="which physics", json_schema_extra={"enum": list(MECHANISMS)})
    component: str = Field("medium2", description="where: a layer, a bond, sides, dot, rig, readout or channel-N")
    parameters: dict[str, Any] = Field({}, description="its numbers, by name with their unit")

    @model_validator(mode="after")
    def _known(self) -> Self:
        if self.name not in MECHANISMS:
            raise ValueError(f"name = '{self.name}': {nearest(self.name, MECHANISMS)}")
        components, table, _ = MECHANISMS[self.name]
        if self.component not in components:
            raise ValueError(f"component = '{self.component}': {self.name} acts on {', '.join(components)}")
        for name in self.parameters:
            if name not in table.model_fields:
                allowed = ", ".join(table.model_fields) or "no parameters"
                raise ValueError(f"parameters.{name}: {self.name} takes {allowed}")
        self.values()
        return self

    def values(self) -> Any:
        """The checked parameters, an instance of the mechanism's table. ValueError with one sentence."""
        try:
            return MECHANISMS[self.name].parameters.model_validate(self.parameters)
        except ValidationError as error:
            raise ValueError(_sentence(self.name, error)) from None


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
