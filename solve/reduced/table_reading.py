"""Reading the table of a reduced model: outputs as a function of depth and of the memory's amplitudes."""

from foundation.arrays import Floats, Ints
from solve.compiled import piece

MOST_BALANCE_STEPS = 60  # of the search for a depth
DEPTH_TOLERANCE = 1e-12  # of the full depth


@piece()
def set_features(alpha: Floats, pairs: Ints, features: Floats) -> None:
    """Write the features: 1, alpha, and products of pairs of alpha."""
    count = len(alpha)
    features[0] = 1.0
    for r in range(count):
        features[1 + r] = alpha[r]
    for p in range(len(pairs)):
        features[1 + count + p] = alpha[pairs[p, 0]] * alpha[pairs[p, 1]]


@piece()
def first_touch(touch: Floats, features: Floats) -> float:
    """Depth at which the dot touches, with these features (f,) of the memory."""
    depth = 0.0
    for f in range(len(features)):
        depth += touch[f] * features[f]
    return depth


@piece()
def read_outputs(table: Floats, features: Floats, touch: float, full: float, depth: float, outputs: Floats) -> None:
    """Write all outputs (o,) at a depth; below touch those of the free segment."""
    cells = len(table) - 1
    at = max(0.0, (depth - touch) / (full - touch)) * cells
    cell = min(int(at), cells - 1)
    x = at - cell
    above, below = table[cell], table[cell + 1]
    for o in range(len(outputs)):
        outputs[o] = (1.0 - x) * above[0, o] + x * below[0, o]
    for f in range(1, len(features)):
        here, there = (1.0 - x) * features[f], x * features[f]
        for o in range(len(outputs)):
            outputs[o] += here * above[f, o] + there * below[f, o]


@piece()
def force_and_slope(table: Floats, features: Floats, touch: float, full: float, depth: float) -> tuple[float, float]:
    """Contact force and its slope over depth; at touch that to the right."""
    cells = len(table) - 1
    at = max(0.0, (depth - touch) / (full - touch)) * cells
    cell = min(int(at), cells - 1)
    here, there = 0.0, 0.0
    for f in range(len(features)):
        here += table[cell, f, 0] * features[f]
        there += table[cell + 1, f, 0] * features[f]
    return here + (at - cell) * (there - here), (there - here) * cells / (full - touch)


@piece()
def balance(
    table: Floats, features: Floats, touch: float, full: float, spring: float, push: float, guess: float
) -> float:
    """Depth where spring depth + F(depth) = push: Newton's method inside a shrinking bracket."""
    if push <= spring * touch:
        return push / spring if spring > 0.0 else touch
    low, high = touch, 2.0 * full - touch  # the last cell goes on, so that the caller sees what is too deep
    depth = min(max(guess, low), high)
    for _ in range(MOST_BALANCE_STEPS):
        force, slope = force_and_slope(table, features, touch, full, depth)
        excess = force + spring * depth - push
        if excess > 0.0:
            high = depth
        else:
            low = depth
        step = -excess / max(slope + spring, 1e-300)
        if abs(step) <= DEPTH_TOLERANCE * full or high - low <= DEPTH_TOLERANCE * full:
            break
        depth += step
        if not low < depth < high:
            depth = 0.5 * (low + high)
    return depth
