"""p of one case as a product: each left-out piece of physics switched on after the other.

The read-out of the rig while the same press is repeated once a second.

The film's charge Q(t) drives R parallel to film and cable, and an eighth-order low-pass follows:
    (C_f + C) V' + V / R = Q',        V_hat = i w Q_hat / (1/R + i w (C_f + C)) H(w).
Everything is linear and periodic, so that the steady state after many presses follows exactly from the Fourier series
of one period. A single press from rest is integrated in time by solve.readout.course.

The range of p over all unknown inputs at once, and which of them makes it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import log, prod

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, freqs
from scipy.stats import qmc, rankdata

from geometry.arrays import Floats
from softdot.studies.paper.calibration.rig import INPUTS, Values, dot_depth_mm
from softdot.studies.paper.calibration.solved import FOAM, ROUND, SIMULATED, PressCurve, Solved
from solve.model import Waveform
from solve.solution.schedule import fraction

PERIOD_S = 1.0  # ten presses in ten seconds
SAMPLES = 2048
LOW_PASS_HZ = 60.0
ORDER = 8  # 48 dB per octave


@dataclass(frozen=True)
class Chain:
    """Input resistance and capacitance, in parallel to the film, and whether the low-pass is on."""

    resistance_MOhm: float
    capacitance_pF: float
    filtered: bool = True


def times_s() -> Floats:
    """One period (SAMPLES,)."""
    return PERIOD_S * np.arange(SAMPLES) / SAMPLES


def pressed(press_time_s: float) -> Floats:
    """Fraction of the depth (SAMPLES,): a raised cosine down in the press time, up in the same, then nothing."""
    to_deepest = np.abs(times_s() - press_time_s)
    return fraction(Waveform(shape="raised-cosine", rise_s=press_time_s), press_time_s - to_deepest)


def recorded_V(charge_pC: Floats, film_capacitance_pF: float, chain: Chain) -> Floats:
    """Recorded voltage (..., SAMPLES) of a periodic charge (..., SAMPLES)."""
    rate = 2j * np.pi * np.fft.rfftfreq(SAMPLES, PERIOD_S / SAMPLES)
    conductance = 1.0 / (1e6 * chain.resistance_MOhm)
    admittance = conductance + rate * 1e-12 * (film_capacitance_pF + chain.capacitance_pF)
    spectrum = np.fft.rfft(1e-12 * charge_pC) * rate / admittance
    if chain.filtered:
        spectrum = spectrum * _low_pass()
    return np.asarray(np.fft.irfft(spectrum, SAMPLES))


def swing_V(charge_pC: Floats, film_capacitance_pF: float, chain: Chain) -> float:
    """Maximum minus minimum of the recorded voltage: the paper's V_B - V_A."""
    return float(np.ptp(recorded_V(charge_pC, film_capacitance_pF, chain)))


@cache
def _low_pass() -> NDArray[np.complex128]:
    """Response (SAMPLES / 2 + 1,) of the Butterworth filter."""
    angular = 2.0 * np.pi * np.fft.rfftfreq(SAMPLES, PERIOD_S / SAMPLES)
    coefficients = butter(ORDER, 2.0 * np.pi * LOW_PASS_HZ, analog=True)
    return np.asarray(freqs(*coefficients, worN=angular)[1])


DIMENSION, SPONGE, BEAM, LEAKAGE, FILTER = "2D for 3D", "foam", "beam", "leakage", "filter"
PIECES = (DIMENSION, SPONGE, BEAM, LEAKAGE, FILTER)
"""In the order in which they are switched on."""


@dataclass(frozen=True)
class Factor:
    """Normalised output D, in V/mm: of the ideal cross-section first, then with each more of PIECES."""

    outputs_V_per_mm: tuple[float, ...]

    @property
    def pieces(self) -> dict[str, float]:
        """Piece -> by how much it divides the output."""
        before, after = self.outputs_V_per_mm[:-1], self.outputs_V_per_mm[1:]
        return dict(zip(PIECES, (b / a for b, a in zip(before, after, strict=True)), strict=True))

    @property
    def p(self) -> float:
        """The product of the pieces: simulated over recorded output."""
        return prod(self.pieces.values())

    @property
    def shares(self) -> dict[str, float]:
        """Piece -> its share of the logarithm of p; they add up to one."""
        return {piece: log(factor) / log(self.p) for piece, factor in self.pieces.items()}


def factor(solved: Solved, values: Values) -> Factor:
    """p of a case at given inputs."""
    depth = solved.case.depth_mm
    real = solved.curve(FOAM, values)
    reached = dot_depth(real, depth, values)
    film_pF = real.capacitance_pF
    charge = charge_pC(real, reached, values["press_time_s"])
    voltages = (
        float(solved.curve(SIMULATED, values).voltage_at(depth)),
        float(solved.curve(ROUND, values).voltage_at(depth)),
        float(real.voltage_at(depth)),
        float(real.voltage_at(reached)),
        swing_V(charge, film_pF, chain(values, filtered=False)),
        swing_V(charge, film_pF, chain(values)),
    )
    return Factor(tuple(voltage / depth for voltage in voltages))


def factors(rig: Mapping[str, Solved], values: Values) -> dict[str, Factor]:
    """Case -> its factor at given inputs."""
    return {name: factor(solved, values) for name, solved in rig.items()}


def dot_depth(curve: PressCurve, read_mm: float, values: Values) -> float:
    """Depth of the dot in mm when the gauge reads read_mm."""

    def force(depth_mm: float) -> float:
        return float(curve.force_at(depth_mm))

    return dot_depth_mm(read_mm, force, values["beam_length_mm"], values["push_offset_mm"])


def charge_pC(curve: PressCurve, depth_mm: float, press_time_s: float) -> Floats:
    """Short-circuit charge of the film over one period, (chain.SAMPLES,)."""
    return curve.capacitance_pF * curve.voltage_at(depth_mm * pressed(press_time_s))


def chain(values: Values, filtered: bool = True) -> Chain:
    """The read-out of given inputs."""
    return Chain(values["resistance_MOhm"], values["capacitance_pF"], filtered)


SAMPLE_EXPONENT = 9
"""2^9 quasi-random samples."""
QUANTILES = (0.05, 0.5, 0.95)


@dataclass(frozen=True)
class Ranges:
    """Results of n samples. shares : (n, k) where in its range each of the k inputs stands, 0 to 1."""

    shares: Floats
    factors: Mapping[str, tuple[Factor, ...]]
    """Case -> one factor a sample."""

    def p(self, case: str) -> Floats:
        """p of every sample (n,)."""
        return np.array([factor.p for factor in self.factors[case]])

    def ratio(self) -> Floats:
        """p of case II over that of case I, both with the same inputs, (n,)."""
        return self.p("II") / self.p("I")

    def pieces(self, case: str) -> dict[str, Floats]:
        """Piece -> its factor in every sample (n,)."""
        return {piece: np.array([factor.pieces[piece] for factor in self.factors[case]]) for piece in PIECES}

    def drivers(self, case: str) -> dict[str, float]:
        """Input -> square of its rank correlation with p: the part of the spread that it explains alone."""
        target = rankdata(self.p(case))
        columns = zip(INPUTS, self.shares.T, strict=True)
        return {name: float(np.corrcoef(rankdata(column), target)[0, 1]) ** 2 for name, column in columns}


def ranges(rig: Mapping[str, Solved], exponent: int = SAMPLE_EXPONENT) -> Ranges:
    """Sobol's quasi-random samples of all inputs, 2^exponent, each evenly over its range."""
    sampler = qmc.Sobol(len(INPUTS), seed=0)
    shares = np.asarray(sampler.random_base2(exponent))
    found = [
        factors(rig, {name: entry.at(share) for (name, entry), share in zip(INPUTS.items(), row, strict=True)})
        for row in shares
    ]
    return Ranges(shares, {case: tuple(each[case] for each in found) for case in rig})


def quantiles(values: Floats) -> tuple[float, float, float]:
    """5 %, median and 95 % of samples (n,)."""
    low, middle, high = np.quantile(values, QUANTILES)
    return float(low), float(middle), float(high)
