"""The reduced model through time: the internal variables of every layer, the rig, and the dot's depth.

With the amplitudes s of a layer's elastic stress, the Prony update of solve.materials.prony acts on the amplitudes,
    q_i <- exp(-a_i) q_i + g_i gain_i (s - s_old),      alpha = sum (g_i s - q_i),      a_i = dt / tau_i,
and everything else is a function of the depth u and of alpha. As s depends on alpha the step is implicit; its fixed
point contracts by about sum g_i (1 - gain_i). The rig's balance is that of solve.terms.rig,
    m a'' + F(a, alpha) = (u - a) / c,   or = the force that drives,
by central differences (velocity Verlet, Phys. Rev. 159, 1967) in sub-steps that resolve every oscillation, with alpha
extrapolated to the middle of the sample: both second order. Of a mass that rings faster than that the answer is static.
"""

import numba as nb
import numpy as np

from foundation.arrays import Floats, Ints
from solve.compiled import copy_numbers, piece
from solve.decay import mean_decay
from solve.materials.prony import branch_stress
from solve.reduced.table_reading import balance, first_touch, force_and_slope, read_outputs, set_features

BY_DEPTH, BY_FORCE = 0, 1
WITHIN_TABLE, TOO_DEEP = 0, 1
AMPLITUDE_TOLERANCE = 1e-10  # of the amplitudes
MOST_FIXED_POINT_ROUNDS = 60
SUBSTEP_PHASE = 0.25  # of the rig's fastest oscillation in one sub-step; central differences are stable up to 2
MOST_SUBSTEPS = 1000


@piece()
def _decay(step: float, moduli: Floats, times: Floats, layer: Ints, start: Ints, fade: Floats, gain: Floats,
           instant: Floats) -> None:  # fmt: skip
    """Write exp(-a) and g (1 - exp(-a)) / a of each branch, and sum g - g (1 - exp(-a)) / a of each amplitude."""
    instant[:] = 0.0
    for b in range(len(moduli)):
        a = step / times[b]
        fade[b] = np.exp(-a)
        gain[b] = moduli[b] * mean_decay(a)
        for r in range(start[layer[b]], start[layer[b] + 1]):
            instant[r] += moduli[b] - gain[b]


@piece()
def _explicit_part(
    layer: Ints, start: Ints, fade: Floats, gain: Floats, memory: Floats, old: Floats, known: Floats
) -> None:
    """Write the part of alpha that does not depend on the new amplitudes."""
    known[:] = 0.0
    for b in range(len(layer)):
        for r in range(start[layer[b]], start[layer[b] + 1]):
            known[r] += gain[b] * old[r] - fade[b] * memory[b, r]


@piece()
def _remember(layer: Ints, start: Ints, fade: Floats, gain: Floats, memory: Floats, old: Floats, new: Floats) -> None:
    """Take the step in the branches; old becomes new."""
    for b in range(len(layer)):
        for r in range(start[layer[b]], start[layer[b] + 1]):
            memory[b, r] = branch_stress(memory[b, r], fade[b], gain[b], new[r] - old[r])
    copy_numbers(new, old)


@piece()
def _settle(
    table: Floats, touch: Floats, full: float, pairs: Ints, features: Floats, alpha: Floats, instant: Floats,
    known: Floats, spring: float, push: float, guess: float, observed: int, values: Floats,
) -> float:  # fmt: skip
    """Fixed point of alpha and, unless spring < 0, balance of the rig; returns the depth.

    A round shrinks the error of alpha by about the largest of instant, of which twice is trusted.
    """
    depth, contraction = guess, 0.0
    for r in range(len(alpha)):
        contraction = max(contraction, 2.0 * instant[r])
    for _ in range(MOST_FIXED_POINT_ROUNDS):
        set_features(alpha, pairs, features)
        first = first_touch(touch, features)
        if spring >= 0.0:
            depth = balance(table, features, first, full, spring, push, depth)
        read_outputs(table, features, first, full, depth, values)
        change, size = 0.0, 0.0
        for r in range(len(alpha)):
            new = instant[r] * values[observed + r] + known[r]
            change = max(change, abs(new - alpha[r]))
            size = max(size, abs(values[observed + r]))
            alpha[r] = new
        if contraction * change <= AMPLITUDE_TOLERANCE * size:
            break
    return depth


@piece()
def _swing(
    motion: Floats, parts: int, step: float, inertia: float, spring: float, push: float, pushed: float, table: Floats,
    touch: Floats, full: float, features: Floats,
) -> None:  # fmt: skip
    """Move depth, velocity and acceleration (3,) through a sample while the force on the mass goes from push to pushed.

    The features stay; below touch nothing but spring and force acts.
    """
    first = first_touch(touch, features)
    depth, velocity, acceleration = motion
    for part in range(1, parts + 1):
        velocity += 0.5 * step * acceleration
        depth += step * velocity
        force = force_and_slope(table, features, first, full, depth)[0] if depth > first else 0.0
        acceleration = (push + (pushed - push) * part / parts - spring * depth - force) / inertia
        velocity += 0.5 * step * acceleration
    motion[0], motion[1], motion[2] = depth, velocity, acceleration


@nb.njit(cache=True, error_model="numpy")
def follow(
    time: Floats, drive: Floats, kind: int, compliance: float, mass: float, table: Floats, touch: Floats, full: float,
    pairs: Ints, start: Ints, moduli: Floats, times: Floats, layer: Ints, observed: int, path: Floats, outputs: Floats,
) -> int:  # fmt: skip
    """Fill the dot's path (t,) in mm and the observed outputs (t, observed) over time (t,) in s; returns a status.

    drive (t,) mm or N by kind; compliance mm/N; mass N s2/mm; table (cells + 1, features, outputs), outputs being
    force, area, charges and amplitudes; touch (features,) mm; full mm; pairs (p, 2) of amplitudes; start (k + 1,)
    first amplitude of each layer; moduli, times, layer (b,) of each Prony branch. At rest before the first sample.
    The status is WITHIN_TABLE or TOO_DEEP.
    """
    modes, branches = table.shape[2] - observed, len(moduli)
    alpha, last_alpha, known, instant = np.zeros(modes), np.zeros(modes), np.zeros(modes), np.zeros(modes)
    features, values, old = np.zeros(table.shape[1]), np.zeros(table.shape[2]), np.zeros(modes)
    memory, fade, gain = np.zeros((branches, modes)), np.zeros(branches), np.zeros(branches)
    ruled = kind == BY_DEPTH and compliance == 0.0
    spring = 1.0 / compliance if kind == BY_DEPTH and not ruled else 0.0
    push = spring * drive if kind == BY_DEPTH else drive  # on the mass
    set_features(alpha, pairs, features)
    read_outputs(table, features, touch[0], full, touch[0], values)
    copy_numbers(values[observed:], old)
    stiffness = spring + abs(force_and_slope(table, features, touch[0], full, full)[1])
    motion, last = np.zeros(3), -1.0
    for n in range(len(time)):
        span = time[n] - time[n - 1] if n > 0 else 0.0
        if abs(span - last) > 1e-9 * span:
            _decay(span, moduli, times, layer, start, fade, gain, instant)
            last = span
        _explicit_part(layer, start, fade, gain, memory, old, known)
        parts = 0 if ruled or mass == 0.0 or span == 0.0 else 1 + int(span * np.sqrt(stiffness / mass) / SUBSTEP_PHASE)
        if 0 < parts <= MOST_SUBSTEPS:
            set_features(alpha + 0.5 * (alpha - last_alpha), pairs, features)
            _swing(motion, parts, span / parts, mass, spring, push[n - 1], push[n], table, touch, full, features)
        for r in range(modes):  # goes on as it went
            here = alpha[r]
            alpha[r] += here - last_alpha[r]
            last_alpha[r] = here
        if ruled or 0 < parts <= MOST_SUBSTEPS:
            stiff, pushed, near = -1.0, 0.0, drive[n] if ruled else motion[0]
        else:
            stiff, pushed, near = spring, push[n], motion[0]
        motion[0] = _settle(table, touch, full, pairs, features, alpha, instant, known, stiff, pushed, near, observed,
                            values)  # fmt: skip
        if motion[0] > full * (1.0 + 1e-6):
            return TOO_DEEP
        _remember(layer, start, fade, gain, memory, old, values[observed:])
        path[n] = motion[0]
        copy_numbers(values, outputs[n])
    return WITHIN_TABLE
