"""What the candidates of a rig or of a coupon test depend on."""

from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from diagnose.signals.recording import Recording
from solve.materials.parameters import VACUUM_PERMITTIVITY, Material, PiezoelectricFilm
from solve.mechanisms.base import BONDS, CHANNELS
from solve.model import Model, Readout

if TYPE_CHECKING:
    from diagnose.engines.coupon.point import MaterialPoint


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
    return 1e9 * VACUUM_PERMITTIVITY * film.relative_permittivity * area / (1e-3 * segment.film.thickness_um)
