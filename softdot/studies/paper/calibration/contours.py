"""Which input resistance and press time give the printed p."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from foundation.arrays import Floats
from softdot.studies.paper.calibration.factor import charge_pC, dot_depth
from softdot.studies.paper.calibration.inputs import assumed_inputs
from softdot.studies.paper.calibration.press_curve import PressCurve
from softdot.studies.paper.calibration.readout import chain, swing_V
from softdot.studies.paper.calibration.solved import FOAM, SIMULATED, Solved
from softdot.studies.paper.published import published_numbers

RESISTANCES_MOHM = (0.1, 30.0)
"""What is searched and drawn."""
TIMES_S = tuple(float(t) for t in np.linspace(0.1, 0.5, 17))


@dataclass(frozen=True)
class Rest:
    """What R and T do not change: ideal voltage, press of the real sensor, depth of its dot in mm."""

    ideal_V: float
    curve: PressCurve
    depth_mm: float

    def p(self, resistance_MOhm: float, press_time_s: float) -> float:
        """Calibration factor p with the assumed inputs but these two."""
        charge = charge_pC(self.curve, self.depth_mm, press_time_s)
        values = assumed_inputs(resistance_MOhm=resistance_MOhm)
        return self.ideal_V / swing_V(charge, self.curve.capacitance_pF, chain(values))


def rest(solved: Solved) -> Rest:
    """Inputs as assumed, without R and T."""
    values = assumed_inputs()
    real, read_mm = solved.curve(FOAM, values), solved.case.depth_mm
    ideal = float(solved.curve(SIMULATED, values).voltage_at(read_mm))
    return Rest(ideal, real, dot_depth(real, read_mm, values))


def resistance_for(solved: Solved, p: float, press_time_s: float) -> float | None:
    """Input resistance in MΩ that gives p at a press time; None where none between RESISTANCES_MOHM does."""

    found = rest(solved)

    def excess(logarithm: float) -> float:
        return float(np.log(found.p(float(np.exp(logarithm)), press_time_s) / p))

    low, high = np.log(RESISTANCES_MOHM)
    if excess(low) * excess(high) > 0.0:
        return None
    return float(np.exp(brentq(excess, low, high, xtol=1e-4)))


def time_for(solved: Solved, p: float, resistance_MOhm: float) -> float | None:
    """Press time in s that gives p at an input resistance; None where none between TIMES_S does."""

    found = rest(solved)

    def excess(time_s: float) -> float:
        return found.p(resistance_MOhm, time_s) - p

    if excess(TIMES_S[0]) * excess(TIMES_S[-1]) > 0.0:
        return None
    return float(brentq(excess, TIMES_S[0], TIMES_S[-1], xtol=1e-4))


def curve(solved: Solved, p: float, times_s: Sequence[float] = TIMES_S) -> list[tuple[float, float]]:
    """Pairs of press time in s and resistance in MΩ that give p."""
    found = [(time, resistance_for(solved, p, time)) for time in times_s]
    return [(time, resistance) for time, resistance in found if resistance is not None]


def grid(solved: Solved, resistances_MOhm: Floats, times_s: Floats) -> Floats:
    """Calibration factor p (t, r) over press times (t,) and resistances (r,)."""
    found = rest(solved)
    return np.array([[found.p(float(r), float(t)) for r in resistances_MOhm] for t in times_s])


def printed_factor(case: str) -> float:
    """Calibration factor p of a case as Table 1 prints it."""
    return published_numbers()[f"table1.{case}.p"].value
