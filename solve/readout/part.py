"""The amplifier as it is bought: gain, bandwidth, noise, bias current and converter, by name or as stated."""

import tomllib
from functools import cache
from importlib.resources import files
from typing import Annotated, Any

from pydantic import Field, field_validator, model_validator

from foundation.nearest_name import nearest_name_hint
from geometry.parameters import STATED, ActsWith, Finite, NonNegative, Positive, Table

ABOUT = ("is", "source")
"""Keys of parts.toml that are no values of the table [readout.amplifier]."""


@cache
def amplifier_parts() -> dict[str, dict[str, Any]]:
    """The amplifiers of parts.toml by name, each with what it is and its source."""
    return tomllib.loads(files(__package__).joinpath("parts.toml").read_text("utf-8"))


class Amplifier(Table):
    """The amplifier as it is bought, from which the noise of the read-out follows."""

    part: str | None = Field(None, description="a built-in amplifier, whose values hold where this table states none")
    gain: Positive = Field(1.0, description="voltage that is recorded over that of the input, or of the feedback")
    bandwidth_Hz: Positive | None = Field(
        None, description="first-order low-pass of signal and noise; none: noise ends by gain_bandwidth_MHz"
    )
    gain_bandwidth_MHz: Positive | None = Field(None, description="gain-bandwidth product")
    voltage_noise_nV_per_rtHz: NonNegative = Field(0.0, description="e_n at the input, where it is white")
    noise_corner_Hz: NonNegative = Field(0.0, description="below it 1/f noise is more than the white part of e_n")
    current_noise_fA_per_rtHz: NonNegative | None = Field(
        None, description="i_n at the input; none: shot noise of the bias current"
    )
    bias_current_pA: NonNegative = Field(0.0, description="into the input, at room temperature")
    input_capacitance_pF: NonNegative = Field(0.0, description="of the part; adds to that of [readout]")
    adc_bits: Annotated[int, Field(ge=4, le=32)] | None = Field(None, description="of the converter; none: no steps")
    adc_range_V: Annotated[Positive | None, ActsWith(needed=True, adc_bits=STATED)] = Field(
        None, description="the converter reads from minus to plus this voltage"
    )
    sample_rate_Hz: Positive | None = Field(None, description="noise above half of it folds into the samples")
    hum_mV: NonNegative = Field(0.0, description="amplitude of the mains at the input; counts as noise")
    hum_Hz: Positive = Field(50.0, description="frequency of the mains")
    noise_from_Hz: Positive | None = Field(
        None, description="slower noise counts as drift; none: one over the duration of the press"
    )
    temperature_C: Annotated[Finite, Field(gt=-273.15, le=200)] = Field(23.0, description="of the resistors")

    @model_validator(mode="before")
    @classmethod
    def _with_values_of_part(cls, stated: Any) -> Any:
        name = stated.get("part") if isinstance(stated, dict) else None
        known = amplifier_parts().get(name, {}) if isinstance(name, str) else {}
        return {**{key: value for key, value in known.items() if key not in ABOUT}, **stated} if known else stated

    @field_validator("part")
    @classmethod
    def _known(cls, name: str | None) -> str | None:
        if name is not None and name not in amplifier_parts():
            raise ValueError(nearest_name_hint(name, set(amplifier_parts())))
        return name
