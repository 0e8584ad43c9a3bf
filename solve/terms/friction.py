"""Contact with Coulomb friction: three more multipliers at every surface node, no penalty number.

tau_i is the traction of the dot on the surface, per undeformed area, phi_i the hat function of solve.terms.contact.
With the relative displacement d_i = int phi_i [(u - u_prev) - (move - move_prev)] dA over a step, the nodal area A_i
and the normal N_i = n_i / |n_i|, n_i = int phi_i grad g dA, of the present state:
    work of friction    sum_i tau_i . int phi_i (delta u - delta move) dA
    slip                s_i = (1 - N_i N_i) d_i / A_i
    Coulomb's law       tau_i = P_b (tau_i - c s_i),    P_b = projection on the disc |t| <= b_i, t . N_i = 0
It says |tau| <= mu lambda and tau = -mu lambda s / |s| where s is not zero, whatever c > 0 (Alart and Curnier, Comput.
Methods Appl. Mech. Eng. 92, 1991). The radius b_i = mu (lambda_i - c g_i / A_i) is mu lambda_i where g_i = 0. Newton's
method on it is the primal-dual active set of Hueeber, Stadler and Wohlmuth (SIAM J. Sci. Comput. 30, 2008); in a row
that slips the direction of slip stands where they have tau / b, which they damp for stability. The linearised
normal is that of Gitterle, Popp, Gee and Wall (Int. J. Numer. Meth. Eng. 84, 2010). The slip is integrated by backward
Euler, exact for any path on which its direction keeps still within a step.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from solve.terms.base import Block, History, Term, Trial
from solve.terms.builder import Builder
from solve.terms.contact import ACTIVE_SET_STIFFNESS, HATS, SHAPES, ContactFacets
from solve.terms.definition import TermDefinition

SLIP_LIMIT = 1.9  # below 2, see _shift; it, too, only steers the iteration
MOTION = np.r_[0:18, 24]  # columns of a facet that move its surface against the dot


def relative_motion() -> Floats:
    """Change of u - move (q, 19, 3) at the quadrature points by the displacements of a facet and the approach."""
    direction = np.zeros((len(SHAPES), 19, 3))
    direction[:, :18] = np.einsum("qn,ij->qnij", SHAPES, np.eye(3)).reshape(len(SHAPES), 18, 3)
    direction[:, 18, 2] = 1.0  # the dot approaches along -z
    return direction


DIRECTION = relative_motion()


class Nodal(NamedTuple):
    """State of the c surface nodes.

    normal : (c, 3) N; projector : (c, 3, 3) 1 - NN; length : (c,) |n|; moved : (c, 3) d; tau : (c, 3);
    target : (c, 3) tau - c s in the tangent plane; radius : (c,) b; active, slips : (c,) bool, slips where active;
    trial_by_slip (c, 3, 3), trial_by_radius (c, 3) : derivatives of c s.
    """

    normal: Floats
    projector: Floats
    length: Floats
    moved: Floats
    tau: Floats
    target: Floats
    radius: Floats
    active: Bools
    slips: Bools
    trial_by_slip: Floats
    trial_by_radius: Floats


class Law(NamedTuple):
    """Row (c, 3) of every node and its derivatives by d, n, tau (c, 3, 3), and by g and lambda (c, 3)."""

    row: Floats
    by_moved: Floats
    by_normal: Floats
    by_tau: Floats
    by_gap: Floats
    by_pressure: Floats


@dataclass(frozen=True)
class FrictionalContact(Term):
    """Pressure and friction. friction_dofs : (c, 3) unknowns of tau in the order of contact.pressure_dofs.

    coefficient : mu >= 0. slip_stiffness : c, solver units; it steers the iteration and is not in the answer.
    A displacement that is prescribed leaves its tau without effect on the equilibrium there: it is set to zero.
    """

    contact: ContactFacets
    friction_dofs: Ints
    coefficient: float
    slip_stiffness: float = ACTIVE_SET_STIFFNESS

    symmetric = False
    is_load = True

    @property
    def groups(self) -> tuple[Ints, ...]:
        """Facets (k, 43): those of the frictionless contact, then tau; nodes (c, 4): pressure and tau."""
        tau = self.friction_dofs[self.contact.index].reshape(-1, 18)
        nodes = np.column_stack([self.contact.pressure_dofs, self.friction_dofs])
        return np.concatenate([self.contact.dofs, tau], axis=1), nodes

    def constraints(self) -> tuple[Ints, Floats]:
        """The contact pressures; friction rows of open nodes have a diagonal of their own."""
        return self.contact.constraints()

    def status(self, trial: Trial, history: History) -> Bools:
        """Nodes in contact (c,), then nodes that slip (c,)."""
        nodal = self._nodal(trial)
        return np.concatenate([nodal.active, nodal.slips])

    def touches(self, status: Bools) -> bool:
        """Whether any node is in contact; those come first."""
        return self.contact.touches(status[: len(self.contact.pressure_dofs)])

    def load_norm(self, trial: Trial, forces: Floats) -> float:
        """Norm of the forces of pressure and friction."""
        return self.contact.load_norm(trial, forces)

    def dot_force(self, trial: Trial) -> Floats:
        """Resultant (3,) of pressure and friction."""
        pressure, friction = trial.x[self.contact.pressure_dofs], trial.x[self.friction_dofs]
        return self.force(trial.displacement, trial.move, pressure, friction)

    def contact_traction(self, trial: Trial) -> Floats:
        """Traction (c, 3) of pressure and friction, per undeformed area."""
        return self.contact.contact_traction(trial) + trial.x[self.friction_dofs]

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Pressure and friction on the facets, then the rows of the nodes."""
        frictionless, open_rows = self.contact.elements(trial, history)
        nodal = self._nodal(trial)
        law = self._rows(nodal)
        ke, re = np.zeros((len(self.contact.dofs), 43, 43)), np.zeros((len(self.contact.dofs), 43))
        near = frictionless.part
        ke[near, :25, :25] = np.triu(frictionless.matrices) + np.triu(frictionless.matrices, 1).swapaxes(1, 2)
        re[near, :25] = frictionless.residuals
        self._add_friction(trial, nodal, law, ke, re)
        yield Block(0, slice(0, len(ke)), ke, re)
        nodes = np.zeros((len(law.row), 4, 4))
        nodes[:, 0, 0] = open_rows.matrices[:, 0, 0]
        nodes[:, 1:, 0], nodes[:, 1:, 1:] = law.by_pressure, law.by_tau
        yield Block(1, open_rows.part, nodes, np.column_stack([open_rows.residuals, law.row]))

    def force(self, displacement: Floats, move: Floats, pressure: Floats, friction: Floats) -> Floats:
        """Resultant (3,) of the dot on the meshed body; pressure (c,), friction (c, 3); solver units."""
        return self.contact.force(displacement, move, pressure) + self.contact.nodal_area @ friction

    @property
    def _free(self) -> Bools:
        """Displacements of the nodes (c, 3) that are unknowns."""
        free = np.zeros(self.friction_dofs.shape, bool)
        free[self.contact.index] = self.contact.dofs[:, :18].reshape(-1, 6, 3) >= 0
        return free

    @property
    def _turnable(self) -> Bools:
        """Components of the nodal normals (c, 3) that are not zero: in a mirror plane the other half takes them off."""
        free = self._free
        return free | ~free.any(axis=1, keepdims=True)

    def _nodal_sum(self, local: Floats) -> Floats:
        """Nodal sums (c, 3) of contributions (k, 6, 3) of the facets."""
        total = np.zeros(self.friction_dofs.shape)
        np.add.at(total, self.contact.index, local)
        return total

    def _nodal(self, trial: Trial) -> Nodal:
        contact, area = self.contact, self.contact.area
        gap, gradient, _ = contact._at_quadrature(trial.displacement, trial.move)
        step = (trial.displacement - trial.previous_displacement)[contact.facets]
        step = step - (trial.move - trial.previous_move)
        moved = self._free * self._nodal_sum(np.einsum("kq,qi,qn,knj->kij", area, HATS, SHAPES, step, optimize=True))
        n = self._turnable * self._nodal_sum(np.einsum("kq,qi,kqj->kij", area, HATS, gradient, optimize=True))
        weighted_gap = contact._weighted_gaps(gap)
        nodal_area = contact.nodal_area
        length = np.maximum(np.linalg.norm(n, axis=1), 1e-12 * nodal_area)  # opposite flanks may cancel, far away
        augmented = trial.x[contact.pressure_dofs] - ACTIVE_SET_STIFFNESS * weighted_gap / nodal_area
        active, radius = augmented > 0.0, self.coefficient * augmented
        tau, normal = trial.x[self.friction_dofs], n / length[:, None]
        projector = np.eye(3) - normal[:, :, None] * normal[:, None, :]
        slip = _apply(projector, moved[..., None])[..., 0] / nodal_area[:, None]
        shift, by_slip, by_radius = self._shift(slip, np.maximum(radius, 0.0))
        target = _apply(projector, tau[..., None])[..., 0] - shift
        slips = active & (np.linalg.norm(target, axis=1) >= radius)
        return Nodal(normal, projector, length, moved, tau, target, radius, active, slips, by_slip, by_radius)

    def _shift(self, slip: Floats, radius: Floats) -> tuple[Floats, Floats, Floats]:
        """Shift c s (c, 3), c so small that c |s| <= 1.9 b, and its derivatives by s (c, 3, 3) and b (c, 3).

        A node that slips too far, tau = b s / |s|, then has |tau - c s| < b: it sticks in the next iteration instead of
        slipping back, which could go on for ever.
        """
        size = np.linalg.norm(slip, axis=1)[:, None]
        direction, limit = _quotient(slip, size), SLIP_LIMIT * radius[:, None]
        capped = self.slip_stiffness * size > limit
        c = np.where(capped, _quotient(limit, size), self.slip_stiffness)
        turning = capped[..., None] * direction[:, :, None] * direction[:, None, :]
        return c * slip, c[..., None] * (np.eye(3) - turning), SLIP_LIMIT * capped * direction

    def _rows(self, nodal: Nodal) -> Law:
        """Slip along t: -A (tau - b t) = 0; stick: -(1 - NN) d - A NN tau = 0; open or prescribed: -tau = 0."""
        turn = nodal.projector / nodal.length[:, None, None]  # dN / dn
        by_n = [_projection_slope(v, nodal.normal, turn) for v in (nodal.tau, nodal.moved)]
        touching = _where(nodal.slips, self._slip(nodal, *by_n), self._stick(nodal, *by_n))
        zero = np.zeros_like(turn)
        none = Law(-nodal.tau, zero, zero, zero - np.eye(3), np.zeros_like(nodal.tau), np.zeros_like(nodal.tau))
        return _where(nodal.active[:, None] & self._free, touching, none)

    def _stick(self, nodal: Nodal, tau_by_n: Floats, moved_by_n: Floats) -> Law:
        area, normal, projector = self.contact.nodal_area[:, None], nodal.normal, nodal.projector
        along = np.einsum("ci,ci->c", normal, nodal.tau)[:, None] * normal
        slip = _apply(projector, nodal.moved[..., None])[..., 0]
        zero = np.zeros_like(nodal.tau)
        by_n = area[..., None] * tau_by_n - moved_by_n
        return Law(-slip - area * along, -projector, by_n, area[..., None] * (projector - np.eye(3)), zero, zero)

    def _slip(self, nodal: Nodal, tau_by_n: Floats, moved_by_n: Floats) -> Law:
        area, radius = self.contact.nodal_area[:, None], nodal.radius[:, None]
        size = np.linalg.norm(nodal.target, axis=1)[:, None]
        t = _quotient(nodal.target, size)
        across = _quotient(radius, size)[..., None] * (np.eye(3) - t[:, :, None] * t[:, None, :])  # b dt / d target
        by_slip = _apply(across, nodal.trial_by_slip)
        by_radius = area * (t - _apply(across, nodal.trial_by_radius[..., None])[..., 0])
        return Law(
            -area * (nodal.tau - radius * t),
            -_apply(by_slip, nodal.projector),
            area[..., None] * _apply(across, tau_by_n) - _apply(by_slip, moved_by_n),
            area[..., None] * (_apply(across, nodal.projector) - np.eye(3)),
            -ACTIVE_SET_STIFFNESS * self.coefficient * by_radius / area,
            self.coefficient * by_radius,
        )

    def _add_friction(self, trial: Trial, nodal: Nodal, law: Law, ke: Floats, re: Floats) -> None:
        """Virtual work of tau and the derivatives of the nodes' rows by motion, facet by facet."""
        contact, index, count = self.contact, self.contact.index, len(ke)
        _, gradient, hessian = contact._at_quadrature(trial.displacement, trial.move)
        weight = contact.area[:, :, None] * HATS
        motion = np.einsum("kqi,qdj->kijd", weight, DIRECTION, optimize=True)
        turning = np.einsum("kqi,kqjl,qdl->kijd", weight, hessian, DIRECTION, optimize=True)
        closing = np.einsum("kqi,kqj,qdj->kid", weight, gradient, DIRECTION, optimize=True)
        on = nodal.active[index].astype(float)
        work = -(motion * on[:, :, None, None]).reshape(count, 18, 19)
        ke[:, MOTION, 25:] = work.swapaxes(1, 2)
        re[:, MOTION] += np.einsum("krd,kr->kd", work, nodal.tau[index].reshape(count, 18))
        rows = _apply(law.by_moved[index], self._free[index][..., None] * motion)
        turning *= self._turnable[index][..., None]
        rows += _apply(law.by_normal[index], turning) + law.by_gap[index][..., None] * closing[:, :, None, :]
        ke[:, 25:, MOTION] = rows.reshape(count, 18, 19)


@dataclass(frozen=True)
class DotFriction(TermDefinition):
    """Coulomb friction between the dot and the surface."""

    coefficient: float = 0.0
    words = "friction of the dot"
    follows_time = True
    is_contact = True

    @property
    def is_off(self) -> bool:
        """Whether the dot slips freely."""
        return self.coefficient == 0.0

    def build(self, make: Builder) -> Iterator[Term]:
        """Build the contact with three more multipliers at each of its nodes."""
        dofs = make.numbers.take(3 * len(make.contact.pressure_dofs)).reshape(-1, 3)
        yield FrictionalContact(make.contact, dofs, self.coefficient)


def _projection_slope(vectors: Floats, normal: Floats, turn: Floats) -> Floats:
    """Derivative (c, 3, 3) of (1 - NN) v by n: -(N . v) dN/dn - N (v . dN/dn)."""
    along = np.einsum("ci,ci->c", vectors, normal)[:, None, None]
    slope: Floats = -along * turn - normal[:, :, None] * np.einsum("ci,cij->cj", vectors, turn)[:, None, :]
    return slope


def _apply(a: Floats, b: Floats) -> Floats:
    """Products of matrices (..., i, j) and (..., j, k)."""
    product: Floats = np.matmul(a, b)
    return product


def _quotient(a: Floats, b: Floats) -> Floats:
    """Quotient a / b, zero where b is."""
    shape = np.broadcast_shapes(a.shape, b.shape)
    quotient: Floats = np.divide(a, b, out=np.zeros(shape), where=np.broadcast_to(b > 0.0, shape))
    return quotient


def _where(mask: Bools, a: Law, b: Law) -> Law:
    """Rows of a where the mask (c,) or (c, 3) holds, else of b."""
    fitted = (mask.reshape(*mask.shape, *(1,) * (x.ndim - mask.ndim)) for x in a)
    return Law(*(np.where(m, x, y) for m, x, y in zip(fitted, a, b, strict=True)))
