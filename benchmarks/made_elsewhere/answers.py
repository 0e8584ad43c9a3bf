"""Force and charge along a path: from a curve over depth, and from its memory where a medium relaxes."""

from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from benchmarks.made_elsewhere.chain import Signal, voltage
from benchmarks.made_elsewhere.drives import RATE, Path
from benchmarks.made_elsewhere.forward import SlicePress
from benchmarks.made_elsewhere.rigs import Bench
from benchmarks.made_elsewhere.visible import CODES_MM, Pair

STATES = 18
MARGIN = 1.05  # a hand goes deeper than it means to
SOFTER = 0.1  # share of the shear modulus by which its part in an answer is found


class Curve:
    """Cubics through states that are evenly spread over the root of the depth, flat at the first touch."""

    def __init__(self, bench: Bench) -> None:
        self.root = np.linspace(0, np.sqrt(MARGIN * bench.depth), STATES)
        self.states = np.vstack([[0.0, 0.0], SlicePress(bench).curve(self.root[1:] ** 2)])
        self.spline = CubicSpline(self.root, self.states, bc_type=((1, np.zeros(2)), "not-a-knot"))

    def __call__(self, depth: Signal) -> NDArray[np.float64]:
        """Rows of force and charge; nought while clear."""
        root = np.sqrt(np.clip(depth, 0, None))
        if root.max() > self.root[-1]:
            raise ValueError(f"{depth.max():.4f} mm is beyond the curve")
        return self.spline(root)


@cache
def curve(bench: Bench) -> Curve:
    """The curve of a rig without memory, pressed once."""
    return Curve(bench)


def elastic(bench: Bench) -> Bench:
    """The mechanics of a rig with all of its instantaneous stiffness."""
    cushion = replace(bench.medium2, relative_moduli=(), relaxation_times=())
    return replace(bench, leak=None, cable=None, medium2=cushion)


def softer(bench: Bench) -> Bench:
    """Medium 2 with a smaller shear modulus and the same bulk modulus."""
    shear, bulk = (1 - SOFTER) * bench.medium2.shear, bench.medium2.bulk
    young = 9 * bulk * shear / (3 * bulk + shear)
    poisson = (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))
    return replace(bench, medium2=replace(bench.medium2, modulus=young, poisson=poisson))


def relaxed(bench: Bench, press: Path) -> NDArray[np.float64]:
    """What relaxation of medium 2 takes from force and charge along a path.

    Quasi-linear (Fung, Biomechanics, 1981, section 7.6): with A(depth) the part of an answer that is due to the
    shear modulus, dF / d ln G, what is missing of it is sum g_i (A - A * exp(-t / tau_i) / tau_i), by first order in g.
    """
    stiff = elastic(bench)
    part = (curve(stiff)(press.depth) - curve(softer(stiff))(press.depth)) / SOFTER
    missing = np.zeros_like(part)
    for share, tau in zip(bench.medium2.relative_moduli, bench.medium2.relaxation_times, strict=True):
        a = 1 / (RATE * tau)
        rises = np.diff(part, axis=0, prepend=part[:1])
        missing += share * (part - lfilter([-np.expm1(-a) / a], [1.0, -np.exp(-a)], rises, axis=0))
    return missing


def signals(bench: Bench, press: Path, deeper: float = 0.0) -> tuple[Signal, Signal]:
    """Force in N and voltage at the input in V."""
    both = curve(elastic(bench))(press.depth + deeper)
    if bench.medium2.relative_moduli:
        both = both - relaxed(bench, press)
    return np.clip(both[:, 0], 0, None), voltage(bench, both[:, 1])


def pair(stated: Bench, true: Bench, press: Path) -> Pair:
    """A run as it is stated and as it truly is, without noise."""
    return Pair(signals(stated, press), signals(true, press), signals(stated, press, CODES_MM))
