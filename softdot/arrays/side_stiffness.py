"""The lone segment with elastic sides that best stands for a segment of an array.

The paper believes the sides of a segment among others to be "something between Free and Clamped". Here that something
is a number: the stiffness k of segment.side_stiffness_N_per_mm3, the same on all sides and in all directions, with
which a lone segment comes nearest to force and voltage of an inner, an edge and a corner segment over the whole press.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import minimize_scalar

from foundation.arrays import Floats
from geometry.array.layout import ArrayLayout
from geometry.parameters import LayerName
from softdot.arrays.case import ArrayCase
from softdot.arrays.matrix import CrosstalkMatrix
from softdot.arrays.presses import ArrayPresses, Signals
from softdot.arrays.roles import representatives
from softdot.prepared_press import PreparedPress

STIFFNESSES_N_PER_MM3 = (0.01, 0.1, 0.5, 2.0, 10.0, 50.0, 300.0, 3000.0)


@dataclass(frozen=True)
class Likeness:
    """Nearness of a lone segment to one of an array: errors of force, or of depth where a force is prescribed, and of
    voltage at full load, and the root of the mean square of both over the press, each relative to its largest value in
    the array.
    """

    force_percent: float | None
    depth_percent: float | None
    voltage_percent: float
    rms_percent: float


@dataclass(frozen=True)
class EffectiveSides:
    """The lone segment that stands best for one of the array, beside a free and a clamped one.

    held_layers : which layers its sides are held at. at_limit : the best is at the end of the range that was looked at;
    it is then as good as free or clamped.
    """

    label: str
    held_layers: tuple[LayerName, ...]
    stiffness_N_per_mm3: float
    at_limit: bool
    best: Likeness
    free: Likeness
    clamped: Likeness


def held_candidates(layout: ArrayLayout) -> list[tuple[LayerName, ...]]:
    """Layers that springs may hold: those of a segment to whose sides something is joined; these without medium 2,
    which closes a cavity where its sides are held; the film alone, a thousand times stiffer than the rest.
    """
    array = layout.array
    joined = tuple(dict.fromkeys((*array.grid_layers, *array.shared)))
    without = tuple(name for name in joined if name != "medium2")
    film = tuple(name for name in joined if name == "film")
    return list(dict.fromkeys((joined, without, film)))


@dataclass(frozen=True)
class Sides:
    """The sides of a lone segment: boundary of [segment], the layers that are held, and the stiffness of springs."""

    boundary: str
    held: tuple[LayerName, ...] = ()
    stiffness_N_per_mm3: float = 0.0

    @property
    def name(self) -> str:
        """Words for the sides."""
        spring = f" {self.stiffness_N_per_mm3:.4g} N/mm3" if self.boundary == "elastic" else ""
        return f"lone segment, {self.boundary}{spring}, {' '.join(self.held) or 'no layer'} held"

    def press(self, case: ArrayCase) -> PreparedPress:
        """Press of one segment of an array alone, with these sides."""
        update = {
            "boundary": self.boundary,
            "held_layers": self.held,
            "side_stiffness_N_per_mm3": self.stiffness_N_per_mm3,
        }
        alone = case.lone(case.config.segment.model_copy(update=update))
        return alone.press_over(alone.layout.places[0])


FREE = Sides("free")


def lone_sides(layout: ArrayLayout) -> list[Sides]:
    """Sides that are pressed whatever comes out; none for one segment."""
    if len(layout.places) == 1:
        return []
    return [Sides("elastic", held, k) for held in held_candidates(layout) for k in STIFFNESSES_N_PER_MM3] + [FREE]


def lone_presses(case: ArrayCase, sides: Sequence[Sides]) -> dict[str, PreparedPress]:
    """Presses of the lone segment with each of the sides, by their names."""
    return {one.name: one.press(case) for one in sides}


def effective_sides(matrix: CrosstalkMatrix, solve: ArrayPresses) -> dict[str, EffectiveSides]:
    """Sides that stand best for each role that the array has; none for one segment. StoppedPressError.

    Lone segments are pressed over a range of stiffness, for each set of layers that springs may hold. Their force and
    voltage, interpolated over the logarithm of the stiffness, give the best set and stiffness; that one is pressed
    itself, and its errors are the ones that count.
    """
    case, layout = matrix.case, matrix.layout
    lone = solve(lone_presses(case, lone_sides(layout)))
    if not lone:
        return {}
    by_force = case.config.press.force_N is not None
    families = {
        held: [_response(lone[Sides("elastic", held, k).name], by_force) for k in STIFFNESSES_N_PER_MM3]
        for held in held_candidates(layout)
    }
    roles = representatives(layout)
    targets = {role: _response(matrix.press(n), by_force, matrix.image_numbers(n)[n]) for role, n in roles.items()}
    bests = {
        role: min((_best(held, curves, target) for held, curves in families.items()), key=lambda one: one.mean_square)
        for role, target in targets.items()
    }
    beside = {role: (best.sides, FREE, Sides("clamped", best.held)) for role, best in bests.items()}
    lone |= solve(lone_presses(case, [one for three in beside.values() for one in three]))
    found = {}
    for role, best in bests.items():
        likeness = [_likeness(_response(lone[one.name], by_force), targets[role], by_force) for one in beside[role]]
        label = layout.places[roles[role]].label
        found[role] = EffectiveSides(label, best.held, best.stiffness_N_per_mm3, best.at_limit, *likeness)
    return found


def _response(found: Signals, by_force: bool, number: int = 0) -> Floats:
    """Force, or depth under a prescribed force, and voltage of the pressed segment, (2, s)."""
    return np.stack([found.depth_mm if by_force else found.force_N, found.voltage_V[:, number]])


def _errors(one: Floats, target: Floats) -> Floats:
    """Errors (2, s) of a response relative to the largest value of each of its rows."""
    return np.asarray((one - target) / np.abs(target).max(axis=1, keepdims=True))


def _likeness(one: Floats, target: Floats, by_force: bool) -> Likeness:
    errors = 100.0 * _errors(one, target)
    answer, voltage = (float(error) for error in errors[:, -1])
    rms = float(np.sqrt(np.mean(errors[:, 1:] ** 2)))
    return Likeness(None if by_force else answer, answer if by_force else None, voltage, rms)


@dataclass(frozen=True)
class _Interpolated:
    """The best stiffness for one set of held layers, as far as interpolation tells."""

    held: tuple[LayerName, ...]
    stiffness_N_per_mm3: float
    at_limit: bool
    mean_square: float

    @property
    def sides(self) -> Sides:
        """Sides with the best stiffness, which are then pressed."""
        return Sides("elastic", self.held, self.stiffness_N_per_mm3)


def _best(held: tuple[LayerName, ...], lone: Sequence[Floats], target: Floats) -> _Interpolated:
    """The stiffness of least mean square error between the smallest and the largest; lone : responses (2, s)."""
    decades = np.log10(STIFFNESSES_N_PER_MM3)
    between = PchipInterpolator(decades, np.array(lone))

    def square(decade: float) -> float:
        return float(np.mean(_errors(between(decade), target) ** 2))

    trials = np.linspace(decades[0], decades[-1], 201)
    start = trials[int(np.argmin([square(decade) for decade in trials]))]
    width = trials[1] - trials[0]
    bounds = (max(start - width, decades[0]), min(start + width, decades[-1]))
    found = minimize_scalar(square, bounds=bounds, method="bounded", options={"xatol": 1e-3})
    at_limit = bool(min(found.x - decades[0], decades[-1] - found.x) < 2e-3)
    return _Interpolated(held, float(f"{10.0**found.x:.4g}"), at_limit, float(found.fun))


def as_dict(sides: EffectiveSides) -> dict[str, Any]:
    """The sides as array.json has them."""
    return {**vars(sides), **{name: vars(getattr(sides, name)) for name in ("best", "free", "clamped")}}
