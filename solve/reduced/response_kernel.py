"""The reduced model through time: the internal variables of every layer, the rig, and the dot's depth.

With the amplitudes s of a layer's elastic stress, the Prony update of solve.materials.prony acts on the amplitudes,
    q_i <- exp(-a_i) q_i + g_i gain_i (s - s_old),      alpha = sum (g_i s - q_i),      a_i = dt / tau_i,
and everything else is a function of the depth u and of alpha. As s depends on alpha the step is implicit; its fixed
point contracts by about sum g_i (1 - gain_i). The rig's balance is that of solve.rig:
    m a'' + F(a, alpha) = (u - a) / c,   or = the force that drives.
"""

import numba as nb
import numpy as np

from mesh.types import Floats, Ints

BY_DEPTH, BY_FORCE = 0, 1
FINE, TOO_DEEP = 0, 1
TOLERANCE = 1e-9  # of the amplitudes, and of the full depth
ROUNDS = 60


@nb.njit(cache=True)
def _features(alpha: Floats, pairs: Ints, features: Floats) -> None:
    """(1, alpha, products of pairs of alpha)."""
    count = len(alpha)
    features[0] = 1.0
    features[1 : 1 + count] = alpha
    for p in range(len(pairs)):
        features[1 + count + p] = alpha[pairs[p, 0]] * alpha[pairs[p, 1]]


@nb.njit(cache=True)
def _place(touch: float, full: float, cells: int, depth: float) -> tuple[int, float]:
    """Cell of the table and the share of the way through it; below touch the table begins."""
    at = max(0.0, (depth - touch) / (full - touch)) * cells
    cell = min(int(at), cells - 1)
    return cell, at - cell


@nb.njit(cache=True)
def _force(table: Floats, features: Floats, touch: float, full: float, depth: float) -> tuple[float, float]:
    """Contact force and its slope over depth; right of touch also at touch."""
    cells = len(table) - 1
    cell, x = _place(touch, full, cells, depth)
    here, there = 0.0, 0.0
    for f in range(len(features)):
        here += table[cell, f, 0] * features[f]
        there += table[cell + 1, f, 0] * features[f]
    return here + x * (there - here), (there - here) * cells / (full - touch)


@nb.njit(cache=True)
def _evaluate(table: Floats, features: Floats, touch: float, full: float, depth: float, outputs: Floats) -> None:
    """All outputs at a depth."""
    cell, x = _place(touch, full, len(table) - 1, depth)
    outputs[:] = 0.0
    for f in range(len(features)):
        here, there = (1.0 - x) * features[f], x * features[f]
        for o in range(len(outputs)):
            outputs[o] += here * table[cell, f, o] + there * table[cell + 1, f, o]


@nb.njit(cache=True)
def _balance(
    table: Floats, features: Floats, touch: float, full: float, spring: float, push: float, guess: float
) -> float:
    """Depth where spring u + F(u) = push: Newton's method kept inside a shrinking bracket."""
    if spring == 0.0 and push <= 0.0:
        return touch
    clear = push / spring if spring > 0.0 else touch
    if clear <= touch and spring > 0.0:
        return clear
    low, high = touch, 2.0 * full - touch  # the last cell goes on, for the caller to see that it is too deep
    depth = min(max(guess, low), high)
    for _ in range(ROUNDS):
        force, slope = _force(table, features, touch, full, depth)
        excess = force + spring * depth - push
        if excess > 0.0:
            high = depth
        else:
            low = depth
        step = -excess / max(slope + spring, 1e-300)
        if abs(step) < 1e-3 * TOLERANCE * full or high - low < 1e-3 * TOLERANCE * full:
            break
        depth = depth + step
        if not low < depth < high:
            depth = 0.5 * (low + high)
    return depth


@nb.njit(cache=True)
def follow(
    time: Floats, drive: Floats, kind: int, compliance: float, mass: float, table: Floats, touch: Floats, full: float,
    pairs: Ints, owner: Ints, moduli: Floats, times: Floats, layer: Ints, observed: int, path: Floats, outputs: Floats,
) -> int:  # fmt: skip
    """Fill the dot's path (t,) in mm and the observed outputs (t, observed) over time (t,) in s; FINE or TOO_DEEP.

    drive (t,) mm or N by kind; compliance mm/N; mass N s2/mm; table (cells + 1, features, outputs), outputs being
    force, area, charges and amplitudes; touch (features,) mm; full mm; pairs (p, 2) of amplitudes; owner (r,) layer of
    each amplitude; moduli, times, layer (b,) of each Prony branch. At rest before the first sample.
    """
    modes, branches = len(owner), len(moduli)
    alpha, new, known = np.zeros(modes), np.zeros(modes), np.zeros(modes)
    instant = np.zeros(modes)
    memory = np.zeros((branches, modes))
    features, values = np.zeros(table.shape[1]), np.zeros(table.shape[2])
    fade, gain = np.zeros(branches), np.ones(branches)
    _features(alpha, pairs, features)
    _evaluate(table, features, features @ touch, full, -full, values)
    old = values[observed:].copy()
    ruled = kind == BY_DEPTH and compliance == 0.0
    spring = 0.0 if kind == BY_FORCE or ruled else 1.0 / compliance
    inertia = 0.0 if ruled else mass
    depth = velocity = acceleration = 0.0
    before = 0.0
    last_step = -1.0
    for n in range(len(time)):
        span = time[n] - time[n - 1] if n > 0 else 0.0
        parts = 1
        if inertia > 0.0 and span > 0.0:
            stiffness = spring + abs(_force(table, features, features @ touch, full, full)[1])
            parts = min(1000, max(1, int(np.ceil(span * np.sqrt(stiffness / inertia) / 0.2))))
        step = span / parts
        if step != last_step:
            last_step = step
            instant[:] = 0.0
            for b in range(branches):
                a = step / times[b]
                fade[b] = np.exp(-a)
                gain[b] = -np.expm1(-a) / a if a > 0.0 else 1.0
                for r in range(modes):
                    if owner[r] == layer[b]:
                        instant[r] += moduli[b] * (1.0 - gain[b])
        for part in range(1, parts + 1):
            asked = before + (drive[n] - before) * part / parts
            known[:] = 0.0
            for b in range(branches):
                for r in range(modes):
                    if owner[r] == layer[b]:
                        known[r] += moduli[b] * gain[b] * old[r] - fade[b] * memory[b, r]
            dynamic = 4.0 * inertia / step**2 if inertia > 0.0 and step > 0.0 else 0.0
            push = asked * spring if kind == BY_DEPTH else asked
            push += dynamic * (depth + step * velocity) + (inertia * acceleration if dynamic > 0.0 else 0.0)
            now = depth
            for _ in range(ROUNDS):
                first = features @ touch
                now = asked if ruled else _balance(table, features, first, full, spring + dynamic, push, now)
                _evaluate(table, features, first, full, now, values)
                change, size = 0.0, 1e-300
                for r in range(modes):
                    new[r] = instant[r] * values[observed + r] + known[r]
                    change = max(change, abs(new[r] - alpha[r]))
                    size = max(size, abs(new[r]), abs(values[observed + r]))
                    alpha[r] = new[r]
                if change <= TOLERANCE * size:
                    break
                _features(alpha, pairs, features)
            if now > full * (1.0 + 1e-6):
                return TOO_DEEP
            for b in range(branches):
                for r in range(modes):
                    if owner[r] == layer[b]:
                        rise = values[observed + r] - old[r]
                        memory[b, r] = fade[b] * memory[b, r] + moduli[b] * gain[b] * rise
            old[:] = values[observed:]
            if dynamic > 0.0:
                faster = dynamic / inertia * (now - depth - step * velocity) - acceleration
                velocity += 0.5 * step * (acceleration + faster)
                acceleration = faster
            depth = now
        before = drive[n]
        path[n] = depth
        outputs[n] = values[:observed]
    return FINE
