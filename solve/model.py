"""What the solver is told: a segment with its materials, dot, press, read-out, and physics beyond the baseline."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from geometry.parameters import ABSENT, STATED, ActsWith, Dot, Finite, NonNegative, Positive, Segment, Table
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.physics import Physics
from solve.readout.part import Amplifier
from solve.waveform import Waveform

if TYPE_CHECKING:
    from solve.mechanisms import Mechanism


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
    input_capacitance_pF: Annotated[NonNegative, ActsWith(mode=("voltage",), amplifier=STATED)] = Field(
        0.0, description="of amplifier and cable; behind a charge amplifier it makes noise alone"
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
    noise_V: Annotated[Positive, ActsWith(amplifier=ABSENT)] = Field(
        1e-3, description="noise (one sigma) for the least detectable press"
    )
    amplifier: Amplifier | None = Field(
        None, description="the amplifier as it is bought, from which the noise is calculated"
    )

    @field_validator("polarity", mode="before")
    @classmethod
    def _number(cls, value: Any) -> Any:
        """Refuse true and false, which Python takes for 1 and 0."""
        if isinstance(value, bool):
            raise ValueError("must be 1 or -1")
        return value

    @model_validator(mode="after")
    def _noise_ends(self) -> Self:
        part = self.amplifier
        if part is None or part.voltage_noise_nV_per_rtHz == 0.0:
            return self
        if part.bandwidth_Hz is None and part.gain_bandwidth_MHz is None and self.low_pass_Hz is None:
            raise ValueError(
                "amplifier.bandwidth_Hz is missing: white noise has no end without it, "
                "amplifier.gain_bandwidth_MHz or low_pass_Hz"
            )
        return self

    @property
    def whole_input_pF(self) -> float:
        """Capacitance of cable and amplifier together."""
        return self.input_capacitance_pF + (0.0 if self.amplifier is None else self.amplifier.input_capacitance_pF)

    @property
    def gain(self) -> float:
        """Recorded voltage over that of the input, or of the feedback, with the sign of the wiring."""
        return self.polarity * (1.0 if self.amplifier is None else self.amplifier.gain)

    @property
    def largest_V(self) -> float | None:
        """The largest voltage that can be recorded: where the amplifier saturates, or where the converter ends."""
        ends = [self.limit_V, None if self.amplifier is None else self.amplifier.adc_range_V]
        return min((end for end in ends if end is not None), default=None)


@dataclass(frozen=True)
class Model:
    """Everything the solver is told. materials : layer -> material. mechanisms : those that were switched on.

    separate_channels : each electrode is on an amplifier of its own, against a common ground, where voltages act back
    on the film; else all electrodes are in parallel on one.
    """

    segment: Segment
    materials: Mapping[str, Material]
    dot: Dot
    press: Press = field(default_factory=Press)
    readout: Readout | None = None
    physics: Physics = field(default_factory=Physics)
    mechanisms: tuple["Mechanism", ...] = ()
    separate_channels: bool = False

    @property
    def amplifier(self) -> Readout | None:
        """The amplifier between the film and what is read: the read-out as stated, an ideal one where there are only
        mechanisms of the amplifier, None where there are neither.
        """
        if self.readout is None and (self.physics.stages or self.physics.channels):
            return Readout()
        return self.readout

    @property
    def follows_time(self) -> bool:
        """Whether the press follows its waveform to the end; else only the loads count, not when they come."""
        film = self.materials["film"]
        coupled = self.amplifier is not None and isinstance(film, PiezoelectricFilm) and film.coupling == "two-way"
        return self.physics.follows_time or self.press.slides_in_hold or coupled
