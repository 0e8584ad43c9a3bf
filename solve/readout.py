"""The amplifier behind the film: from the charge of a press to the voltage that is recorded.

The mechanics of the baseline does not depend on time, so the waveform only says when each depth is reached.
Voltage mode: the film, a charge source with capacitance C_f, drives R parallel to C_f + C_in:
    (C_f + C_in) V' = Q' - V / R
Charge mode: V' = -Q' / C_fb - V / (R_fb C_fb) (MSI Piezo Film Sensors Technical Manual, pp. 38-41).
Both are integrated exactly for a charge that is linear between samples; Butterworth filters follow.
"""

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.signal import butter, lsim

from geometry.errors import InputError
from mesh.types import Floats
from solve.parameters import Press, Readout, Waveform
from solve.result import PressResult
from solve.waveform import duration_s, fraction

SAMPLES = 4001


def readout_voltage(result: PressResult, press: Press, readout: Readout) -> Floats:
    """Voltage (s,) at the moment each step is first reached. InputError for a slide on a waveform with a release."""
    time, progress = _timetable(press)
    voltage = _behind_amplifier(time, _charge(result, progress), float(result.capacitance_F.sum()), readout)
    first = [int(np.argmax(progress >= number - 1e-9)) for number in range(len(result.steps))]
    return np.array([_at(progress, voltage, index, number) for number, index in enumerate(first)])


def _at(progress: Floats, voltage: Floats, index: int, number: int) -> float:
    """Voltage where the progress passes a number between the samples index - 1 and index."""
    before = max(index - 1, 0)
    rise = progress[index] - progress[before]
    share = min(1.0, (number - progress[before]) / rise) if rise > 0.0 else 1.0
    return float(voltage[before] + share * (voltage[index] - voltage[before]))


def _timetable(press: Press) -> tuple[Floats, Floats]:
    """Times (n,) and the number of load steps done by then (n,); each leg of a slide takes as long as the press."""
    waveform = press.waveform or Waveform()
    time = np.linspace(0.0, duration_s(waveform), SAMPLES)
    progress = press.load_steps * fraction(waveform, time)
    if press.path_xy_mm:
        if waveform.shape not in ("ramp", "raised-cosine"):
            raise InputError(
                f"press.waveform.shape = '{waveform.shape}': a slide (press.path_xy_mm) stays at depth; use 'ramp'"
            )
        legs = np.linspace(0.0, float(len(press.path_xy_mm)), SAMPLES)[1:]
        progress = np.append(progress, press.load_steps * (1.0 + legs))
        time = np.append(time, time[-1] + waveform.rise_s * legs)
    return time, progress


def _charge(result: PressResult, progress: Floats) -> Floats:
    """Charge of all electrodes in parallel, C, interpolated without overshoot between the steps."""
    charge = np.array([step.film_charge_C.sum() for step in result.steps])
    if len(charge) == 1:
        return np.zeros_like(progress)
    done = np.arange(len(charge), dtype=float)
    return np.asarray(PchipInterpolator(done, charge)(np.minimum(progress, done[-1])))


def _behind_amplifier(time: Floats, charge: Floats, film_capacitance: float, readout: Readout) -> Floats:
    if readout.mode == "charge":
        capacitance = -1e-12 * (readout.feedback_pF or np.inf)
        resistance = -1e6 * (readout.feedback_MOhm or np.inf)
    else:
        capacitance = film_capacitance + 1e-12 * readout.input_capacitance_pF
        resistance = 1e6 * (readout.input_resistance_MOhm or np.inf)
    voltage = leaky_integral(time, charge, capacitance, resistance)
    if readout.limit_V is not None:
        voltage = np.clip(voltage, -readout.limit_V, readout.limit_V)
    for corner_Hz, kind in ((readout.low_pass_Hz, "low"), (readout.high_pass_Hz, "high")):
        if corner_Hz is not None:
            coefficients = butter(readout.filter_order, 2.0 * np.pi * corner_Hz, kind, analog=True)
            voltage = lsim(coefficients, voltage, time)[1]
    return readout.polarity * np.asarray(voltage)


def leaky_integral(time: Floats, charge: Floats, capacitance: float, resistance: float) -> Floats:
    """V of C V' = Q' - V / R from rest, shape (n,), exact for a charge linear between the samples."""
    voltage = np.zeros(len(time))
    step = np.diff(time)
    decay = step / (resistance * capacitance)
    gain = -np.expm1(-decay) / np.where(decay > 0.0, decay, 1.0) + (decay == 0.0)
    jump = np.diff(charge) / capacitance * gain
    for n in range(len(step)):
        voltage[n + 1] = voltage[n] * np.exp(-decay[n]) + jump[n]
    return voltage
