"""What only a diagnosis knows of a mechanism: its candidates and its words; and what candidates of a rig depend on."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from itertools import combinations
from math import asinh
from pkgutil import walk_packages
from typing import TYPE_CHECKING

import numpy as np

from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.signals.recording import Recording
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.mechanisms.base import BONDS, CHANNELS, MechanismType
from solve.model import Model, Readout

if TYPE_CHECKING:
    from diagnose.engines.coupon.point import MaterialPoint

VACUUM_PF_PER_MM = 8.8541878128e-3
OFF = 1e-9  # of a coordinate


@dataclass(frozen=True)
class Scene:
    """model : as rig.toml has it, declared mechanisms switched on.

    readouts : the amplifier of each run. depth_mm : deepest press. force_N, voltage_V : largest recorded; 0 where none
    was. step_s, duration_s : sampling step and length of the runs. channels : electrodes, each with an
    amplifier. mains_Hz : of the hum, one per run its share. share : of the film that it speaks of.
    """

    model: Model
    readouts: tuple[Readout, ...]
    depth_mm: float
    force_N: float
    voltage_V: float
    step_s: float
    duration_s: float
    channels: int = 1
    mains_Hz: float = 50.0
    share: float = 1.0

    @property
    def bonds(self) -> tuple[str, ...]:
        """Bonds that the stack has."""
        absent = self.model.segment.effector is None
        return tuple(bond for bond in BONDS if not (absent and "effector" in bond))

    @property
    def runs(self) -> int:
        """How many there are."""
        return len(self.readouts)

    @property
    def voltage_mode(self) -> bool:
        """Whether any amplifier is no charge amplifier: only there does the input's impedance count."""
        return any(readout.mode == "voltage" for readout in self.readouts)

    @property
    def capacitance_pF(self) -> float:
        """Of film and input together, the least of the runs."""
        inputs = [readout.input_capacitance_pF for readout in self.readouts if readout.mode == "voltage"]
        return self.share * film_capacitance_pF(self.model) + min(inputs, default=0.0)

    @property
    def of_each_channel(self) -> "Scene":
        """The same for one of its channels, whose film is its share of the whole."""
        return replace(self, channels=1, share=self.share / self.channels)

    @property
    def numbered(self) -> tuple[str, ...]:
        """Components of single channels, none where there is only one."""
        return CHANNELS[: self.channels] if self.channels > 1 else ()

    @property
    def paired(self) -> tuple[str, ...]:
        """Components of two channels."""
        return tuple(f"{one}-{other}" for one, other in combinations(self.numbered, 2))

    @property
    def conductance_uS(self) -> float:
        """Of the input, the least of the runs, and what discharges film and input within a run, together."""
        given = [1.0 / r.input_resistance_MOhm if r.input_resistance_MOhm else 0.0 for r in self.readouts]
        return min(given) + 1e-6 * self.capacitance_pF / self.duration_s


@dataclass(frozen=True)
class CouponScene:
    """What the candidates of a coupon depend on: point, the baseline, gives the scales."""

    recording: Recording
    material: Material
    point: "MaterialPoint"

    @property
    def travel_mm(self) -> float:
        """The largest recorded."""
        return self._largest("displacement_mm")

    @property
    def force_N(self) -> float:
        """The largest recorded."""
        return self._largest("force_N")

    def _largest(self, channel: str) -> float:
        return max(float(np.nanmax(np.abs(run.channels[channel]))) for run in self.recording.runs)


def film_capacitance_pF(model: Model) -> float:
    """eps A / t under all electrodes."""
    segment, film = model.segment, model.materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    sizes = [electrode.size_mm for electrode in segment.film.electrodes] or [(segment.length_mm, segment.width_mm)]
    area = sum(min(x, segment.length_mm) * min(y, segment.width_mm) for x, y in sizes)
    return VACUUM_PF_PER_MM * film.relative_permittivity * area / (1e-3 * segment.film.thickness_um)


def shrinking(scale: float, value: float) -> float:
    """scale / value of what comes from infinity: finite, and beyond all that could be seen, where it is off."""
    return scale / max(value, OFF)


def growing(
    name: str, scale: float, most: float, starts: tuple[float, ...], nodes: tuple[float, ...] = ()
) -> Coordinate:
    """A quantity from 0 up as scale sinh(x): linear below the scale, logarithmic above. All are given in its unit.

    So one step of x means as much at a thousandth of the range as at its end.
    """
    return Coordinate(
        name, 0.0, asinh(most / scale), tuple(asinh(s / scale) for s in starts), tuple(asinh(n / scale) for n in nodes)
    )


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
    """Every mechanism and component that the rig admits."""
    return tuple(one for entry in vocabulary().values() for one in entry.of_segment(scene))


def candidates_of_coupon(scene: CouponScene) -> tuple[Candidate, ...]:
    """Every mechanism that a homogeneous coupon admits."""
    return tuple(one for entry in vocabulary().values() for one in entry.of_coupon(scene))


def candidates_of_unknown_geometry(scene: Scene, recording: Recording) -> tuple[Candidate, ...]:
    """Every mechanism that shows whatever the geometry."""
    return tuple(one for entry in vocabulary().values() for one in entry.of_unknown_geometry(scene, recording))
