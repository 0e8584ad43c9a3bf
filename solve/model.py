"""What the solver is told: a segment with its materials, dot, press, read-out, and physics beyond the baseline.

Physics beyond the baseline, as the solver needs it. Every default is off and restores the baseline exactly.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, PrivateAttr, field_validator, model_validator

from foundation.arrays import Floats
from geometry.parameters import STATED, ActsWith, Dot, Finite, NonNegative, Positive, Segment, Table
from solve.materials.mullins import Softening
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.materials.prony import Prony
from solve.readout.stages import Stage
from solve.terms.guide import GuideFriction

if TYPE_CHECKING:
    from solve.mechanisms import Mechanism


class Waveform(Table):
    """How the indentation (or the force) follows time."""

    shape: Literal["ramp", "half-sine", "raised-cosine", "trapezoid", "file"] = Field(
        "ramp", description="ramp: up, then hold; trapezoid: up, hold, down; file: two CSV columns time_s, fraction"
    )
    rise_s: Positive = Field(
        0.5, description="time from touch to full depth; file: to its first row, where that is pressed already"
    )
    hold_s: Annotated[NonNegative, ActsWith(shape=("ramp", "trapezoid"))] = Field(0.0, description="time at full depth")
    fall_s: Annotated[Positive, ActsWith(shape=("trapezoid",))] = Field(0.5, description="time of the release")
    file: Annotated[str | None, ActsWith(needed=True, shape=("file",))] = Field(None, description="the CSV file")
    _samples: Floats | None = PrivateAttr(None)
    _each_solved: bool = PrivateAttr(False)

    @classmethod
    def through(cls, time_s: Floats, fraction: Floats, each_solved: bool = False) -> "Waveform":
        """Straight lines through fractions (t,) at increasing times (t,), as a file would state them."""
        made = cls.model_construct(shape="file")
        made._samples, made._each_solved = np.column_stack([time_s, fraction]), each_solved
        return made

    def lacks(self, name: str) -> bool:
        """A file is not missing where its rows were given in its place."""
        return self._samples is None and super().lacks(name)

    @property
    def each_solved(self) -> bool:
        """Whether a state is solved at each of the samples, those in a hold too."""
        return self._each_solved

    @property
    def samples(self) -> Floats | None:
        """Times and fractions (t, 2) of one that was made through them, else None."""
        return self._samples


DEFAULT_INDENTATION_MM = 0.3


class Press(Table):
    """How the dot is pressed."""

    indentation_mm: Positive | None = Field(None, description="final depth; 0.3 when neither depth nor force is given")
    force_N: Positive | None = Field(None, description="final force instead of indentation_mm")
    load_steps: Annotated[int, Field(ge=1, le=1000)] = Field(
        6, description="least number of equal steps that are reported; of a file spread over its pieces"
    )
    path_xy_mm: tuple[tuple[Finite, Finite], ...] = Field(
        (), description="waypoints of a slide at full load; within the hold of a trapezoid, else after the waveform"
    )
    waveform: Waveform | None = Field(None, description="time course, for the read-out and time-dependent physics")

    @model_validator(mode="after")
    def _slide_and_waveform(self) -> Self:
        shape = self.waveform.shape if self.waveform is not None else "ramp"
        if not self.path_xy_mm or shape in ("ramp", "raised-cosine"):
            return self
        if shape != "trapezoid":
            raise ValueError(f"waveform.shape = '{shape}': a slide needs a load that is held, 'ramp' or 'trapezoid'")
        if self.waveform is not None and self.waveform.hold_s == 0.0:
            raise ValueError("waveform.hold_s = 0: a slide (path_xy_mm) takes place during the hold of a trapezoid")
        return self

    @property
    def slides_in_hold(self) -> bool:
        """Whether the dot is pressed, slid and lifted again."""
        return bool(self.path_xy_mm) and self.waveform is not None and self.waveform.shape == "trapezoid"

    @property
    def depth_mm(self) -> float:
        """Final depth where no force is given."""
        return self.indentation_mm or DEFAULT_INDENTATION_MM


class Readout(Table):
    """The amplifier behind the film."""

    mode: Literal["voltage", "charge"] = Field("voltage", description="voltage: R parallel C; charge: with feedback")
    input_resistance_MOhm: Annotated[Positive | None, ActsWith(mode=("voltage",))] = Field(
        None, description="parallel to the film; none: infinite"
    )
    input_capacitance_pF: Annotated[NonNegative, ActsWith(mode=("voltage",))] = Field(
        0.0, description="of amplifier and cable"
    )
    feedback_pF: Annotated[Positive | None, ActsWith(needed=True, mode=("charge",))] = Field(
        None, description="feedback capacitance"
    )
    feedback_MOhm: Annotated[Positive | None, ActsWith(mode=("charge",))] = Field(
        None, description="feedback resistance; none: infinite"
    )
    low_pass_Hz: Positive | None = Field(None, description="Butterworth low-pass; none: no filter")
    high_pass_Hz: Positive | None = Field(None, description="Butterworth high-pass; none: no filter")
    filter_order: Annotated[int, Field(ge=1, le=8), ActsWith(low_pass_Hz=STATED, high_pass_Hz=STATED)] = Field(
        1, description="order of both filters"
    )
    limit_V: Positive | None = Field(None, description="the amplifier saturates at plus and minus this voltage")
    polarity: Literal[1, -1] = Field(1, description="sign of the voltage, as wired")
    noise_V: Positive = Field(1e-3, description="noise (one sigma) for the least detectable indentation")

    @field_validator("polarity", mode="before")
    @classmethod
    def _number(cls, value: Any) -> Any:
        """True is equal to 1 in Python."""
        if isinstance(value, bool):
            raise ValueError("must be 1 or -1")
        return value


@dataclass(frozen=True)
class BondLine:
    """Stiffness of an adhesive, traction per jump of displacement."""

    normal_stiffness_N_per_mm3: float
    shear_stiffness_N_per_mm3: float


@dataclass(frozen=True)
class Delamination:
    """A disc (in plane strain a strip of that width) without bond; outside : all but that disc without bond."""

    bond: str
    center_mm: tuple[float, float]
    diameter_mm: float
    outside: bool = False


@dataclass(frozen=True)
class Yield:
    """Yield stress of the film and its linear isotropic hardening modulus."""

    stress_MPa: float
    hardening_MPa: float = 0.0


@dataclass(frozen=True)
class Pyroelectric:
    """A temperature of the film that approaches temperature_step_K with time_constant_s."""

    temperature_step_K: float = 0.0
    time_constant_s: float = 1.0


@dataclass(frozen=True)
class Physics:
    """What acts on the segment besides the baseline.

    viscosity : layer or bond -> Prony series; softening : medium -> law (stress scale in MPa).
    bonds : bond -> stiffness. friction : Coulomb coefficient between dot and surface.
    rig_compliance_mm_per_N lies between the displacement sensor and the dot, moving_mass_g between the force sensor
    and the dot; guide rubs where the displacement sensor is, and the force sensor carries it. prestretch : nominal
    strain of the film in x and y. contact_charge_pC : charge that the dot leaves on the electrodes, all of it at the
    largest contact area, before that by a power of the area. electronics : stages of the amplifier beside those of the
    read-out. crosstalk : channel (from 1) -> share of the other channels' voltage.
    mutual_pF : two channels -> capacitance between their inputs; channel_leak_uS : channel -> conductance parallel to
    its input; channel_electronics : channel -> stages beside those of all. They need an amplifier for each electrode.
    separate_channels : each electrode is on an amplifier of its own, against a common ground, where voltages act back
    on the film; else all electrodes are in parallel on one.
    """

    viscosity: Mapping[str, Prony] = field(default_factory=dict)
    softening: Mapping[str, Softening] = field(default_factory=dict)
    film_yield: Yield | None = None
    bonds: Mapping[str, BondLine] = field(default_factory=dict)
    delaminations: tuple[Delamination, ...] = ()
    friction: float = 0.0
    rig_compliance_mm_per_N: float = 0.0
    moving_mass_g: float = 0.0
    guide: GuideFriction = field(default_factory=GuideFriction)
    prestretch: tuple[float, float] = (0.0, 0.0)
    pyroelectric: Pyroelectric = Pyroelectric()
    contact_charge_pC: float = 0.0
    contact_charge_exponent: float = 1.0
    electronics: tuple[Stage, ...] = ()
    crosstalk: Mapping[int, float] = field(default_factory=dict)
    mutual_pF: Mapping[tuple[int, int], float] = field(default_factory=dict)
    channel_leak_uS: Mapping[int, float] = field(default_factory=dict)
    channel_electronics: Mapping[int, tuple[Stage, ...]] = field(default_factory=dict)
    separate_channels: bool = False

    @property
    def of_channels(self) -> tuple[tuple[str, int], ...]:
        """In words, what is of single channels, each with the highest of the channels that it needs."""
        return (
            *((f"crosstalk into 'channel-{n}'", n) for n in self.crosstalk),
            *((f"crosstalk between 'channel-{i}' and 'channel-{j}'", max(i, j)) for i, j in self.mutual_pF),
            *((f"a leak of 'channel-{n}'", n) for n in self.channel_leak_uS),
            *((f"a filter of 'channel-{n}'", n) for n in self.channel_electronics),
        )

    @property
    def follows_time(self) -> bool:
        """Whether the path, or its speed, matters: the press then follows its waveform to the end."""
        return bool(
            self.viscosity
            or self.softening
            or self.film_yield
            or self.friction > 0.0
            or self.moving_mass_g > 0.0
            or self.guide.forces_N
            or self.pyroelectric.temperature_step_K != 0.0
        )


@dataclass(frozen=True)
class Model:
    """Everything the solver is told. materials : layer -> material. mechanisms : those that were switched on."""

    segment: Segment
    materials: Mapping[str, Material]
    dot: Dot
    press: Press = field(default_factory=Press)
    readout: Readout | None = None
    physics: Physics = field(default_factory=Physics)
    mechanisms: tuple["Mechanism", ...] = ()

    @property
    def amplifier(self) -> Readout | None:
        """What stands between the film and what is read: the read-out as stated, an ideal one where only mechanisms of
        the amplifier are, None where nothing is.
        """
        if self.readout is None and (self.physics.electronics or self.physics.of_channels):
            return Readout()
        return self.readout

    @property
    def follows_time(self) -> bool:
        """Whether the press follows its waveform to the end; else only the loads count, not when they come."""
        film = self.materials["film"]
        coupled = self.amplifier is not None and isinstance(film, PiezoelectricFilm) and film.coupling == "two-way"
        return self.physics.follows_time or self.press.slides_in_hold or coupled


def declared_bonds(segment: Segment) -> dict[str, BondLine]:
    """The compliant bonds of [[segment.bonds]] by name."""
    return {
        bond_name(*bond.between): BondLine(bond.normal_stiffness_N_per_mm3, bond.shear_stiffness_N_per_mm3)
        for bond in segment.bonds
    }


def bond_name(one: str, other: str) -> str:
    """bond-base, or bond-UPPER-LOWER of two neighbouring layers."""
    if "base" in (one, other):
        return "bond-base"
    upper_first = ("effector", "medium1", "film", "medium2")
    return "bond-" + "-".join(sorted((one, other), key=upper_first.index))
