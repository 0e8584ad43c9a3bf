"""Laws with memory at the points of one layer: a fractional spectrum, and softening after the largest energy."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.laws import geometric, isochoric
from softdot.studies.proof.world.made import Layer, Spectrum

PER_DECADE, DECADES = 2, 3
"""Branches of the discrete spectrum, and how far it reaches on both sides of its middle."""


@lru_cache(maxsize=256)
def branches(spectrum: Spectrum) -> tuple[Floats, Floats]:
    """Shares and times of log-spaced branches: H(log tau) of the Mittag-Leffler function (Gross 1947), cut and scaled.

    H(x) = sin(pi a) / (2 pi (cosh(a x) + cos(pi a))), x = log(tau / time).
    """
    count = 2 * DECADES * PER_DECADE + 1
    x = np.linspace(-DECADES, DECADES, count) * np.log(10.0)
    angle = np.pi * spectrum.order
    density = np.sin(angle) / (np.cosh(spectrum.order * x) + np.cos(angle))
    return spectrum.strength * density / density.sum(), spectrum.time_s * np.exp(x)


def relaxation(spectrum: Spectrum, time_s: Floats) -> Floats:
    """G(t) / G(0) of the discrete spectrum, (t,)."""
    share, tau = branches(spectrum)
    return 1.0 - spectrum.strength + np.exp(-time_s[:, None] / tau) @ share


@dataclass(frozen=True)
class Memory:
    """Memory of a layer. stress : (n, 3, 3) elastic second Piola-Kirchhoff stress of the last step; parts :
    (b, n, 3, 3) of the branches.

    energy : (n,) largest so far.
    """

    stress: Floats
    parts: Floats
    energy: Floats


def at_rest(layer: Layer, points: int) -> Memory:
    """Memory before anything has happened."""
    count = len(branches(layer.spectrum)[0]) if layer.spectrum else 0
    return Memory(np.zeros((points, 3, 3)), np.zeros((count, points, 3, 3)), np.zeros(points))


def respond(layer: Layer, f: Floats, old: Memory, step_s: float) -> tuple[Floats, Floats, Memory]:
    """P (n, 3, 3), dP/dF and the memory after a step."""
    energy, p, tangent = isochoric(layer, f)
    new = old
    if layer.damage is not None:
        p, tangent = _soften(layer, energy, p, tangent, old.energy)
        new = replace(new, energy=np.maximum(old.energy, energy))
    if layer.spectrum is None:
        return p, tangent, new
    stress: Floats = np.linalg.solve(f, p).astype(np.float64)
    weight, kept = _branch_step(layer.spectrum, step_s)
    rest = np.einsum("b,bnij->nij", kept, old.parts) - weight.sum() * old.stress
    now = 1.0 - layer.spectrum.strength + float(weight.sum())
    memory = replace(
        new,
        stress=stress,
        parts=kept[:, None, None, None] * old.parts + weight[:, None, None, None] * (stress - old.stress),
    )
    return now * p + f @ rest, now * tangent + geometric(rest), memory


def _branch_step(spectrum: Spectrum, step_s: float) -> tuple[Floats, Floats]:
    """New branch stress q <- kept q + weight (s - s_old): trapezium for slow branches, backward Euler for those faster
    than the step.
    """
    share, tau = branches(spectrum)
    a = step_s / tau
    theta = np.where(a < 1.0, 0.5, 1.0)
    return share / (1.0 + theta * a), (1.0 - (1.0 - theta) * a) / (1.0 + theta * a)


def _soften(layer: Layer, energy: Floats, p: Floats, tangent: Floats, largest: Floats) -> tuple[Floats, Floats]:
    """Stress P times 1 - loss tanh((largest - W) / energy) below the largest energy, and its tangent."""
    assert layer.damage is not None
    behind = np.maximum(largest - energy, 0.0) / layer.damage.energy_MPa
    kept = 1.0 - layer.damage.loss * np.tanh(behind)
    slope = np.where(behind > 0.0, layer.damage.loss / layer.damage.energy_MPa / np.cosh(behind) ** 2, 0.0)
    bend = np.einsum("n,nij,nkl->nijkl", slope, p, p)
    return kept[:, None, None] * p, kept[:, None, None, None, None] * tangent + bend
