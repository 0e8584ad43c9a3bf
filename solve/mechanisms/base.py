"""What a mechanism is: its parameters, where it may sit, how it is switched on in a model, and its traits."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from re import findall
from typing import Annotated, Any, Protocol, TypeVar

from pydantic import Field, field_validator
from pydantic_core import PydanticCustomError

from geometry.parameters import Finite, Table
from solve.materials.inelastic import StatedLaw
from solve.materials.parameters import Material
from solve.model import Model, Readout

MEDIA = ("effector", "medium1", "medium2")
BONDS = ("bond-effector-medium1", "bond-medium1-film", "bond-film-medium2", "bond-base")
CHANNELS = tuple(f"channel-{n}" for n in range(1, 17))
CHANNEL_PAIRS = tuple(f"{one}-{other}" for one, other in combinations(CHANNELS, 2))
Strain = Annotated[float, Field(gt=-0.2, lt=0.2, allow_inf_nan=False)]
Moduli = tuple[Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)], ...]
Terms = tuple[Finite, ...]


class CanBeOff(Protocol):
    """A part of the physics that knows its own off value."""

    @property
    def is_off(self) -> bool:
        """Whether its values change nothing."""


Part = TypeVar("Part", bound=CanBeOff)


def channels_of(component: str) -> tuple[int, ...]:
    """Numbers of the channels in a component: channel-2 -> (2,), channel-1-channel-2 -> (1, 2), none of any other
    component.
    """
    return tuple(map(int, findall(r"channel-(\d+)", component)))


def in_short(components: Sequence[str]) -> list[str]:
    """Names of components for a reader, sixteen channels or all pairs of them as one."""
    numbered = [one for one in CHANNELS if one in components]
    paired = [one for one in CHANNEL_PAIRS if one in components]
    rest = [one for one in components if not channels_of(one)]
    return rest + [f"{found[0]} to {found[-1]}" for found in (numbered, paired) if found]


class Parameters(Table):
    """Parameters of a mechanism, which are numbers only: neither texts nor true and false stand for them."""

    @field_validator("*", mode="before")
    @classmethod
    def _plain(cls, value: Any) -> Any:
        """Refuse what Python or TOML would take for a number."""
        if any(isinstance(one, str | bool) for one in (value if isinstance(value, list) else [value])):
            raise PydanticCustomError("plain_number", "must be a plain number; its unit is part of the key")
        return value


@dataclass(frozen=True)
class Traits:
    """Properties of a mechanism that others ask for in place of its name.

    adds_up : several at one component have one meaning, as their effects add up, multiply or stand in series.
    electrical : it acts behind the film alone. charge_alone : it is charge of the film, and moves nothing.
    memory : the answer depends on time or on the path; path_dependent : on the path at whatever speed.
    shows_on_return : only a dot that returns shows it in full.
    unsymmetric : its tangent is not symmetric. changes_geometry : sizes, places or shapes differ.
    acts_on_tables : it, or a part of it, acts on a press that is known as on the 3D model: no press of its own.
    on_middle_mesh : a diagnosis presses it on its finer mesh, since a coarse one feels it node by node, or since it is
    asked for to some percent.
    wrong_number : a stated number is another one, which is no physics; it scales whatever the others have made.
    acts_up_to : parameter with the highest frequency in Hz at which it acts, "" where there is none.
    free_phase : it has a phase that nobody knows, another one in every run.
    """

    adds_up: bool = False
    electrical: bool = False
    charge_alone: bool = False
    memory: bool = False
    path_dependent: bool = False
    shows_on_return: bool = False
    unsymmetric: bool = False
    changes_geometry: bool = False
    acts_on_tables: bool = False
    on_middle_mesh: bool = False
    wrong_number: bool = False
    acts_up_to: str = ""
    free_phase: bool = False


@dataclass(frozen=True)
class MechanismType:
    """One piece of physics beyond the baseline.

    components : where it may sit. parameters : its table, with units, bounds and descriptions.
    switch_on(model, component, values) -> the model with it; ValueError where the model has no such component.
    off : parameters with which it changes nothing, None where no value does (then it is left out instead).
    example : parameters to begin with, those of examples/mechanisms.
    typical : parameter -> typical values and their source, in words.
    parallel_to_input : components at which it lies parallel to the amplifier's input, where a charge amplifier has none
    of it.
    """

    name: str
    components: tuple[str, ...]
    parameters: type[Parameters]
    switch_on: Callable[[Model, str, Any], Model]
    off: Mapping[str, Any] | None
    example: Mapping[str, Any] = field(default_factory=dict)
    typical: Mapping[str, str] = field(default_factory=dict)
    traits: Traits = Traits()
    parallel_to_input: tuple[str, ...] = ()

    def is_off(self, values: Parameters) -> bool:
        """Whether checked values are those with which it changes nothing."""
        stated = values.model_dump(mode="json")
        return self.off is not None and all(stated.get(name) == value for name, value in self.off.items())


MECHANISMS: dict[str, MechanismType] = {}
"""Name -> mechanism, of all that are registered."""


def register(mechanism: MechanismType) -> MechanismType:
    """Make a mechanism known to configurations, runs and diagnoses; returns it. ValueError for a name that is taken."""
    if mechanism.name in MECHANISMS:
        raise ValueError(f"name = '{mechanism.name}': there is such a mechanism already")
    MECHANISMS[mechanism.name] = mechanism
    return mechanism


def with_physics(model: Model, **changes: Any) -> Model:
    """The model with other physics beyond the baseline."""
    return replace(model, physics=replace(model.physics, **changes))


def with_law(model: Model, component: str, law: StatedLaw) -> Model:
    """The model with a law around a layer or a bond, in place of one of the same order; as it is where that is off."""
    if law.is_off:
        return model
    known = model.physics.inelastic
    others = (one for one in known.get(component, ()) if one.order != law.order)
    return with_physics(model, inelastic={**known, component: (*others, law)})


def in_place(parts: tuple[Part, ...], new: Part) -> tuple[Part, ...]:
    """The parts with a new one in place of another of its kind, without any where the new one is off."""
    others = tuple(one for one in parts if type(one) is not type(new))
    return others if new.is_off else (*others, new)


def with_readout(model: Model, **changes: Any) -> Model:
    """The model with other keys of its read-out."""
    return replace(model, readout=(model.readout or Readout()).model_copy(update=changes))


def with_dot(model: Model, **changes: Any) -> Model:
    """The model with other keys of its dot."""
    return replace(model, dot=model.dot.model_copy(update=changes))


def layer_material(model: Model, component: str) -> Material:
    """The material of a layer. ValueError where this segment has none."""
    if component not in model.materials:
        raise ValueError(f"component = '{component}': this segment has none")
    return model.materials[component]


def with_layer(model: Model, component: str, material: Material) -> Model:
    """The model with another material in a layer."""
    return replace(model, materials={**model.materials, component: material})
