"""Several electrodes, each on an amplifier of its own: what is the matter with one of them, and what ties two together.

A stray capacitance between two inputs lies behind the resistance of the damp surface or the trace that leads to it:
    C_i V_i' + V_i / R_i + sum of i_k = Q_i',    i_k = (V_i - V_j - u_k) / r_k,    c_k u_k' = i_k
so that it passes nothing above 1 / (2 pi r_k c_k). Trapezoidal rule on the finer grid of the amplifier.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import CubicSpline

from softdot.studies.proof.world.amplifier import SAMPLES_FACTOR, Amplifier, Filter
from softdot.studies.proof.world.arrays import Floats

PASSES_HZ = 40.0


@dataclass(frozen=True)
class Stray:
    """Stray capacitance between the inputs of two channels, numbered from 0. passes_Hz : beyond which its resistance
    keeps it from acting.
    """

    between: tuple[int, int]
    capacitance_pF: float
    passes_Hz: float = PASSES_HZ

    @property
    def conductance_uS(self) -> float:
        """Conductance of the resistance before it."""
        return 2e-6 * np.pi * self.passes_Hz * self.capacitance_pF


@dataclass(frozen=True)
class Wiring:
    """Faults of single channels. strays : capacitances between inputs. leak_MOhm : channel -> resistance beside its
    own. slow : channel -> a filter behind its own.
    """

    strays: tuple[Stray, ...] = ()
    leak_MOhm: Mapping[int, float] = field(default_factory=dict)
    slow: Mapping[int, Filter] = field(default_factory=dict)


def voltages(
    amplifier: Amplifier, wiring: Wiring, time_s: Floats, charge_pC: Floats, film_pF: Sequence[float], phase: float
) -> Floats:
    """Voltage (t, e) of every channel for the charges (t, e) of electrodes at even times (t,), from rest.

    amplifier : each channel has one. phase : of the mains.
    """
    rate = SAMPLES_FACTOR * (len(time_s) - 1) / (time_s[-1] - time_s[0])
    fine = time_s[0] + np.arange(SAMPLES_FACTOR * (len(time_s) - 1) + 1) / rate
    own = [amplifier.leaking(wiring.leak_MOhm.get(n)) for n in range(len(film_pF))]
    charge = CubicSpline(time_s, charge_pC)(fine)
    if wiring.strays:
        inputs = tied_inputs_V(own, wiring.strays, charge, film_pF, rate).T
    else:
        inputs = np.array([one.input_V(q, c, rate) for one, q, c in zip(own, charge.T, film_pF, strict=True)])
    behind = [amplifier.behind(voltage, fine, rate, phase) for voltage in inputs]
    return np.stack([wiring.slow[n].apply(v, rate) if n in wiring.slow else v for n, v in enumerate(behind)], axis=1)[
        ::SAMPLES_FACTOR
    ]


def tied_inputs_V(
    amplifiers: Sequence[Amplifier],
    strays: Sequence[Stray],
    charge_pC: Floats,
    film_pF: Sequence[float],
    rate_Hz: float,
) -> Floats:
    """Voltage (n, e) at inputs that strays tie together, for charges (n, e) at even times, from rest."""
    count, size = len(film_pF), len(film_pF) + len(strays)
    capacitance = np.zeros(size)
    conductance = np.zeros((size, size))
    for n, (one, film) in enumerate(zip(amplifiers, film_pF, strict=True)):
        capacitance[n] = film + one.capacitance_pF
        conductance[n, n] = 0.0 if one.resistance_MOhm is None else 1.0 / one.resistance_MOhm
    for number, stray in enumerate(strays, start=count):
        way = np.zeros(size)
        way[stray.between[0]], way[stray.between[1]], way[number] = 1.0, -1.0, -1.0
        capacitance[number] = stray.capacitance_pF
        conductance += stray.conductance_uS * np.outer(way, way)
    half = 0.5e6 / rate_Hz * conductance  # MOhm times pF is microseconds
    forward = np.linalg.inv(np.diag(capacitance) + half)
    kept, driven = forward @ (np.diag(capacitance) - half), forward[:, :count]
    steps = np.diff(charge_pC, axis=0) @ driven.T
    state = np.zeros((len(charge_pC), size))
    for n, step in enumerate(steps):
        state[n + 1] = kept @ state[n] + step
    return state[:, :count]
