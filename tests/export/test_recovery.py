"""Nodal values of the film: exact for linear fields up to the rim, without the elements' pattern along a held one."""

import numpy as np
import pytest

from export.recovery import film_patches
from mesh.types import TetMesh
from softdot.case import Case
from solve.film_means import film_columns
from tests.cases import for_each

COARSE = {"mesher": "layered", "element_size_mm": 0.7, "contact_element_size_mm": 0.35}


@for_each(
    "tables",
    [
        {"mesh": COARSE},
        {"mesh": {**COARSE, "film_layers": 2}},
        {"mesh": {"mesher": "pytetwild", "element_size_mm": 0.7, "contact_element_size_mm": 0.5}},
        {"mesh": COARSE, "segment": {"section": "plane-strain"}, "dot": {"shape": "ridge"}},
    ],
    ids=["layered", "two layers", "pytetwild", "slice"],
)
def test_a_linear_field_is_recovered_at_every_node_within_its_extremes_in_the_elements(tables):
    tet_mesh = Case(**tables).mesh
    across = 0.0 if "segment" in tables else -1.5

    def field(points):
        return np.stack([0.3 + 2.0 * points[..., 0] + across * points[..., 1], points[..., 0]], axis=-1)

    film = tet_mesh.region_tets("film")
    columns = film_columns(tet_mesh)
    means = columns.mean(field(tet_mesh.points_mm[tet_mesh.tets[film, :4]].mean(axis=1)))
    recovered = film_patches(tet_mesh).at_nodes(means, len(tet_mesh.points_mm))
    nodes = np.unique(tet_mesh.tets[film, :4])  # values midway follow from these
    expected = np.clip(field(tet_mesh.points_mm[nodes]), means.min(axis=0), means.max(axis=0))
    np.testing.assert_allclose(recovered[nodes], expected, atol=1e-9)
    assert not np.delete(recovered, np.unique(tet_mesh.tets[film]), axis=0).any()


def roughness(values):
    """Sum of the second differences of values along a line, against their range."""
    return np.abs(np.diff(values, 2)).sum() / np.ptp(values)


def weighted_means(tet_mesh: TetMesh, values):
    """What recovery replaces: the mean of the elements around each node."""
    tets = tet_mesh.tets[tet_mesh.region_tets("film")]
    total, count = np.zeros(len(tet_mesh.points_mm)), np.zeros(len(tet_mesh.points_mm))
    np.add.at(total, tets.ravel(), np.repeat(values, 10))
    np.add.at(count, tets.ravel(), 1.0)
    return total / np.maximum(count, 1.0)


@pytest.mark.press
def test_charge_along_a_held_rim_does_not_follow_the_elements():
    pressed = Case(mesh={"mesher": "layered"}, press={"load_steps": 1}).press()
    tet_mesh, charge = pressed.result.tet_mesh, pressed.result.steps[-1].fields.charge_density_C_per_m2
    x, y, _ = tet_mesh.points_mm.T
    top = np.unique(tet_mesh.facets["film-top"][:, :3])
    rim = top[x[top] > x.max() - 1e-9]
    rim = rim[np.argsort(y[rim])]
    recovered = film_patches(tet_mesh).at_nodes(charge, len(x))[rim]
    assert roughness(recovered) < 0.5 * roughness(weighted_means(tet_mesh, charge)[rim])
