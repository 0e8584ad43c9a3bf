"""The noise of a stated amplifier as a spectrum through its circuit, and its root mean square.

Voltage mode, with Z = R parallel to C = C_f + C_in: 4 k T / R and i_n^2 flow through Z, e_n adds to the voltage. Over
all frequencies the Johnson noise of R alone is k T / C. Charge mode, with Z = R_fb parallel to C_fb: the same through
Z, and e_n times the noise gain |1 + j w (C_f + C_in) Z| (Horowitz and Hill, The Art of Electronics, 3rd ed. 2015,
chapter 8). All pass gain, bandwidth and filters. An infinite R makes no Johnson noise. A converter with steps q adds
q / sqrt(12) (Bennett, Bell Syst. Tech. J. 27 (1948) 446), the mains its amplitude over sqrt(2).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.constants import Boltzmann, elementary_charge, zero_Celsius

from foundation.arrays import Floats
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import input_of, stages
from solve.readout.filters import Filter
from solve.readout.part import Amplifier

PER_DECADE = 60
BEYOND_CORNERS = 1e5
"""The spectrum ends here, times the highest corner: what is beyond is less than 1e-5 of the power of a first order."""


@dataclass(frozen=True)
class NoiseBudget:
    """Noise of the recorded voltage. frequency_Hz (n,); density_V2_per_Hz : (n,) of each part that has a spectrum;
    parts_V : root mean square of each part, of steps of the converter and of hum too.

    above_half_rate_V : what folds into the samples; None without a sample rate. offset_V : that of the bias current,
    steady, or after the duration of the press where it never is.
    """

    frequency_Hz: Floats
    density_V2_per_Hz: Mapping[str, Floats]
    parts_V: Mapping[str, float]
    above_half_rate_V: float | None
    offset_V: float

    @property
    def rms_V(self) -> float:
        """Root mean square of all parts together."""
        return float(np.sqrt(sum(value**2 for value in self.parts_V.values())))


def noise_budget(readout: Readout, physics: Physics, film_F: float, duration_s: float) -> NoiseBudget:
    """Noise of a read-out with a stated amplifier behind a film with a capacitance, over a press of a duration."""
    part = readout.amplifier
    assert part is not None
    frequency = _frequencies_Hz(readout, physics, film_F, part.noise_from_Hz or 1.0 / duration_s)
    passed = _power_gain(readout, physics, film_F, frequency)
    density = {name: passed * own for name, own in _input_densities(readout, part, film_F, frequency).items()}
    parts = {name: np.sqrt(_power(frequency, own)) for name, own in density.items()}
    parts |= {"hum": _hum_V(readout, physics, film_F, part), "converter": _step_V(part) / np.sqrt(12.0)}
    return NoiseBudget(
        frequency_Hz=frequency,
        density_V2_per_Hz=density,
        parts_V={name: float(value) for name, value in parts.items() if value > 0.0},
        above_half_rate_V=_folded_V(frequency, sum(density.values(), np.zeros_like(frequency)), part.sample_rate_Hz),
        offset_V=_offset_V(readout, part, film_F, duration_s),
    )


def _input_densities(readout: Readout, part: Amplifier, film_F: float, frequency_Hz: Floats) -> dict[str, Floats]:
    """V^2 / Hz (n,) of each part before gain and filters."""
    capacitance, resistance = np.abs(input_of(readout, film_F))
    omega = 2.0 * np.pi * frequency_Hz
    impedance = 1.0 / (1.0 / resistance + 1j * omega * capacitance)
    white = (1e-9 * part.voltage_noise_nV_per_rtHz) ** 2 * (1.0 + part.noise_corner_Hz / frequency_Hz)
    charge = readout.mode == "charge"
    source = film_F + 1e-12 * readout.whole_input_pF
    noise_gain = np.abs(1.0 + 1j * omega * source * impedance) if charge else np.ones_like(omega)
    through = np.abs(impedance) ** 2
    shot = 2.0 * elementary_charge * 1e-12 * part.bias_current_pA
    stated = part.current_noise_fA_per_rtHz
    current = shot if stated is None else (1e-15 * stated) ** 2
    johnson = 4.0 * Boltzmann * (zero_Celsius + part.temperature_C) / resistance
    return {"resistor": johnson * through, "current noise": current * through, "voltage noise": white * noise_gain**2}


def _power_gain(readout: Readout, physics: Physics, film_F: float, frequency_Hz: Floats) -> Floats:
    """|H|^2 (n,) from the input, or the feedback, to the recorded voltage."""
    s = 2j * np.pi * frequency_Hz
    passed = np.full(len(frequency_Hz), readout.gain**2)
    for one in _filters(readout, physics):
        numerator, denominator = one.transfer()
        passed = passed * np.abs(np.polyval(numerator, s) / np.polyval(denominator, s)) ** 2
    end = _open_end_Hz(readout, film_F)
    return passed if end is None else passed / (1.0 + (frequency_Hz / end) ** 2)


def _filters(readout: Readout, physics: Physics) -> list[Filter]:
    return [one for one in stages(readout, physics) if isinstance(one, Filter)]


def _open_end_Hz(readout: Readout, film_F: float) -> float | None:
    """Where the gain-bandwidth product ends the noise of an amplifier without a stated bandwidth."""
    part = readout.amplifier
    if part is None or part.bandwidth_Hz is not None or part.gain_bandwidth_MHz is None:
        return None
    if readout.mode == "voltage":
        return 1e6 * part.gain_bandwidth_MHz / max(part.gain, 1.0)
    feedback = 1e-12 * (readout.feedback_pF or np.inf)
    return 1e6 * part.gain_bandwidth_MHz * feedback / (feedback + film_F + 1e-12 * readout.whole_input_pF)


def _frequencies_Hz(readout: Readout, physics: Physics, film_F: float, from_Hz: float) -> Floats:
    """Frequencies (n,) that are even in their logarithm, from the slowest that counts to where nothing is left."""
    capacitance, resistance = np.abs(input_of(readout, film_F))
    corners = [
        from_Hz,
        1.0 / (2.0 * np.pi * resistance * capacitance),
        *(one.corner_Hz for one in _filters(readout, physics)),
    ]
    highest = BEYOND_CORNERS * max(*corners, _open_end_Hz(readout, film_F) or 0.0)
    return np.geomspace(from_Hz, highest, int(PER_DECADE * np.log10(highest / from_Hz)) + 2)


def _power(frequency_Hz: Floats, density: Floats) -> float:
    """Integral of a density (n,) over its frequencies (n,), even in their logarithm."""
    return float(np.trapezoid(frequency_Hz * density, np.log(frequency_Hz)))


def _hum_V(readout: Readout, physics: Physics, film_F: float, part: Amplifier) -> float:
    """Root mean square of the mains, which adds to the voltage of the input."""
    passed = _power_gain(readout, physics, film_F, np.array([part.hum_Hz]))[0]
    return float(1e-3 * part.hum_mV * np.sqrt(0.5 * passed))


def _step_V(part: Amplifier) -> float:
    """One step of the converter; 0 without one."""
    return 0.0 if part.adc_bits is None or part.adc_range_V is None else 2.0 * part.adc_range_V / 2.0**part.adc_bits


def _folded_V(frequency_Hz: Floats, density: Floats, rate_Hz: float | None) -> float | None:
    """Root mean square above half a sample rate."""
    if rate_Hz is None:
        return None
    above = frequency_Hz > 0.5 * rate_Hz
    return float(np.sqrt(_power(frequency_Hz[above], density[above]))) if above.sum() > 1 else 0.0


def _offset_V(readout: Readout, part: Amplifier, film_F: float, duration_s: float) -> float:
    """Recorded voltage of the bias current: I R, or I t / C where that is less."""
    capacitance, resistance = np.abs(input_of(readout, film_F))
    current = 1e-12 * part.bias_current_pA
    steady = 0.0 if readout.high_pass_Hz is not None else abs(readout.gain)
    return float(steady * current * min(resistance, duration_s / capacitance))
