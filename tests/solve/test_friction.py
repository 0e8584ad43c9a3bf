"""Frictional contact on a patch of facets: tangent against differences, what each state of a node means."""

import numpy as np
import pytest

from geometry.dot import DotShape
from solve.fem.numbering import Unknowns
from solve.terms.base import Trial
from solve.terms.contact import contact_facets
from solve.terms.friction import FrictionalContact
from solve.terms.rigid_dot import RigidDot
from tests.cases import for_each
from tests.slip_work import slip_work

NOTHING = np.zeros((0, 4), int)


def tilted(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rigid(kind="cap", rotation=None):
    """A dot of radius 0.8 that rests on the patch's middle."""
    turn = np.eye(3) if rotation is None else rotation
    height = 0.0 if kind == "plate" else 0.5
    return RigidDot(DotShape(kind, 0.8, height, np.zeros((1, 3)), np.array([0.5, 0.5, 0.0]), turn), 1.0)


def patch():
    """Nodes (25, 3) and 8 quadratic facets (8, 6) of the unit square."""
    grid = np.stack(np.meshgrid(*2 * [np.linspace(0.0, 1.0, 5)], indexing="ij"), -1).reshape(-1, 2)
    node = np.arange(25).reshape(5, 5)
    facets = []
    for i, j in ((0, 0), (0, 2), (2, 0), (2, 2)):
        n = node[i : i + 3, j : j + 3]
        facets += [[n[0, 0], n[2, 0], n[2, 2], n[1, 0], n[2, 1], n[1, 1]]]
        facets += [[n[0, 0], n[2, 2], n[0, 2], n[1, 1], n[1, 2], n[0, 1]]]
    return np.column_stack([grid, np.zeros(25)]), np.array(facets)


class Patch:
    """All unknowns free but those named; the approach of the dot is the last unknown."""

    def __init__(self, dot, coefficient, prescribed=(), stiffness=10.0):
        points, facets = patch()
        displacement = np.arange(75).reshape(25, 3)
        for node, component in prescribed:
            displacement[node, component] = -1
        unknowns = Unknowns(displacement, NOTHING, NOTHING, 75 + np.arange(25), 175)
        contact = contact_facets(points, facets, unknowns, dot)
        self.term = FrictionalContact(contact, 100 + np.arange(75).reshape(25, 3), coefficient, stiffness)
        self.displacement = displacement

    def trial(self, x, before=0.0, move_before=(0.0, 0.0, 0.0), lateral=(0.0, 0.0)):
        x = np.array(x)
        u = np.append(x, 0.0)[np.where(self.displacement < 0, len(x), self.displacement)]
        old = np.broadcast_to(before, u.shape)
        return Trial(x, u, np.array([*lateral, -x[175]]), 0.0, old, np.array(move_before), 0.0, 0.0, 1.0)

    def residual(self, trial):
        total = np.zeros(176)
        for block in self.term.elements(trial, None):
            dofs = self.term.groups[block.group][block.part]
            np.add.at(total, np.where(dofs < 0, 0, dofs), np.where(dofs < 0, 0.0, block.residuals))
        return total

    def tangent(self, trial):
        total = np.zeros((177, 177))
        for block in self.term.elements(trial, None):
            dofs = self.term.groups[block.group][block.part]
            np.add.at(total, (dofs[:, :, None], dofs[:, None, :]), block.matrices)
        return total[:176, :176]

    def state(self, trial):
        return np.split(self.term.status(trial, None), 2)


def random_state(rng, roughness, drag):
    """Unknowns of a rough surface under pressure (open at some nodes) and its friction."""
    pressure = rng.uniform(-0.3, 1.0, 25)
    return np.concatenate([roughness * rng.standard_normal(75), pressure, drag * rng.standard_normal(75), [0.05]])


STATES = {"stick": (60.0, 0.2, 0.0), "slip": (0.2, 0.3, 0.4), "mixed": (0.6, 0.3, 0.1), "frictionless": (0.0, 0.3, 0.1)}


@pytest.mark.press
@for_each("name", STATES)
@for_each("kind", ["cap", "ridge", "plate"])
def test_tangent_is_the_derivative_of_the_residual(name, kind):
    """In all unknowns, the dot's approach too, with a tilted dot that moves sideways and some held displacements."""
    coefficient, drag, lateral = STATES[name]
    rng = np.random.default_rng(5)
    body = Patch(rigid(kind, tilted(7.0)), coefficient, prescribed=[(3, 0), (12, 1), (24, 0), (24, 1), (24, 2)])
    before = 0.01 * rng.standard_normal((25, 3))
    x = random_state(rng, 0.02, drag)
    past = {"before": before, "move_before": (0.0, 0.0, -0.04), "lateral": (lateral, 0.02)}
    now = body.trial(x, **past)
    active, slips = body.state(now)
    assert 0 < active.sum() < 25
    expected = {"stick": slips.sum() == 0, "slip": slips.sum() >= 0.9 * active.sum()}
    assert expected.get(name, 0 < slips.sum() <= active.sum())
    tangent = body.tangent(now)
    difference = np.empty_like(tangent)
    for k, step in enumerate(1e-6 * np.eye(176)):
        ahead, behind = body.trial(x + step, **past), body.trial(x - step, **past)
        for other in (ahead, behind):
            np.testing.assert_array_equal(body.term.status(other, None), body.term.status(now, None))
        difference[:, k] = (body.residual(ahead) - body.residual(behind)) / 2e-6
    np.testing.assert_allclose(tangent, difference, atol=1e-6 * np.abs(tangent).max())


def test_open_nodes_and_held_displacements_carry_no_friction():
    """Their rows are -tau = 0, so that none is singular, whatever else happens."""
    held = [(3, 0), (12, 1), (24, 0), (24, 1), (24, 2)]
    body = Patch(rigid(), 0.3, prescribed=held)
    x = random_state(np.random.default_rng(7), 0.02, 0.1)
    trial = body.trial(x, lateral=(0.2, 0.0))
    active, _ = body.state(trial)
    idle = np.repeat(~active[:, None], 3, axis=1)
    idle[tuple(np.transpose(held))] = True
    unknowns = body.term.friction_dofs[idle]
    np.testing.assert_array_equal(body.tangent(trial)[unknowns], -np.eye(176)[unknowns])
    np.testing.assert_array_equal(body.residual(trial)[unknowns], -x[unknowns])


def test_friction_changes_the_force_by_its_own_resultant():
    body = Patch(rigid("plate"), 0.3)
    pressure, friction = np.full(25, 2.0), np.tile([0.3, -0.4, 0.0], (25, 1))
    force = body.term.force(np.zeros((25, 3)), np.zeros(3), pressure, friction)
    np.testing.assert_allclose(force, [0.3, -0.4, -2.0], atol=1e-14)


def test_work_of_a_constant_friction_is_its_traction_times_the_path():
    """On a plate that drags the resting unit square along by (0.2, 0.1)."""
    body = Patch(rigid("plate"), 0.3)
    x = np.zeros(176)
    x[body.term.friction_dofs] = [0.3, 0.4, 0.0]
    trial = body.trial(x, lateral=(0.2, 0.1))
    friction = x[body.term.friction_dofs]
    assert slip_work(body.term, trial, friction) == pytest.approx(0.1, rel=1e-12)
    assert slip_work(body.term, trial, np.zeros_like(friction)) == pytest.approx(0.05, rel=1e-12)
