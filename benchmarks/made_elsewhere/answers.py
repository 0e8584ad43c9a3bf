"""Force and charge along a path: from a curve over depth, and from a course in time where a medium remembers."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from benchmarks.made_elsewhere.chain import Signal, voltage
from benchmarks.made_elsewhere.drives import Path, moments
from benchmarks.made_elsewhere.forward import Fineness, SlicePress
from benchmarks.made_elsewhere.rigs import Bench
from benchmarks.made_elsewhere.visible import CODES_MM, Pair

STATES = 18
MARGIN = 1.05  # a hand goes deeper than it means to
COARSE = Fineness(36, 6.0)  # for what memory adds, which is a small part


class Curve:
    """Cubics through states that are evenly spread over the root of the depth, flat at the first touch."""

    def __init__(self, bench: Bench, fineness: Fineness) -> None:
        self.root = np.linspace(0, np.sqrt(MARGIN * bench.depth), STATES)
        self.states = np.vstack([[0.0, 0.0], SlicePress(bench, fineness).curve(self.root[1:] ** 2)])
        self.spline = CubicSpline(self.root, self.states, bc_type=((1, np.zeros(2)), "not-a-knot"))

    def __call__(self, depth: Signal) -> NDArray[np.float64]:
        """Rows of force and charge; nought while clear."""
        root = np.sqrt(np.clip(depth, 0, None))
        if root.max() > self.root[-1]:
            raise ValueError(f"{depth.max():.4f} mm is beyond the curve")
        return self.spline(root)


@lru_cache(maxsize=None)
def curve(bench: Bench, fineness: Fineness = Fineness()) -> Curve:  # noqa: B008
    """The curve of a rig without memory, pressed once."""
    return Curve(bench, fineness)


def without_memory(bench: Bench) -> Bench:
    """The same with all of its instantaneous stiffness."""
    return replace(bench, medium2=replace(bench.medium2, relative_moduli=(), relaxation_times=()))


def remembered(bench: Bench, press: Path) -> NDArray[np.float64]:
    """What memory adds to force and charge along a path: a course on a coarse mesh less the curve on the same mesh."""
    times = moments(press, bench.depth)
    depth = np.interp(times, press.time, press.depth)
    course = SlicePress(bench, COARSE).course(times, depth)
    added = course - curve(without_memory(bench), COARSE)(depth)
    return np.column_stack([np.interp(press.time, times, added[:, k]) for k in range(2)])


def signals(bench: Bench, press: Path, deeper: float = 0.0) -> tuple[Signal, Signal]:
    """Force in N and voltage at the input in V."""
    both = curve(without_memory(bench))(press.depth + deeper)
    if bench.medium2.relative_moduli:
        both = both + remembered(bench, press)
    return np.clip(both[:, 0], 0, None), voltage(bench, both[:, 1])


def pair(stated: Bench, true: Bench, press: Path) -> Pair:
    """A run as it is stated and as it truly is, without noise."""
    return Pair(signals(stated, press), signals(true, press), signals(stated, press, CODES_MM))
