"""Courses of touches on one grid: spikes and resting values removed, as many steps as are learned, shifts in time."""

import numpy as np
from scipy.ndimage import median_filter

from foundation.arrays import Floats
from softdot.reading.learned_kernel.touches import Touches

STEPS, SPIKE_SHARE, REST_SHARE = 32, 0.1, 0.16
"""Steps of a course; shares of a touch over which a median removes spikes, and that comes before any dot."""


def courses_of(touches: Touches, keep_rest: bool, place_range_mm: list[float] | None) -> Floats:
    """Values (n, STEPS, c) over time, or over the place within place_range_mm where that was measured."""
    samples = touches.taxels.shape[1]
    width = 2 * round(0.5 * (SPIKE_SHARE * samples - 1)) + 1
    values = median_filter(touches.taxels, size=(1, max(width, 1), 1), mode="nearest")
    if not keep_rest:
        values = values - np.median(values[:, : max(1, round(REST_SHARE * samples))], axis=1, keepdims=True)
    if place_range_mm is None or touches.place_mm is None:
        return means_in_steps(values)
    return np.array(
        [_over_place(one, place, place_range_mm) for one, place in zip(values, touches.place_mm, strict=True)]
    )


def means_in_steps(values: Floats) -> Floats:
    """Means (n, STEPS, c) of values (n, t, c) over equal parts of the time."""
    samples = values.shape[1]
    total = np.concatenate([np.zeros_like(values[:, :1]), np.cumsum(values, axis=1)], axis=1)
    edges = np.linspace(0.0, samples, STEPS + 1)
    low = np.minimum(edges.astype(int), samples - 1)
    share = (edges - low)[None, :, None]
    return np.asarray(np.diff(total[:, low] * (1.0 - share) + total[:, low + 1] * share, axis=1) * STEPS / samples)


def noise_at_rest(courses: Floats) -> float:
    """Root mean square by which courses (n, STEPS, c) change within the part before any dot."""
    before = courses[:, : max(1, round(REST_SHARE * STEPS))]
    return float(np.sqrt(np.mean(before.var(axis=1))))


def compressed(courses: Floats, limit: Floats) -> Floats:
    """Courses (n, t, c) that grow as their logarithm beyond a limit (c,), by the inverse hyperbolic sine."""
    finite = np.isfinite(limit)
    scale = np.where(finite, limit, 1.0)
    return np.where(finite, scale * np.arcsinh(courses / scale), courses)


def shift_courses(courses: Floats, steps: Floats | float) -> Floats:
    """Courses (n, t, c) that come as many steps (n,) earlier, the values at the ends held."""
    count, length, _ = courses.shape
    at = np.arange(length) + np.broadcast_to(np.asarray(steps, dtype=np.float64), (count,))[:, None]
    at = np.clip(at, 0.0, length - 1.0)
    low = np.minimum(at.astype(int), length - 2)
    share, row = (at - low)[..., None], np.arange(count)[:, None]
    return np.asarray(courses[row, low] * (1.0 - share) + courses[row, low + 1] * share)


def place_range_of(touches: Touches) -> list[float] | None:
    """Places in mm that every touch covers; None where none were measured."""
    if touches.place_mm is None:
        return None
    return [float(touches.place_mm.min(axis=1).max()), float(touches.place_mm.max(axis=1).min())]


def _over_place(values: Floats, place_mm: Floats, place_range_mm: list[float]) -> Floats:
    """Means (STEPS, c) of one touch in equal parts of the way; parts without a sample lie between the others."""
    edges = np.linspace(place_range_mm[0], place_range_mm[1], STEPS + 1)
    part = np.digitize(place_mm, edges) - 1
    middles = 0.5 * (edges[1:] + edges[:-1])
    held = np.array([number for number in range(STEPS) if (part == number).any()])
    means = np.array([values[part == number].mean(axis=0) for number in held])
    return np.stack([np.interp(middles, middles[held], one) for one in means.T], axis=1)
