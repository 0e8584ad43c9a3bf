"""What only a diagnosis knows of a mechanism: its candidates and its words."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pkgutil import walk_packages

from diagnose.forward import Candidate, Setting
from diagnose.signals.recording import Recording
from diagnose.vocabulary.aliases import without_aliases
from diagnose.vocabulary.scene import CouponScene, Scene
from solve.mechanisms.base import MechanismType


def _none(*_: object) -> tuple[()]:
    return ()


GIVES_WAY = "something in series with the film gives way"
LOSES_CHARGE = "the film or its input loses charge"
OTHER_CHARGE = "charge comes from something else than the strain of the film"
REMEMBERS = "a part remembers how it was strained"
STIFFNESS = "a layer is stiffer or softer than its stated law"


@dataclass(frozen=True)
class Vocabulary:
    """words : half a sentence on what happens, with {} for where.

    of_segment, of_coupon, of_unknown_geometry : its candidates in a rig, in a coupon test and for a sensor that nobody
    can mesh; none where it cannot be told there.
    undone_by : what a bench can change so that it does not act: words and keys; None where nothing is known.
    below_one : a quantity that is derived from the values, and the words for what happens where it is below 1.
    kind : a sentence that is true of every mechanism of its kind, "" where it has no relatives. kinds_at : those that
    it is of at its values.
    words_of_two : the same as words for a pair of channels, with {} for both; "" where it sits at none.
    """

    mechanism: MechanismType
    words: str
    of_segment: Callable[[Scene], Iterable[Candidate]]
    of_coupon: Callable[[CouponScene], Iterable[Candidate]] = _none
    of_unknown_geometry: Callable[[Scene, Recording], Iterable[Candidate]] = _none
    undone_by: tuple[str, dict[str, str]] | None = None
    below_one: tuple[str, str] | None = None
    kind: str = ""
    kinds_at: Callable[[Setting], Iterable[str]] = _none
    words_of_two: str = ""

    def kinds(self, setting: Setting) -> list[str]:
        """All that it is of at its values, that of the mechanism first."""
        return [kind for kind in (self.kind, *self.kinds_at(setting)) if kind]


VOCABULARY: dict[str, Vocabulary] = {}


def register(entry: Vocabulary) -> Vocabulary:
    """Make a mechanism a candidate of every diagnosis; returns it. ValueError where it is one already."""
    if entry.mechanism.name in VOCABULARY:
        raise ValueError(f"name = '{entry.mechanism.name}': a diagnosis knows it already")
    VOCABULARY[entry.mechanism.name] = entry
    return entry


def vocabulary() -> dict[str, Vocabulary]:
    """Mechanism -> what a diagnosis knows of it."""
    _discover()
    return VOCABULARY


@cache
def _discover() -> None:
    """Import every module beside this one: each registers its mechanism."""
    package = __name__.rpartition(".")[0]
    for module in sorted(found.name for found in walk_packages(import_module(package).__path__, f"{package}.")):
        import_module(module)


def candidates_of_segment(scene: Scene) -> tuple[Candidate, ...]:
    """Every mechanism and component that the rig admits; nothing electrical where no voltage was recorded."""
    found = (one for entry in vocabulary().values() for one in entry.of_segment(scene))
    return without_aliases(scene.model, (c for c in found if scene.voltage_shown or not _acts_on_charge_alone(c)))


def _acts_on_charge_alone(one: Candidate) -> bool:
    return one.traits.electrical or one.traits.charge_alone


def candidates_of_coupon(scene: CouponScene) -> tuple[Candidate, ...]:
    """Every mechanism that a homogeneous coupon admits."""
    return tuple(one for entry in vocabulary().values() for one in entry.of_coupon(scene))


def candidates_of_unknown_geometry(scene: Scene, recording: Recording) -> tuple[Candidate, ...]:
    """Every mechanism that shows whatever the geometry."""
    found = (one for entry in vocabulary().values() for one in entry.of_unknown_geometry(scene, recording))
    return without_aliases(scene.model, found)
