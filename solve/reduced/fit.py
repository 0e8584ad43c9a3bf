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

from foundation.arrays import Floats, Ints
from solve.reduced.modes import leading_modes
from solve.reduced.sampling import CROWDING, Sample

CELLS = 1024
ELASTIC_NODES_FACTOR = 3
"""Depth nodes of the elastic press to one of the others: a coarse contact surface touches node by node."""
MODES = 3  # of each layer at most: more would be directions that the samples do not tell apart


@dataclass(frozen=True)
class ResponseTable:
    """Table of a reduced model. table (cells + 1, f, o) and touch (f,) as solve.reduced.time_stepping.follow takes
    them.

    start (k + 1,) first amplitude of each layer; pairs (p, 2) of amplitudes; missing : largest share of a layer's
    elastic stress that its modes leave out.
    """

    table: Floats
    touch: Floats
    start: Ints
    pairs: Ints
    missing: float


def fit(samples: Sequence[Sample], layers: Sequence[str]) -> ResponseTable:
    """The table; samples[0] is the elastic press, all others have a memory."""
    stress, memory, start, missing = [], [], [0], 0.0
    for name in layers:
        snapshots, remembered = _coordinates(samples, name)
        rotation, left_out = leading_modes(snapshots, MODES)
        missing = max(missing, left_out)
        ends = np.cumsum([len(sample.stress[name]) for sample in samples])
        stress.append(np.split(snapshots @ rotation, ends[:-1]))
        memory.append(remembered @ rotation)
        start.append(start[-1] + rotation.shape[1])
    pairs = np.array(list(combinations_with_replacement(start[:-1], 2)), dtype=np.int64).reshape(-1, 2)
    outputs = [np.concatenate([s.outputs, *own], axis=1) for s, *own in zip(samples, *stress, strict=True)]
    alpha = np.concatenate(memory, axis=1) if memory else np.zeros((len(samples), 0))
    features = np.concatenate([alpha, alpha[:, pairs[:, 0]] * alpha[:, pairs[:, 1]]], axis=1)
    changes = [now - outputs[0][::ELASTIC_NODES_FACTOR] for now in outputs[1:]]
    touch = np.array([s.touch_mm for s in samples])
    parts, moved = [_table(outputs[0])[:, None]], touch[:1]
    if layers:
        parts.append(_table(_slopes(features[1:], np.array(changes))))
        moved = np.append(moved, _slopes(features[1:], (touch[1:] - touch[0])[:, None, None]))
    return ResponseTable(np.concatenate(parts, axis=1), moved, np.array(start, dtype=np.int64), pairs, missing)


def _coordinates(samples: Sequence[Sample], layer: str) -> tuple[Floats, Floats]:
    """Elastic stress (s n, b) and memory (s, b) of a layer in its whole basis."""
    size = max(len(c) for s in samples for c in [*s.stress[layer], *([s.memory[layer]] if layer in s.memory else [])])
    stress = [np.pad(c, (0, size - len(c))) for s in samples for c in s.stress[layer]]
    memory = [s.memory.get(layer, np.zeros(0)) for s in samples]
    return np.array(stress), np.array([np.pad(c, (0, size - len(c))) for c in memory])


def _slopes(features: Floats, changes: Floats) -> Floats:
    """Coefficients (n, f, o) of changes (s, n, o) over features (s, f), by least squares.

    Scaled by what the samples span, so that a direction without samples gets a coefficient of zero.
    """
    scale = np.maximum(np.abs(features).max(axis=0), 1e-300)
    solved = np.linalg.lstsq(features / scale, changes.reshape(len(changes), -1), rcond=1e-9)[0] / scale[:, None]
    return np.asarray(solved.reshape(-1, *changes.shape[1:]).swapaxes(0, 1))


def _table(nodes: Floats) -> Floats:
    """Values (cells + 1, ...) on an even grid of depth from values (n, ...) at the depth nodes."""
    at = np.linspace(0.0, 1.0, CELLS + 1) ** (1.0 / CROWDING)
    given = np.linspace(0.0, 1.0, len(nodes))
    return np.asarray(Akima1DInterpolator(given, nodes, method="makima")(at))
