"""Relaxation at large strain: Maxwell branches whose dashpots flow, F = F_e F_i in each.

A branch is a neo-Hookean spring of shear modulus mu_i on the elastic part of the isochoric deformation; with
C_i = F_i' F_i, det C_i = 1, and C^ = J^(-2/3) C
    psi = mu_i / 2 (C^ : C_i^-1 - 3),      tau_i dC_i/dt = C^ - s C_i,      s = C^ : C_i^-1 / 3
(Simo, Comput. Methods Appl. Mech. Eng. 99, 1992; Lion, Acta Mech. 123, 1997; Reese and Govindjee, Int. J. Solids
Struct. 35, 1998). With s from before the step and C^ linear over it the equation is linear, and its solution, brought
back to det C_i = 1, is an explicit update of second order (that of Shutov, Landgraf and Ihlemann, Comput. Methods Appl.
Mech. Eng. 265, 2013, with exponentials for the factors of backward Euler; b = s dt / tau_i, g = (1 - exp(-b)) / b):
    A = exp(-b) C_i + (g - exp(-b)) / s C^_old + (1 - g) / s C^,      C_i <- A / det(A)^(1/3)
At small strain, s = 1, it is that of solve.materials.prony. With G = C_i^-1 after the step
    S_i = mu_i J^(-2/3) (G - (C : G) / 3 C^-1)
which is the gradient of a function of C, as G is that of 3 det(A)^(1/3) with respect to A: the tangent is symmetric.
Real rubber lies between this and a Prony series of the second Piola-Kirchhoff stress, so that a share f of each branch
may flow: S = (1 - sum g_i) S0 + sum (f S_i + (1 - f) Q_i) with mu_i = g_i mu.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from solve.compiled import in_threads, piece
from solve.decay import mean_decay
from solve.materials.inelastic import Memory, StressResponse
from solve.materials.prony import Prony
from solve.tensors import I_OF, J_OF, NUMBER_OF, inverse


@dataclass(frozen=True)
class MultiplicativeMaxwell(Prony):
    """A Prony series of which a share flows. shear_modulus : of the elastic law, whose stress is the instantaneous one
    where that is neo-Hookean."""

    flowing: float = 1.0
    shear_modulus: float = 1.0
    linear = False

    def around(self, elastic: Any, MPa: float) -> "MultiplicativeMaxwell":
        """The branches of a medium with the shear modulus of this law, in the solver's unit of stress."""
        return replace(self, shear_modulus=elastic.shear_modulus)

    def start(self, points: int, components: int = 6) -> Memory:
        """Memory at rest: that of a Prony series; then C_i (n, i, 6), and C^ (n, 6) at the last step, all of
        them one.
        """
        unit = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
        branches = np.tile(unit, (points, len(self.relative_moduli), 1))
        return *super().start(points, components), branches, np.tile(unit, (points, 1))

    def update(self, elastic: StressResponse, memory: Memory, time_step: float) -> tuple[StressResponse, Memory]:
        """Relaxed response and the new memory."""
        assert elastic.cauchy_green is not None
        *plain, flowed, strain = memory
        linear, plain_now = super().update(elastic, tuple(plain), time_step)
        moduli = self.flowing * np.array(self.relative_moduli)
        of_linear, of_elastic = 1.0 - self.flowing, self.flowing - moduli.sum()
        stress = of_linear * linear.stress + of_elastic * elastic.stress
        tangent = of_linear * linear.tangent + of_elastic * elastic.tangent
        new, now = np.empty_like(flowed), np.empty_like(strain)
        steps, moduli = time_step / np.array(self.relaxation_times), self.shear_modulus * moduli
        _add_branches(elastic.cauchy_green, strain, flowed, steps, moduli, stress, tangent, new, now)
        return StressResponse(stress, tangent), (*plain_now, new, now)


@piece()
def flow_weights(a, s):  # type: ignore[no-untyped-def]
    """Weights in A of C_i, and of C^ before and after a step of a = dt / tau_i, with s from before the step."""
    fade, gain = np.exp(-a * s), mean_decay(a * s)
    return fade, (gain - fade) / s, (1.0 - gain) / s


@piece()
def _double_contraction(a, b):  # type: ignore[no-untyped-def]
    """Sum of a_ij b_ij of two matrices (3, 3)."""
    total = 0.0
    for i in range(3):
        for j in range(3):
            total += a[i, j] * b[i, j]
    return total


@piece()
def _fill_tensor(six, out):  # type: ignore[no-untyped-def]
    """Write a symmetric tensor of six numbers into out (3, 3)."""
    for i in range(3):
        for j in range(3):
            out[i, j] = six[NUMBER_OF[i, j]]


@piece()
def _advance_branch(step, flowed, before, now, a, g):  # type: ignore[no-untyped-def]
    """Write A into a and C_i^-1 into g, (3, 3) each; returns det(A)^(1/3) and the weight of C^ after the step."""
    _fill_tensor(flowed, a)
    inverse(a, g)
    s = 0.0
    for i in range(3):
        for j in range(3):
            s += g[i, j] * before[NUMBER_OF[i, j]] / 3.0
    of_flowed, of_before, of_now = flow_weights(step, s)
    for i in range(3):
        for j in range(3):
            v = NUMBER_OF[i, j]
            a[i, j] = of_flowed * flowed[v] + of_before * before[v] + of_now * now[v]
    root = inverse(a, g) ** (1.0 / 3.0)
    for i in range(3):
        for j in range(3):
            g[i, j] *= root
    return root, of_now


@in_threads()
def _add_branches(start, stop, cauchy_green, before, flowed, steps, moduli, stress, tangent, new, now):  # type: ignore[no-untyped-def]
    """Stress (n, 6) and tangent (n, 6, 6) of all branches are added; new (n, i, 6) : C_i, now (n, 6) : C^."""
    ci, a, g, gc, x = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for n in range(start, stop):
        c = cauchy_green[n]
        j23 = inverse(c, ci) ** (-1.0 / 3.0)
        for v in range(6):
            now[n, v] = j23 * c[I_OF[v], J_OF[v]]
        for b in range(len(moduli)):
            root, of_now = _advance_branch(steps[b], flowed[n, b], before[n], now[n], a, g)
            for v in range(6):
                new[n, b, v] = a[I_OF[v], J_OF[v]] / root
            _add_branch(c, ci, j23, g, of_now / root, moduli[b], gc, x, stress[n], tangent[n])


@piece()
def _add_branch(c, ci, j23, g, h, modulus, gc, x, stress, tangent):  # type: ignore[no-untyped-def]
    """Add the stress and the tangent of one branch. dG/dC^ is H = h (G x G / 3 - G (.) G).

    x becomes H : C, gc is scratch, both (3, 3).
    """
    s = _double_contraction(c, g)
    for i in range(3):
        for j in range(3):
            gc[i, j] = g[i, 0] * c[0, j] + g[i, 1] * c[1, j] + g[i, 2] * c[2, j]
    for i in range(3):
        for j in range(3):
            x[i, j] = h * (s / 3.0 * g[i, j] - gc[i, 0] * g[0, j] - gc[i, 1] * g[1, j] - gc[i, 2] * g[2, j])
    cx = _double_contraction(c, x)
    for v in range(6):
        i, j = I_OF[v], J_OF[v]
        stress[v] += modulus * j23 * (g[i, j] - s / 3.0 * ci[i, j])
        for w in range(6):
            k, m = I_OF[w], J_OF[w]
            of_ci = 0.5 * (ci[i, k] * ci[j, m] + ci[i, m] * ci[j, k])
            of_g = 0.5 * (g[i, k] * g[j, m] + g[i, m] * g[j, k])
            both = ci[i, j] * ci[k, m]
            at_fixed_g = s / 3.0 * of_ci + s / 9.0 * both - (g[i, j] * ci[k, m] + ci[i, j] * g[k, m]) / 3.0
            through_g = h * (g[i, j] * g[k, m] / 3.0 - of_g) + cx / 9.0 * both
            through_g -= (x[i, j] * ci[k, m] + ci[i, j] * x[k, m]) / 3.0
            tangent[v, w] += 2.0 * modulus * j23 * (at_fixed_g + j23 * through_g)
