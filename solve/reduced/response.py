"""What a reduced model gives back, and how far it may be off."""

from dataclasses import dataclass

from foundation.arrays import Floats


@dataclass(frozen=True)
class Raw:
    """Answer before the amplifier: the dot's path from its nominal touch (t,); force, contact area and charges (t, 2 +
    e).
    """

    time_s: Floats
    path_mm: Floats
    outputs: Floats


@dataclass(frozen=True)
class Accuracy:
    """Largest error against the 3D presses kept out of the fit, each a share of the 3D model's largest value.

    force, charge; charge_rate : of the charge's rate between the 3D model's time steps.
    """

    force: float
    charge: float
    charge_rate: float


@dataclass(frozen=True)
class ErrorBound:
    """Largest error of an answer at any time: a margin over what was measured on the presses kept out of the fit."""

    force_N: float
    charge_C: float
    voltage_V: float


@dataclass(frozen=True)
class ReducedResponse:
    """Over time (t,): the dot's path, the force sensor's reading, the charge and the amplifier's voltage.

    charge_C is that of the electrodes on this amplifier together, electrode_charge_C (t, e) of each.
    """

    time_s: Floats
    dot_path_mm: Floats
    force_N: Floats
    charge_C: Floats
    electrode_charge_C: Floats
    voltage_V: Floats
    error_bound: ErrorBound
