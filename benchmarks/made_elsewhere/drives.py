"""Paths of the ridge as a hand or a stage makes them: what is meant, and what is done."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

RATE = 500.0  # rows a second
REST = 0.9  # s before a press
AFTER = 1.0
TREMOR = 0.15  # s, correlation time of the jitter


@dataclass(frozen=True)
class Path:
    """Depth of the ridge in mm over time, negative while clear of the segment; meant is without jitter."""

    label: str
    time: NDArray[np.float64]
    meant: NDArray[np.float64]
    depth: NDArray[np.float64]


def knots(kind: str, depth: float, pace: float) -> tuple[str, NDArray[np.float64], NDArray[np.float64]]:
    """Label, times and shares of the travel of one press; pace is a time in s, or a rate in Hz of a sinusoid."""
    if kind == "half-sine":
        t = np.linspace(0, pace, 400)
        return f"half-sine {pace:.1f} s, {depth:.2f} mm", t, np.sin(np.pi * t / pace)
    if kind == "sinusoid":
        cycles = max(1, round(min(4, 4 * pace)))
        t = np.linspace(0, cycles / pace, 400 * cycles)
        return f"{pace:.1f} Hz, {depth:.2f} mm", t, 0.5 - 0.5 * np.cos(2 * np.pi * pace * t)
    if kind == "hold":
        return f"ramp and hold, {depth:.2f} mm", np.cumsum([0, pace, 2.5, 0.6 * pace]), np.array([0.0, 1, 1, 0])
    if kind == "steps":
        moves = [0, pace, 0.8, pace, 0.8, pace, 0.8, 1.5 * pace]
        return f"three steps, {depth:.2f} mm", np.cumsum(moves), np.array([0, 0.4, 0.4, 0.7, 0.7, 1, 1, 0])
    if kind == "there and back":
        moves = [0, pace, 0.7, pace, 0.7, pace]
        return f"two steps, down again by one, {depth:.2f} mm", np.cumsum(moves), np.array([0, 1, 1, 0.5, 0.5, 0])
    raise ValueError(kind)


def path(kind: str, depth: float, pace: float, clear: float, rng: np.random.Generator) -> Path:
    """One press, made by a hand that misses the depth by a percent and trembles by a few micrometres."""
    label, at, share = knots(kind, depth, pace)
    time = np.arange(0, REST + at[-1] + AFTER, 1 / RATE)
    done = np.interp(time, REST + at, share)
    width = round(0.008 * RATE)  # a stage rounds its corners
    done = np.convolve(np.pad(done, width, mode="edge"), np.hanning(2 * width + 1) / width, mode="valid")
    meant = -clear + (clear + depth * (1 + 0.008 * rng.standard_normal())) * done
    memory = np.exp(-1 / (RATE * TREMOR))
    shake = lfilter([np.sqrt(1 - memory**2)], [1, -memory], rng.standard_normal(len(time)))
    shake = np.convolve(shake, np.ones(9) / 9, mode="same")  # no hand shakes faster
    return Path(label, time, meant, meant + 0.004 * depth * shake * np.clip(done, 0, 1))


def programme(depth: float, clear: float, rng: np.random.Generator) -> list[Path]:
    """Five presses: a half-sine, a hold, two rates of a sinusoid, and steps; the first is never the deepest."""
    kinds = [
        ("half-sine", 0.65 * depth, rng.choice([0.4, 0.6, 1.0, 1.5])),
        ("hold", depth, rng.choice([0.15, 0.3, 0.5])),
        ("sinusoid", rng.uniform(0.4, 0.6) * depth, rng.choice([2.0, 3.0, 4.0])),
        ("sinusoid", rng.uniform(0.85, 1.0) * depth, rng.choice([0.3, 0.5, 0.7])),
        (rng.choice(["steps", "there and back"]), rng.uniform(0.8, 1.0) * depth, rng.choice([0.1, 0.2, 0.4])),
    ]
    order = [0, *(1 + rng.permutation(4))]
    return [path(str(kinds[n][0]), float(kinds[n][1]), float(kinds[n][2]), clear, rng) for n in order]
