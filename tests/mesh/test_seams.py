"""Columns of a slice's nodes moved to where something begins."""

import numpy as np
import pytest

from mesh.interfaces import interface_facets
from mesh.jacobian import volumes
from mesh.seams import mesh_with_columns_at
from mesh.types import TET_EDGES, signed_volumes
from tests.solve.term_body import layers


@pytest.fixture(scope="module")
def plain():
    """Ten columns of 0.1 mm in x from -0.5 to 0.5 mm, two layers."""
    return layers(np.linspace(-0.5, 0.5, 11), [0.0, 0.1], [[0.0, 0.25, 0.5], [0.5, 1.0]], is_slice=True)


def columns(tet_mesh):
    """Places of the corners."""
    return np.unique(np.round(tet_mesh.points_mm[np.unique(tet_mesh.tets[:, :4]), 0], 9))


def moved(plain, places, kept=()):
    return mesh_with_columns_at(plain, interface_facets(plain, "bond-film-medium2"), places, kept)


def test_columns_stand_at_the_places_and_no_element_is_turned_inside_out(plain):
    made = moved(plain, (-0.233, 0.167))
    assert {-0.233, 0.167, -0.5, 0.5} <= set(columns(made))
    assert len(columns(made)) == len(columns(plain))
    assert signed_volumes(made.points_mm, made.tets[:, :4]).min() > 0.0
    assert volumes(made.points_mm[made.tets]).sum() == pytest.approx(volumes(plain.points_mm[plain.tets]).sum())


def test_mid_sides_stay_in_the_middle(plain):
    points = moved(plain, (0.04,)).points_mm
    middles, ends = points[plain.tets[:, 4:]], points[plain.tets[:, TET_EDGES]]
    np.testing.assert_allclose(middles, ends.mean(axis=2), atol=1e-12)


def test_what_is_kept_does_not_move(plain):
    assert {-0.2, 0.2, 0.27} <= set(columns(moved(plain, (0.27,), kept=(-0.2, 0.2))))


def test_what_is_kept_between_two_columns_pulls_none_of_them_to_it(plain):
    np.testing.assert_array_equal(moved(plain, (), kept=(-0.13, 0.13)).points_mm, plain.points_mm)


def test_a_place_at_a_column_that_stays_takes_that_column(plain):
    """No element becomes a hundredth as thick as it was."""
    assert np.diff(columns(moved(plain, (0.201,), kept=(0.2,)))).min() > 0.05


def test_a_place_beside_the_mesh_moves_nothing(plain):
    np.testing.assert_array_equal(moved(plain, (0.8,)).points_mm, plain.points_mm)
