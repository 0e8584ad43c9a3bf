"""Coulomb friction between a rigid dot and an elastic block: limit of slip, full sliding, reversal, energy."""

from collections import deque
from dataclasses import dataclass, field

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.optimize import brentq
from scipy.sparse.linalg import splu

from geometry.dot import DotShape
from solve.fem.kinematics import deformation_gradient
from solve.fem.numbering import Unknowns
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import linear
from solve.materials.laws import InvariantLaw, bulk_modulus
from solve.terms.base import Trial
from solve.terms.contact import ContactFacets, contact_facets
from solve.terms.friction import FrictionalContact
from solve.terms.rigid_dot import RigidDot
from solve.terms.solid import InvertedElementError, solid_region
from tests.cases import for_each
from tests.slip_work import slip_work
from tests.solve.box import box

MAX_ITERATIONS = 25
FACES = ((0, 1, 2, 4, 5, 6), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 2, 3, 6, 9, 7))  # corners, then edges
NOTHING = np.zeros((0, 4), int)


def neo_hookean(shear, poisson_ratio):
    return InvariantLaw(shear / 2.0, 0.0, 0.0, 0.0, bulk_modulus(shear, poisson_ratio))


def rigid(kind, centre, radius=0.6):
    """A dot whose tip touches the point centre (3,); a cap is half a ball."""
    height = 0.0 if kind == "plate" else radius
    return RigidDot(DotShape(kind, radius, height, np.zeros((1, 3)), np.array(centre, float), np.eye(3)), 1.0)


@dataclass
class Block:
    """A block on a rigid base under a dot; numbers (n, 3) of the displacements, -1 where held."""

    points: np.ndarray
    tets: np.ndarray
    law: InvariantLaw
    dot: RigidDot
    numbers: np.ndarray
    coefficient: float | None  # None: the contact without friction
    stiffness: float = 10.0
    node: np.ndarray | None = None  # number (n,) of the contact node, where several share one
    iterations: list = field(default_factory=list)

    def __post_init__(self):
        top = self.points[:, 2].max() - 1e-9
        facets = self.tets[:, FACES].reshape(-1, 6)
        facets = facets[(self.points[facets, 2] > top).all(axis=1)]
        count = int(self.numbers.max()) + 1
        corners, local = np.unique(self.tets[:, :4], return_inverse=True)
        dofs = np.hstack([self.numbers[self.tets].reshape(-1, 30), count + local.reshape(-1, 4)])
        self.solid = solid_region("block", self.law, self.points, self.tets, dofs)
        count += len(corners)
        self.surface = np.unique(facets)
        contact = np.full(len(self.points), -1)
        contact[self.surface] = count + (np.arange(len(self.surface)) if self.node is None else self.node[self.surface])
        count = int(contact.max()) + 1
        unknowns = Unknowns(self.numbers, NOTHING, NOTHING, contact, -1)
        self.contact = contact_facets(self.points, facets, unknowns, self.dot)
        self.term = self.contact
        if self.coefficient is not None:
            friction = count + np.arange(3 * len(self.contact.pressure_dofs)).reshape(-1, 3)
            self.term = FrictionalContact(self.contact, friction, self.coefficient, self.stiffness)
            count += friction.size
        self.x, self.move, self.previous = np.zeros(count), np.zeros(3), None
        self.scale, self.dissipated, self.work = 0.0, 0.0, 0.0

    def displacement(self, x):
        return np.append(x, 0.0)[self.numbers]

    def trial(self, x, move):
        return Trial(x, self.displacement(x), move, 0.0, self.displacement(self.x), self.move, 0.0, 0.0, 1.0)

    def assemble(self, trial):
        residual, entries = np.zeros(len(trial.x) + 1), []
        for term in (self.solid, self.term):
            for block in term.elements(trial, term.start()):
                dofs, ke = term.groups[block.group][block.part], block.matrices
                if term.symmetric:
                    ke = np.triu(ke) + np.triu(ke, 1).swapaxes(1, 2)
                np.add.at(residual, dofs, block.residuals)
                rows, columns = np.broadcast_to(dofs[:, :, None], ke.shape), np.broadcast_to(dofs[:, None, :], ke.shape)
                keep = (rows >= 0) & (columns >= 0)
                entries.append((ke[keep], rows[keep], columns[keep]))
        data, rows, columns = (np.concatenate(part) for part in zip(*entries, strict=True))
        count = len(trial.x)
        return residual[:count], sp.csc_matrix((data, (rows, columns)), (count, count))

    def step(self, *move):
        """Move the dot to move (3,) and find the equilibrium: plain semismooth Newton."""
        move, x, before = np.array(move, float), self.x.copy(), None
        for iteration in range(MAX_ITERATIONS):
            trial = self.trial(x, move)
            residual, tangent = self.assemble(trial)
            status = self.term.status(trial, None)
            scale = max(self.scale, np.linalg.norm(x[self.contact.pressure_dofs] * self.contact.nodal_area))
            settled = before is not None and np.array_equal(status, before)
            if settled and np.linalg.norm(residual) <= 1e-11 * scale:
                self.iterations.append(iteration)
                return self.accept(trial, scale)
            x, before = self.advance(x, move, splu(tangent).solve(-residual)), status
        raise ArithmeticError("no equilibrium")

    def advance(self, x, move, step):
        """The full step, halved while it turns an element inside out."""
        for _ in range(6):
            try:
                deque(self.solid.elements(self.trial(x + step, move), self.solid.start()), maxlen=0)
            except InvertedElementError:
                step = 0.5 * step
            else:
                return x + step
        raise ArithmeticError("turned inside out")

    def accept(self, trial, scale):
        """Keep a converged state; the dot's work by the trapezoidal rule."""
        before, travel = self.force, trial.move - self.move
        if self.term is not self.contact:
            self.dissipated += slip_work(self.term, trial, self.x[self.term.friction_dofs])
        self.x, self.move, self.last, self.scale = trial.x, trial.move, trial, scale
        self.work += 0.5 * float((before + self.force) @ travel)
        return self

    @property
    def slips(self):
        """Surface nodes that slip (c,)."""
        return np.split(self.term.status(self.last, None), 2)[1]

    @property
    def pressure(self):
        return self.x[self.contact.pressure_dofs]

    @property
    def friction(self):
        return self.x[self.term.friction_dofs]

    @property
    def force(self):
        """Of the dot on the block (3,)."""
        u = self.displacement(self.x)
        if isinstance(self.term, ContactFacets):
            return self.contact.force(u, self.move, self.pressure)
        return self.term.force(u, self.move, self.pressure, self.friction)

    @property
    def energy(self):
        """Stored."""
        f = deformation_gradient(self.solid.gradient, self.displacement(self.x)[self.tets])
        isochoric = self.law.energy((f.swapaxes(-1, -2) @ f).reshape(-1, 3, 3)).reshape(f.shape[:2])
        # the mixed form stores p^2 / 2K
        pressure = np.einsum("qa,ma->mq", linear(tetrahedron()[0]), self.x[self.solid.dofs[:, 30:]])
        return float(np.vdot(self.solid.weight, isochoric + 0.5 * pressure**2 / self.law.bulk_modulus))


def held_at_its_base(points):
    """Numbers (n, 3) of all displacements above z = 0."""
    numbers = np.full(points.shape, -1)
    above = points[:, 2] > 1e-9
    numbers[above] = np.arange(3 * above.sum()).reshape(-1, 3)
    return numbers


def block(kind, coefficient, cells=2, law=None, length=1.0, stress=1.0, **options):
    """A block of 1 x 1 x 0.6 on its base, touched in the middle of its face; in any unit of length and stress."""
    points, tets = box(cells, (1.0, 1.0, 0.6))
    law = (law or neo_hookean(1.0, 0.45)).scale_moduli(stress)
    dot = rigid(kind, length * np.array([0.5, 0.5, 0.6]), radius=0.6 * length)
    return Block(length * points, tets, law, dot, held_at_its_base(points), coefficient, **options)


def press(body, depth, steps=2):
    for fraction in np.arange(1, steps + 1) / steps:
        body.step(0.0, 0.0, -fraction * depth)
    return body


def slide(body, to, steps):
    start = body.move[:2]
    for fraction in np.arange(1, steps + 1) / steps:
        body.step(*(start + fraction * (np.array(to) - start)), body.move[2])
    return body


# A column whose levels keep plane is in one homogeneous state, compressed to a = 1 - depth and sheared by g.
# W = G/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2 with I1 = 2 + g^2 + a^2, J = a gives its forces per area.
HEIGHT, DEPTH, SHEAR = 1.0, 0.04, 1.0
BULK = bulk_modulus(SHEAR, 0.45)


def shear_force(g, a=1.0 - DEPTH):
    return SHEAR * a ** (-2.0 / 3.0) * g


def normal_force(g, a=1.0 - DEPTH):
    return SHEAR * (a ** (-5.0 / 3.0) * (2.0 + g**2 + a**2) / 3.0 - a ** (1.0 / 3.0)) + BULK * (1.0 - a)


def column(coefficient):
    """Every level moves as one in x and z, and not in y: a plane-strain block with one node of contact."""
    points, tets = box(2)
    level = np.unique(np.round(points[:, 2], 9), return_inverse=True)[1] - 1  # -1 at the base
    numbers = np.column_stack([level, np.full(len(level), -1), np.where(level < 0, -1, level + level.max() + 1)])
    body = Block(
        points,
        tets,
        neo_hookean(SHEAR, 0.45),
        rigid("plate", [0.5, 0.5, HEIGHT]),
        numbers,
        coefficient,
        node=np.zeros(len(points), int),
    )
    return body.step(0.0, 0.0, -DEPTH)


def top(body):
    return body.displacement(body.x)[body.surface]


@for_each("coefficient", [0.1, 0.3, 0.8])
def test_a_block_sticks_below_the_limit_and_slips_at_it(coefficient):
    limit = brentq(lambda g: shear_force(g) - coefficient * normal_force(g), 0.0, 2.0, xtol=1e-15)
    body = column(coefficient)
    for share in (0.5, 0.9999):
        body.step(share * limit, 0.0, -DEPTH)
        assert not body.slips.any()
        np.testing.assert_allclose(top(body), np.tile([share * limit, 0.0, -DEPTH], (len(body.surface), 1)), atol=1e-12)
        expected = [shear_force(share * limit), 0.0, -normal_force(share * limit)]
        np.testing.assert_allclose(body.force, expected, atol=1e-8)
    for share in (1.0001, 1.5, 3.0):
        body.step(share * limit, 0.0, -DEPTH)
        assert body.slips.all()
        np.testing.assert_allclose(top(body)[:, 0], limit, rtol=1e-8)
        assert body.force[0] == pytest.approx(-coefficient * body.force[2], rel=1e-8)
    assert not body.friction[:, 1:].any()


def test_a_reversed_block_sticks_for_twice_the_limit_and_then_slips_back():
    limit = brentq(lambda g: shear_force(g) - 0.3 * normal_force(g), 0.0, 2.0, xtol=1e-15)
    body = column(0.3).step(2.0 * limit, 0.0, -DEPTH)
    body.step(0.001 * limit, 0.0, -DEPTH)
    np.testing.assert_allclose(top(body)[:, 0], -0.999 * limit, rtol=1e-8)
    body.step(-limit, 0.0, -DEPTH)
    np.testing.assert_allclose(top(body)[:, 0], -limit, rtol=1e-8)


def test_slip_loses_friction_times_path():
    body = column(0.3).step(0.5, 0.0, -DEPTH)
    lost, traction = body.dissipated, body.force[0]
    body.step(0.9, 0.0, -DEPTH)
    assert body.dissipated - lost == pytest.approx(0.4 * traction, rel=1e-8)


@pytest.mark.press
@for_each("coefficient", [0.1, 0.2, 0.3])
def test_a_plate_that_slides_drags_with_the_coefficient_times_its_force(coefficient):
    """And drags back when it turns; once the block keeps still, all its surface slips in one direction."""
    body = press(block("plate", coefficient), 0.02)
    for sign in (1.0, -1.0):
        slide(body, sign * np.array([0.18, 0.24]), 10)
        assert body.slips.sum() == (body.pressure > 0.0).sum()
        drag = -coefficient * body.force[2] * sign * np.array([0.6, 0.8])
        np.testing.assert_allclose(body.force[:2], drag, atol=1e-8 * abs(body.force[2]))


def test_a_cap_that_slides_drags_with_about_the_coefficient_times_its_pressure():
    """Every node exactly; in sum about, for the tractions lie along the curved surface. It drags back when it turns."""
    body = press(block("cap", 0.3, cells=3), 0.08)
    for to, sign in ((0.1, 1.0), (0.0, -1.0)):
        slide(body, (to, 0.0), 4)
        assert body.slips.sum() == (body.pressure > 0.0).sum()
        np.testing.assert_allclose(np.linalg.norm(body.friction, axis=1), 0.3 * body.pressure, atol=1e-8)
        area = body.contact.nodal_area
        assert area @ body.friction[:, 0] == pytest.approx(sign * 0.3 * (area @ body.pressure), rel=0.05)


@pytest.mark.press
@for_each("coefficient", [0.3, 0.8])
@for_each("kind", ["plate", "cap"])
def test_newton_needs_few_iterations(kind, coefficient):
    body = press(block(kind, coefficient, cells=3), 0.08)
    slide(body, (0.06, 0.02), 2)
    slide(body, (-0.06, 0.0), 4)
    assert max(body.iterations) <= 12


def energy_error(kind, coefficient, steps):
    """(work - stored - dissipated) / work over: press, slide askew, slide back past the start, lift nearly off."""
    body, there = block(kind, coefficient), np.zeros(3)
    for target in np.array([[0.0, 0.0, -0.08], [0.06, 0.02, -0.08], [-0.06, 0.0, -0.08], [0.0, 0.0, -0.01]]):
        for fraction in np.arange(1, steps + 1) / steps:
            body.step(*(there + fraction * (target - there)))
        there = target
    assert body.dissipated > 0.1 * body.work
    return abs(body.work - body.energy - body.dissipated) / body.work


@pytest.mark.press
@for_each(("kind", "steps"), [("plate", 16), ("cap", 32)])
def test_work_of_a_cycle_is_stored_or_lost_in_slip(kind, steps):
    """The cap needs smaller steps on this surface of 25 nodes: each that closes or opens within a step is an error."""
    assert energy_error(kind, 0.3, steps) < 1e-3


def answer(**options):
    body = slide(press(block("cap", 0.3, **options), 0.08), (0.05, 0.02), 3)
    assert body.slips.any()
    return body


def test_the_answer_does_not_contain_the_number_that_steers_the_iteration():
    reference = answer(stiffness=10.0)
    for stiffness in (1.0, 20.0):
        np.testing.assert_allclose(answer(stiffness=stiffness).x, reference.x, atol=1e-8)


def scaled_path(length, stress):
    body = block("cap", 0.3, length=length, stress=stress)
    for x, z in ((0.0, 0.04), (0.0, 0.08), (0.03, 0.08), (0.05, 0.08)):
        body.step(length * x, 0.0, -length * z)
    return body.force / (stress * length**2)


def test_the_answer_does_not_depend_on_the_units():
    np.testing.assert_allclose(scaled_path(2.0, 3.0), scaled_path(1.0, 1.0), atol=1e-8)


def test_coefficient_zero_is_the_frictionless_contact():
    smooth, without = block("cap", 0.0), block("cap", None)
    for move in ((0.0, 0.0, -0.05), (0.05, 0.02, -0.08)):
        smooth.step(*move)
        without.step(*move)
    assert not smooth.friction.any()
    np.testing.assert_allclose(smooth.x[: len(without.x)], without.x, atol=1e-12)


def mirrored(points, tets, axis):
    """The mesh and its image across the plane where the coordinate axis is zero, merged there."""
    image = points * np.where(np.arange(3) == axis, -1.0, 1.0)
    turned = tets[:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]] + len(points)  # the same handedness as before
    every = np.vstack([points, image])
    _, first, inverse = np.unique(np.round(every, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    return every[first], inverse.reshape(-1)[np.vstack([tets, turned])]


def test_friction_of_a_centred_press_on_an_incompressible_block_is_symmetric():
    points, tets = box(2, (0.5, 0.5, 0.6))
    for axis in (0, 1):
        points, tets = mirrored(points, tets, axis)
    body = Block(points, tets, neo_hookean(1.0, 0.4999), rigid("cap", [0.0, 0.0, 0.6]), held_at_its_base(points), 0.1)
    press(body, 0.15, steps=3)
    xy, largest = points[body.surface, :2], body.pressure.max()
    assert np.abs(body.friction).max() > 1e-3 * largest
    assert np.abs(body.force[:2]).max() < 1e-9 * -body.force[2]
    for image, order in ((xy * [-1, 1], [0, 1]), (xy * [1, -1], [0, 1]), (xy[:, ::-1], [1, 0])):
        twin = np.argmin(np.linalg.norm(image[:, None] - xy[None], axis=-1), axis=1)
        sign = np.ones(2) if order == [1, 0] else np.where(image[0] == xy[0], 1.0, -1.0)
        np.testing.assert_allclose(body.pressure[twin], body.pressure, atol=1e-9 * largest)
        np.testing.assert_allclose(sign * body.friction[twin][:, order], body.friction[:, :2], atol=1e-9 * largest)
