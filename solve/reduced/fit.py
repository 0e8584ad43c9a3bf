"""From samples to one table: every output as a function of depth and of the memory's amplitudes.

At each depth node an output is fitted as
    y = y0 + sum_r G_r alpha_r + sum_kl H_kl p_k p_l,      p_k the first amplitude of layer k.
For a linear segment in unchanging contact y0 + G alpha is exact, as M enters the equations as a given load; H takes
what contact and large deflection add. Between the nodes Akima's interpolation, modified against overshoot (Akima,
J. ACM 17, 1970), which also serves the kinks that a coarse contact surface has.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from mesh.types import Floats, Ints
from solve.reduced.modes import leading_modes
from solve.reduced.sampling import CROWDING, Sample

CELLS = 1024
MODES = 2  # of each layer: as many as memories are sampled; more would be directions without samples


@dataclass(frozen=True)
class Fit:
    """table (cells + 1, f, o) and touch (f,) as solve.reduced.response_kernel.follow takes them.

    owner (r,) layer of each amplitude; pairs (p, 2) of amplitudes; missing : largest share of a layer's elastic
    stress that its modes leave out.
    """

    table: Floats
    touch: Floats
    owner: Ints
    pairs: Ints
    missing: float


def fit(samples: Sequence[Sample], layers: Sequence[str]) -> Fit:
    """The table; samples[0] is the elastic press, all others have a memory."""
    stress, memory, owner, missing = [], [], [], 0.0
    for number, name in enumerate(layers):
        snapshots, remembered = _coordinates(samples, name)
        rotation, left_out = leading_modes(snapshots, MODES)
        missing = max(missing, left_out)
        stress.append((snapshots @ rotation).reshape(len(samples), -1, rotation.shape[1]))
        memory.append(remembered @ rotation)
        owner += [number] * rotation.shape[1]
    pairs = _pairs(np.array(owner, dtype=np.int64), len(layers))
    outputs = np.concatenate([np.array([s.outputs for s in samples]), *stress], axis=2)
    alpha = np.concatenate(memory, axis=1) if memory else np.zeros((len(samples), 0))
    features = np.concatenate([alpha, alpha[:, pairs[:, 0]] * alpha[:, pairs[:, 1]]], axis=1)
    touch = np.array([s.touch_mm for s in samples])
    nodes = _affine(features, outputs)
    return Fit(_table(nodes), _affine(features, touch), np.array(owner, dtype=np.int64), pairs, missing)


def _coordinates(samples: Sequence[Sample], layer: str) -> tuple[Floats, Floats]:
    """Elastic stress (s n, b) and memory (s, b) of a layer in its whole basis."""
    size = max(len(c) for s in samples for c in [*s.stress[layer], *([s.memory[layer]] if layer in s.memory else [])])
    stress = [np.pad(c, (0, size - len(c))) for s in samples for c in s.stress[layer]]
    memory = [s.memory.get(layer, np.zeros(0)) for s in samples]
    return np.array(stress), np.array([np.pad(c, (0, size - len(c))) for c in memory])


def _pairs(owner: Ints, layers: int) -> Ints:
    """Pairs (p, 2) of the first amplitudes of all layers."""
    first = [int(np.argmax(owner == number)) for number in range(layers)]
    return np.array(list(combinations_with_replacement(first, 2)), dtype=np.int64).reshape(-1, 2)


def _affine(features: Floats, values: Floats) -> Floats:
    """Coefficients (..., 1 + f, ...) of values (s, ...) over features (s, f): exact at s = 0, else least squares.

    Scaled by what the samples span, so that a direction without samples gets a coefficient of zero.
    """
    flat = values.reshape(len(values), -1)
    coefficients = np.zeros((1 + features.shape[1], flat.shape[1]))
    coefficients[0] = flat[0]
    if len(values) > 1:
        scale = np.maximum(np.abs(features).max(axis=0), 1e-300)
        solved = np.linalg.lstsq(features[1:] / scale, flat[1:] - flat[0], rcond=1e-9)[0]
        coefficients[1:] = solved / scale[:, None]
    shaped = coefficients.reshape(-1, *values.shape[1:])
    return shaped if values.ndim == 1 else np.ascontiguousarray(shaped.swapaxes(0, 1))


def _table(nodes: Floats) -> Floats:
    """Values (cells + 1, f, o) on an even grid of depth from values (n, f, o) at the depth nodes."""
    at = np.linspace(0.0, 1.0, CELLS + 1) ** (1.0 / CROWDING)
    given = np.linspace(0.0, 1.0, len(nodes))
    return np.ascontiguousarray(Akima1DInterpolator(given, nodes, method="makima")(at))
