"""p of one case as a product: each left-out piece of physics switched on after the other."""

from dataclasses import dataclass
from math import log, prod

from foundation.arrays import Floats
from softdot.studies.paper.calibration.beam import dot_depth_mm
from softdot.studies.paper.calibration.inputs import Values
from softdot.studies.paper.calibration.press_curve import PressCurve
from softdot.studies.paper.calibration.readout import chain, depth_fraction, swing_V
from softdot.studies.paper.calibration.solved import FOAM, ROUND, SIMULATED, Rig, Solved

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
    """Calibration factor p of a case at given inputs."""
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


def factors(rig: Rig, values: Values) -> dict[str, Factor]:
    """Case -> its factor at given inputs."""
    return {name: factor(solved, values) for name, solved in rig.items()}


def dot_depth(curve: PressCurve, read_mm: float, values: Values) -> float:
    """Depth of the dot in mm when the gauge reads read_mm."""

    def force(depth_mm: float) -> float:
        return float(curve.force_at(depth_mm))

    return dot_depth_mm(read_mm, force, values["beam_length_mm"], values["push_offset_mm"])


def charge_pC(curve: PressCurve, depth_mm: float, press_time_s: float) -> Floats:
    """Short-circuit charge of the film over one period, (chain.SAMPLES,)."""
    return curve.capacitance_pF * curve.voltage_at(depth_mm * depth_fraction(press_time_s))
