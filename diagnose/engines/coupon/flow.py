"""The stress of a coupon whose branches flow, over a whole history: solve.materials.multiplicative, scanned over time.

Every deformation of a coupon has the components 11, 22, 33 and 12 alone, so that all tensors here are these four
numbers in this order.
"""

from dataclasses import dataclass, replace

import numba as nb
import numpy as np

from diagnose.engines.coupon.relaxation import Relaxation, solve_small_system
from foundation.arrays import Floats
from solve.compiled import copy_numbers, piece
from solve.materials.multiplicative import MultiplicativeMaxwell, flow_weights
from solve.materials.prony import branch_stress

NONZERO_COMPONENTS = [0, 1, 2, 3]


@dataclass(frozen=True)
class FlowingBranches:
    """A series of b branches of which a share flows, at t times, at rest before the first sample.

    linear : the series whose stress relaxes, of which a share 1 - flowing remains. moduli : mu_i of what flows, MPa
    (b,). steps : dt / tau_i (t, b).
    """

    linear: Relaxation
    flowing: float
    moduli: Floats
    steps: Floats

    @classmethod
    def from_series(cls, series: MultiplicativeMaxwell, shear_modulus_MPa: float, time_s: Floats) -> "FlowingBranches":
        """Branches of a series at times (t,) in s, for a material of this shear modulus."""
        linear = Relaxation.from_series(series, time_s)
        steps = np.diff(time_s, prepend=time_s[0])[:, None] / np.array(series.relaxation_times)
        return cls(linear, series.flowing, series.flowing * shear_modulus_MPa * linear.moduli, steps)

    @property
    def linear_rest(self) -> Relaxation:
        """Linear series of the share that does not flow; its stress holds all that never relaxes, too."""
        return replace(self.linear, moduli=(1.0 - self.flowing) * self.linear.moduli)

    def relaxed_stress(self, elastic: Floats, cauchy_green: Floats) -> Floats:
        """Stress (t, 6) after the histories of the elastic stress (t, 6) and of C (t, 3, 3)."""
        stress = self.linear_rest.relaxed_stress(elastic) - self.flowing * self.linear.moduli.sum() * elastic
        _add_branch_stress(_four_components(cauchy_green), self.steps, self.moduli, stress)
        return np.asarray(stress)

    def newton_step(
        self, residual: Floats, by_stress: Floats, stress_by: Floats, by_unknown: Floats, cauchy_green: Floats,
        strain_by: Floats,
    ) -> Floats:  # fmt: skip
        """Correction (t, m) of the unknowns that makes residual (t, m) vanish, memory included.

        by_stress (t, m, 6) : derivative of the residual by the stress; stress_by (t, 6, m) : of the elastic stress by
        the unknowns; by_unknown (t, m, m) : of the residual by the unknowns at fixed stress; strain_by (t, 6, m) : of
        the strain by the unknowns, with engineering shears.
        """
        kept = self.linear_rest
        instant = kept.instantaneous_stiffness - self.flowing * self.linear.moduli.sum()
        matrices = by_unknown + np.matmul(by_stress, instant[:, None, None] * stress_by)
        by_four, stress_four = (
            np.ascontiguousarray(a) for a in (by_stress[:, :, NONZERO_COMPONENTS], stress_by[:, NONZERO_COMPONENTS])
        )
        rates = np.ascontiguousarray(strain_by[:, NONZERO_COMPONENTS] * np.array([2.0, 2.0, 2.0, 1.0])[:, None])
        linear = stress_four, kept.fade, kept.gain * kept.moduli
        flow = _four_components(cauchy_green), rates, self.steps, self.moduli
        return np.asarray(_newton_step(residual, by_four, matrices, linear, flow))


def _four_components(tensors: Floats) -> Floats:
    """The components 11, 22, 33, 12 (t, 4) of symmetric tensors (t, 3, 3)."""
    return np.ascontiguousarray(tensors[:, [0, 1, 2, 0], [0, 1, 2, 1]])


@piece()
def _determinant(a):  # type: ignore[no-untyped-def]
    return (a[0] * a[1] - a[3] * a[3]) * a[2]


@piece()
def _scaled_inverse(a, factor):  # type: ignore[no-untyped-def]
    """Inverse of a tensor (4,) times a factor."""
    plane = factor / (a[0] * a[1] - a[3] * a[3])
    return a[1] * plane, a[0] * plane, factor / a[2], -a[3] * plane


@piece()
def _double_contraction(a, b):  # type: ignore[no-untyped-def]
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * a[3] * b[3]


@piece()
def _sandwich_product(g, x):  # type: ignore[no-untyped-def]
    """Product g x g of two symmetric tensors (4,)."""
    u, v = g[0] * x[0] + g[3] * x[3], g[0] * x[3] + g[3] * x[1]
    w, z = g[3] * x[0] + g[1] * x[3], g[3] * x[3] + g[1] * x[1]
    return u * g[0] + v * g[3], w * g[3] + z * g[1], g[2] * x[2] * g[2], u * g[3] + v * g[1]


@piece()
def _flow_step(w, flowed, before, now):  # type: ignore[no-untyped-def]
    """A (4,), det(A)^(1/3), and G (4,) after a step with weights w (3,)."""
    a = (
        w[0] * flowed[0] + w[1] * before[0] + w[2] * now[0],
        w[0] * flowed[1] + w[1] * before[1] + w[2] * now[1],
        w[0] * flowed[2] + w[1] * before[2] + w[2] * now[2],
        w[0] * flowed[3] + w[1] * before[3] + w[2] * now[3],
    )
    root = _determinant(a) ** (1.0 / 3.0)
    return a, root, _scaled_inverse(a, root)


@piece()
def _weight_derivatives(a, s, w):  # type: ignore[no-untyped-def]
    """Derivatives of the weights w (3,) of a step by s."""
    b = a * s
    gain_by = -0.5 + b / 3.0 if b < 1e-5 else ((1.0 + b) * w[0] - 1.0) / b**2
    return -a * w[0], (a * gain_by + a * w[0] - w[1]) / s, -(a * gain_by + w[2]) / s


@nb.njit(cache=True)
def _add_branch_stress(strain, steps, moduli, stress):  # type: ignore[no-untyped-def]
    """Add the stress of the branches to stress (t, 6), in place, for strain C (t, 4)."""
    flowed, inner = _identity_tensors(len(moduli)), _identity_tensors(len(moduli))
    before, now = np.array([1.0, 1.0, 1.0, 0.0]), np.empty(4)
    for t in range(len(strain)):
        c = strain[t]
        ci, j23 = _scaled_inverse(c, 1.0), _determinant(c) ** (-1.0 / 3.0)
        for k in range(4):
            now[k] = j23 * c[k]
        for b in range(len(moduli)):
            w = flow_weights(steps[t, b], _double_contraction(before, inner[b]) / 3.0)
            a, root, g = _flow_step(w, flowed[b], before, now)
            s = _double_contraction(c, g) / 3.0
            for k in range(4):
                stress[t, k] += moduli[b] * j23 * (g[k] - s * ci[k])
                flowed[b, k], inner[b, k] = a[k] / root, g[k]
        copy_numbers(now, before)


@piece()
def _identity_tensors(branches):  # type: ignore[no-untyped-def]
    flowed = np.zeros((branches, 4))
    flowed[:, :3] = 1.0
    return flowed


@nb.njit(cache=True)
def _newton_step(residual, by_stress, matrices, linear, flow):  # type: ignore[no-untyped-def]
    """Newton's correction (t, m) by forward substitution: a sample depends on those before through Q_i, C_i and C^.

    Changes (1 + m, 4) are those by what was corrected before, and those by each of the m unknowns.
    """
    stress_by, fade, gain = linear
    strain, rates, steps, moduli = flow
    samples, size = residual.shape
    of_branch, was_elastic = np.zeros((len(moduli), 4)), np.zeros(4)
    flowed, inner, of_flowed = (
        _identity_tensors(len(moduli)),
        _identity_tensors(len(moduli)),
        np.zeros((len(moduli), 4)),
    )
    before, now, of_before = np.array([1.0, 1.0, 1.0, 0.0]), np.empty(4), np.zeros(4)
    of_c, of_now, of_s = np.zeros((1 + size, 4)), np.zeros((1 + size, 4)), np.zeros((1 + size, 4))
    of_a, step = np.zeros((len(moduli), 1 + size, 4)), np.empty_like(residual)
    matrix, right = np.empty((size, size)), np.empty(size)
    for t in range(samples):
        c = strain[t]
        ci, j23 = _scaled_inverse(c, 1.0), _determinant(c) ** (-1.0 / 3.0)
        _set_strain_changes(c, ci, j23, rates[t], now, of_c, of_now)
        of_s[:] = 0.0
        for b in range(len(moduli)):
            for k in range(4):
                of_s[0, k] += fade[t, b] * of_branch[b, k] - gain[t, b] * was_elastic[k]
            w = _set_flow_changes(
                steps[t, b], flowed[b], inner[b], before, now, of_flowed[b], of_before, of_now, of_a[b]
            )
            a, root, g = _flow_step(w, flowed[b], before, now)
            _add_stress_changes(c, ci, j23, g, root, moduli[b], of_c, of_a[b], of_s)
            for k in range(4):
                flowed[b, k], inner[b, k] = a[k] / root, g[k]
                for j in range(1 + size):
                    of_a[b, j, k] /= root
        for i in range(size):
            right[i] = -residual[t, i] - _contract_stress(by_stress[t, i], of_s[0])
            for j in range(size):
                matrix[i, j] = matrices[t, i, j] + _contract_stress(by_stress[t, i], of_s[1 + j])
        solve_small_system(matrix, right, step[t])
        copy_numbers(now, before)
        _update_linear_corrections(stress_by[t], fade[t], gain[t], step[t], of_branch, was_elastic)
        _update_flow_corrections(inner, flowed, of_a, of_now, step[t], of_flowed, of_before)
    return step


@piece()
def _set_strain_changes(c, ci, j23, rates, now, of_c, of_now):  # type: ignore[no-untyped-def]
    """Write C^ (4,) into now, and the changes of C and C^ into of_c and of_now (1 + m, 4)."""
    for k in range(4):
        now[k] = j23 * c[k]
        for j in range(1, len(of_c)):
            of_c[j, k] = rates[k, j - 1]
    for j in range(len(of_c)):
        volume = _double_contraction(ci, of_c[j]) / 3.0
        for k in range(4):
            of_now[j, k] = j23 * (of_c[j, k] - volume * c[k])


@piece()
def _set_flow_changes(step, flowed, inner, before, now, of_flowed, of_before, of_now, of_a):  # type: ignore[no-untyped-def]
    """Write the changes of A of one branch into of_a (1 + m, 4); returns the weights (3,) of the step."""
    s = _double_contraction(before, inner) / 3.0
    of_s = (
        _double_contraction(of_before, inner) - _double_contraction(before, _sandwich_product(inner, of_flowed))
    ) / 3.0
    w = flow_weights(step, s)
    by_s = _weight_derivatives(step, s, w)
    for k in range(4):
        of_weights = of_s * (by_s[0] * flowed[k] + by_s[1] * before[k] + by_s[2] * now[k])
        for j in range(len(of_a)):
            of_a[j, k] = w[2] * of_now[j, k]
        of_a[0, k] += w[0] * of_flowed[k] + w[1] * of_before[k] + of_weights
    return w


@piece()
def _update_linear_corrections(stress_by, fade, gain, step, of_branch, was_elastic):  # type: ignore[no-untyped-def]
    """Update the corrections of Q_i (b, 4) and of the elastic stress (4,) by those of the unknowns (m,), in place."""
    for k in range(4):
        change = -was_elastic[k]
        for j in range(len(step)):
            change += stress_by[k, j] * step[j]
        was_elastic[k] += change
        for b in range(len(of_branch)):
            of_branch[b, k] = branch_stress(of_branch[b, k], fade[b], gain[b], change)


@piece()
def _update_flow_corrections(inner, flowed, of_a, of_now, step, of_flowed, of_before):  # type: ignore[no-untyped-def]
    """Update the corrections of C_i (b, 4), whose determinant stays 1, and of C^ (4,), in place.

    of_a : those of A over det(A)^(1/3).
    """
    for k in range(4):
        of_before[k] = _total_change(of_now, step, k)
        for b in range(len(flowed)):
            of_flowed[b, k] = _total_change(of_a[b], step, k)
    for b in range(len(flowed)):
        grown = _double_contraction(inner[b], of_flowed[b]) / 3.0
        for k in range(4):
            of_flowed[b, k] -= grown * flowed[b, k]


@piece()
def _add_stress_changes(c, ci, j23, g, root, modulus, of_c, of_a, of_s):  # type: ignore[no-untyped-def]
    """Add changes (1 + m, 4) of the stress of one branch to of_s, in place, by those of C and A."""
    s = _double_contraction(c, g) / 3.0
    for j in range(len(of_c)):
        grown, bent = _double_contraction(g, of_a[j]) / 3.0, _sandwich_product(g, of_a[j])
        of_g = (
            (grown * g[0] - bent[0]) / root, (grown * g[1] - bent[1]) / root,
            (grown * g[2] - bent[2]) / root, (grown * g[3] - bent[3]) / root,
        )  # fmt: skip
        volume, of_ci = _double_contraction(ci, of_c[j]) / 3.0, _sandwich_product(ci, of_c[j])
        of_share = (_double_contraction(of_c[j], g) + _double_contraction(c, of_g)) / 3.0
        for k in range(4):
            deviator = g[k] - s * ci[k]
            of_s[j, k] += modulus * j23 * (of_g[k] - of_share * ci[k] + s * of_ci[k] - volume * deviator)


@piece()
def _total_change(changes, step, k):  # type: ignore[no-untyped-def]
    """Change of component k by what was corrected before and by the unknowns' corrections (m,) together."""
    total = changes[0, k]
    for j in range(len(step)):
        total += changes[1 + j, k] * step[j]
    return total


@piece()
def _contract_stress(by_stress, stress):  # type: ignore[no-untyped-def]
    """Product of a derivative by stress and a stress, over the four components that are not 0."""
    return by_stress[0] * stress[0] + by_stress[1] * stress[1] + by_stress[2] * stress[2] + by_stress[3] * stress[3]
