"""A delaminated patch: no tension, no penetration, and closed under compression as if it were bonded."""

import numpy as np
import pytest

from foundation.errors import InputError
from mesh.interfaces import interface_facets, split_interface
from solve.delaminations import delaminated_facets
from solve.materials.laws import InvariantLaw
from solve.physics import Delamination
from solve.terms.unilateral_interface import opening_nodes, unilateral_interface
from tests.cases import for_each
from tests.solve.term_body import TermBody, layers, tangent_error

RUBBER = InvariantLaw(0.5, 0.0, 0.0, 0.0, 20.0)
STIFF = RUBBER.scale_moduli(50.0)
LAWS = {"medium2": RUBBER, "film": RUBBER}
NAMES = ["bond-film-medium2", "bond-base"]


def blocks(cells: int = 4, is_slice: bool = False):
    x = np.linspace(-0.5, 0.5, cells + 1)
    y = np.array([0.0, 1.0 / cells]) if is_slice else x
    return layers(x, y, [[0.0, 0.5], [0.5, 1.0]], is_slice=is_slice)


def delaminated(tet_mesh, name, center=(0.0, 0.0), diameter=0.6, is_slice=False, laws=LAWS, outside=False):
    """A body with a patch, the patch, and the displacements (n, 3) that the ground holds."""
    inside = delaminated_facets(tet_mesh, Delamination(name, center, diameter, outside), is_slice)
    split, lower, upper = split_interface(tet_mesh, name, ~inside)
    body = TermBody(split, laws)
    fixed = np.zeros(body.points.shape, bool)
    fixed[split.facets["base"]] = True
    dofs = np.where(fixed, -1, body.dofs)
    multipliers = body.unknowns(opening_nodes(lower[inside], upper[inside], dofs)[1])
    patch = unilateral_interface(body.points, lower[inside], upper[inside], dofs, multipliers)
    body.terms.append(patch)
    return body, patch, fixed


@for_each("name", NAMES)
@for_each("is_slice", [False, True], ids=["solid", "slice"])
@for_each("outside", [False, True], ids=["patch", "rim"])
def test_even_compression_passes_through_a_closed_patch(name, is_slice, outside):
    """u = -0.1 z in a confined block, as without the patch, and the same pressure at every node of the patch."""
    body, patch, fixed = delaminated(blocks(is_slice=is_slice), name, is_slice=is_slice, outside=outside)
    top = body.points[:, 2] == 1.0
    fixed[:, :2], fixed[top] = True, True
    squeezed = -0.1 * body.points * [0.0, 0.0, 1.0]
    state = body.solve(fixed, squeezed)
    np.testing.assert_allclose(state.displacement, squeezed, atol=1e-8)
    area = 0.25 if is_slice else 1.0
    np.testing.assert_allclose(state.x[patch.multipliers], -body.force(state, top)[2] / area, rtol=1e-8)


@for_each("name", NAMES)
def test_tension_opens_the_patch_and_meets_no_traction_there(name):
    body, patch, fixed = delaminated(blocks(), name)
    top = body.points[:, 2] == 1.0
    fixed[top] = True
    state = body.solve(fixed, 0.05 * body.points * [0.0, 0.0, 1.0])
    assert not patch.status(body.trial(state.x), None).any()
    np.testing.assert_array_equal(state.x[patch.multipliers], 0.0)
    assert patch.weighted_opening(state.displacement).min() > 0.0
    perfect = TermBody(blocks(), LAWS)
    clamped = np.repeat(((perfect.points[:, 2] == 0.0) | (perfect.points[:, 2] == 1.0))[:, None], 3, axis=1)
    bonded = perfect.solve(clamped, 0.05 * perfect.points * [0.0, 0.0, 1.0])
    assert body.force(state, top)[2] < perfect.force(bonded, perfect.points[:, 2] == 1.0)[2]


def blistered(push: float):
    """A thin stiff skin on rubber, shortened by 4 %, with a patch over 60 % of its length pushed by nodal forces."""
    x = np.linspace(-1.0, 1.0, 21)
    tet_mesh = layers(x, [0.0, 0.1], [np.linspace(-0.5, 0.0, 3), [0.0, 0.04]], is_slice=True)
    laws = {"medium2": RUBBER, "film": STIFF}
    body, patch, fixed = delaminated(tet_mesh, "bond-film-medium2", (0.1, 0.0), 1.2, True, laws)
    fixed[:, 1], fixed[np.abs(body.points[:, 0]) == 1.0, 0] = True, True
    load = np.zeros(body.points.shape)
    load[(body.points[:, 2] == 0.04) & (np.abs(body.points[:, 0] - 0.1) < 0.06), 2] = push
    state = body.solve(fixed, 0.0, load)
    for shortening in (0.01, 0.02, 0.03, 0.04):
        state = body.solve(fixed, -shortening * body.points * [1.0, 0.0, 0.0], load, state.x)
    return body, patch, state


@pytest.mark.press
@for_each(("push", "touches"), [(2e-4, False), (-1e-3, True)], ids=["pushed up", "pushed down"])
def test_a_buckling_skin_neither_passes_through_its_substrate_nor_sticks_to_it(push, touches):
    """lambda >= 0, g >= 0 and lambda g = 0 at every node of a patch whose skin has lifted by more than its own
    thickness (it buckles at pi^2 h^2 / (3 l^2) = 0.4 %)."""
    _, patch, state = blistered(push)
    opening = patch.weighted_opening(state.displacement) / patch.nodal_area
    pressure = state.x[patch.multipliers]
    assert opening.min() > -1e-10
    assert pressure.min() >= 0.0
    assert np.abs(opening * pressure).max() < 1e-10
    assert opening.max() > 0.04
    assert (pressure.max() > 0.1) == touches


@pytest.mark.press
@for_each("name", NAMES)
def test_tangent_is_the_derivative_of_the_residual(name):
    """Some nodes open and some closed, at a large rotation and an opening of the size of the facets."""
    ends = np.array([-0.5, 0.0, 0.5])
    body, patch, _ = delaminated(layers(ends, ends, [[0.0, 0.5], [0.5, 1.0]]), name, diameter=1.0, laws={})
    rng = np.random.default_rng(3)
    turn = np.array([[0.0, -1.0, 0.0], [0.8, 0.0, -0.6], [0.6, 0.0, 0.8]])
    x = np.zeros(body.count)
    x[body.dofs] = body.points @ turn.T - body.points + 0.05 * rng.standard_normal(body.points.shape)
    x[patch.multipliers] = np.where(np.arange(len(patch.multipliers)) % 3, 20.0, -20.0) * rng.uniform(1.0, 2.0)
    closed = patch.status(body.trial(x), None)
    assert closed.any()
    assert not closed.all()
    assert tangent_error(patch, body.trial, x) < 1e-6


def test_no_diameter_is_no_delamination():
    assert not delaminated_facets(blocks(), Delamination("bond-film-medium2", (0.0, 0.0), 0.0), False).any()


def test_the_patch_has_the_area_of_its_disc():
    tet_mesh = blocks(16)
    inside = delaminated_facets(tet_mesh, Delamination("bond-film-medium2", (0.1, -0.1), 0.6), False)
    assert inside.sum() / len(inside) == pytest.approx(np.pi * 0.3**2, rel=0.03)


def test_a_loose_rim_is_all_but_the_disc_that_is_bonded():
    tet_mesh = blocks(8)
    disc, rim = (Delamination("bond-film-medium2", (0.1, 0.0), 0.6, outside) for outside in (False, True))
    inside, outside = (delaminated_facets(tet_mesh, patch, False) for patch in (disc, rim))
    np.testing.assert_array_equal(outside, ~inside)
    with pytest.raises(InputError, match="bonded_diameter_mm = 3: what is loose must span several facets"):
        delaminated_facets(tet_mesh, Delamination("bond-film-medium2", (0.0, 0.0), 3.0, True), False)


def test_a_strip_takes_whole_rectangles_of_a_slice():
    """Rectangles of 0.125 whose middle lies within 0.3, though the next triangles' centroids do too."""
    tet_mesh = blocks(8, is_slice=True)
    facets = interface_facets(tet_mesh, "bond-film-medium2")
    inside = delaminated_facets(tet_mesh, Delamination("bond-film-medium2", (0.0, 0.0), 0.6), True)
    covered = tet_mesh.points_mm[facets[inside], 0]
    assert (covered.min(), covered.max()) == (-0.25, 0.25)
    assert inside.sum() == 2 * 4


@for_each(
    ("center", "diameter", "allowed"),
    [
        ((0.4, 0.0), 0.6, "x from -0.5 to 0.5 mm, y from -0.5 to 0.5 mm"),
        ((0.0, 3.0), 0.6, "within the interface"),
        ((0.0, 0.0), -1.0, "0 or more"),
        ((0.1, 0.1), 0.1, "several facets"),
        ((0.083, 0.167), 0.1, "several facets"),
    ],
)
def test_a_patch_that_reaches_outside_or_opens_nothing_is_refused(center, diameter, allowed):
    with pytest.raises(InputError, match=allowed) as refusal:
        delaminated_facets(blocks(), Delamination("bond-film-medium2", center, diameter), False)
    assert f"center_mm = {list(center)}, diameter_mm = {diameter:g}" in str(refusal.value)
    assert "mechanisms.delamination" in str(refusal.value)
