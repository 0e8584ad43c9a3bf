"""What the candidates of a rig or of a coupon test depend on."""

from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from diagnose.signals.recording import Drive, Recording
from diagnose.signals.time_scales import TimeScales
from geometry.electrode_outlines import electrode_area_mm2
from solve.materials.parameters import VACUUM_PERMITTIVITY, Material, PiezoelectricFilm
from solve.mechanisms.base import BONDS, CHANNELS
from solve.model import Model, Readout

if TYPE_CHECKING:
    from diagnose.engines.coupon.point import MaterialPoint

FORCE, VOLTAGE, PATH = "force_N", "voltage_V", "displacement_mm"


def shown_answers(recording: Recording) -> frozenset[tuple[Drive, str]]:
    """(drive, kind of answer) of all that was recorded: voltage_2_V is a voltage_V."""
    return frozenset(
        (run.drive, VOLTAGE if name.startswith("voltage") else name) for run in recording.runs for name in run.answers
    )


@dataclass(frozen=True)
class Scene:
    """model : as rig.toml has it, declared mechanisms switched on.

    readouts : the amplifier of each run. depth_mm : deepest press. force_N, voltage_V : largest recorded; 0 where none
    was. scales : time scales of the drives. channels : electrodes, each with an amplifier. mains_Hz : of the hum, one
    per run its share. share : of the film that it speaks of. shown : (drive, kind of answer) of what was recorded.
    places : of the dot in the runs, in mm from where the model has it. strain_pC : largest charge of the strain; 0
    where that is not known.
    """

    model: Model
    readouts: tuple[Readout, ...]
    depth_mm: float
    force_N: float
    voltage_V: float
    scales: TimeScales
    channels: int = 1
    mains_Hz: float = 50.0
    share: float = 1.0
    shown: frozenset[tuple[Drive, str]] = frozenset({("displacement_mm", FORCE), ("displacement_mm", VOLTAGE)})
    places: tuple[tuple[float, float], ...] = ((0.0, 0.0),)
    strain_pC: float = 0.0

    def shows(self, answer: str, *drives: Drive) -> bool:
        """Whether an answer of this kind was recorded under one of these drives; under any if none is given."""
        return any(kind == answer and (drive in drives or not drives) for drive, kind in self.shown)

    @property
    def voltage_shown(self) -> bool:
        """Whether any voltage was recorded: without, nothing electrical shows."""
        return self.shows(VOLTAGE)

    @property
    def path_shown(self) -> bool:
        """Whether the path of the rig's sensor counts: where it drives, and where it answers."""
        return any(drive == PATH for drive, _ in self.shown) or self.shows(PATH)

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
        """Whether a voltage was recorded behind no charge amplifier: only there does the input's impedance count."""
        return self.voltage_shown and any(readout.mode == "voltage" for readout in self.readouts)

    @property
    def capacitance_pF(self) -> float:
        """Capacitance of film and input together, the least of the runs."""
        inputs = [readout.whole_input_pF for readout in self.readouts if readout.mode == "voltage"]
        return self.share * film_capacitance_pF(self.model) + min(inputs, default=0.0)

    @property
    def charge_pC(self) -> float:
        """The largest charge of the strain; that of the largest voltage where it is not known."""
        return self.strain_pC or self.capacitance_pF * (self.voltage_V or 1.0)

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
        """Least conductance of the input of all runs, and what discharges film and input within a run, together."""
        given = [1.0 / r.input_resistance_MOhm if r.input_resistance_MOhm else 0.0 for r in self.readouts]
        return min(given) + 1e-6 * self.capacitance_pF / self.scales.lasting_s


@dataclass(frozen=True)
class CouponScene:
    """All that the candidates of a coupon depend on: point, the baseline, gives the scales."""

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
    area = electrode_area_mm2(segment)
    return 1e9 * VACUUM_PERMITTIVITY * film.relative_permittivity * area / (1e-3 * segment.film.thickness_um)
