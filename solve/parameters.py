"""What the configuration says of the press and of the read-out."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from geometry.parameters import Finite, NonNegative, Positive, Table


class Waveform(Table):
    """How the indentation (or the force) follows time."""

    shape: Literal["ramp", "half-sine", "raised-cosine", "trapezoid", "file"] = Field(
        "ramp", description="ramp: up, then hold; trapezoid: up, hold, down; file: two CSV columns time_s, fraction"
    )
    rise_s: Positive = Field(0.5, description="time from touch to full depth")
    hold_s: NonNegative = Field(0.0, description="ramp and trapezoid: time at full depth")
    fall_s: Positive = Field(0.5, description="trapezoid: time of the release")
    file: str | None = Field(None, description="shape = file: the CSV file")


DEFAULT_INDENTATION_MM = 0.3


class Press(Table):
    """How the dot is pressed."""

    indentation_mm: Positive | None = Field(None, description="final depth; 0.3 when neither depth nor force is given")
    force_N: Positive | None = Field(None, description="final force instead of indentation_mm")
    load_steps: Annotated[int, Field(ge=1, le=1000)] = Field(6, description="equal steps that are reported")
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
    input_resistance_MOhm: Positive | None = Field(None, description="voltage mode; none: infinite")
    input_capacitance_pF: NonNegative = Field(0.0, description="voltage mode: amplifier and cable")
    feedback_pF: Positive | None = Field(None, description="charge mode: feedback capacitance")
    feedback_MOhm: Positive | None = Field(None, description="charge mode: feedback resistance; none: infinite")
    low_pass_Hz: Positive | None = Field(None, description="Butterworth low-pass; none: no filter")
    high_pass_Hz: Positive | None = Field(None, description="Butterworth high-pass; none: no filter")
    filter_order: Annotated[int, Field(ge=1, le=8)] = Field(1, description="order of both filters")
    limit_V: Positive | None = Field(None, description="the amplifier saturates at plus and minus this voltage")
    polarity: Literal[1, -1] = Field(1, description="sign of the voltage, as wired")
    noise_V: Positive = Field(1e-3, description="noise (one sigma) for the least detectable indentation")
