"""The mesh of a diagnosis is small, and found in a few attempts."""

import numpy as np
import pytest

from mesh.options import MeshOptions
from solve.tables import rig_mesh
from tests.diagnose.segment.rigs import model

DOME = {"segment": {
    "effector": {"shape": "dome", "diameter_mm": 2.0, "height_mm": 0.8}, "medium1": {"thickness_mm": 0.8},
    "film": {"thickness_um": 28.0}, "medium2": {"thickness_mm": 2.0},
}}  # fmt: skip


@pytest.fixture
def counted(monkeypatch):
    """Contact sizes of all meshes that were made."""
    sizes = []
    make = rig_mesh.build

    def build(segment, dot, options, planes):
        sizes.append(options.contact_element_size_mm)
        return make(segment, dot, options, planes)

    monkeypatch.setattr(rig_mesh, "build", build)
    return sizes


@pytest.mark.press
def test_a_dome_whose_skin_needs_more_nodes_than_allowed_is_meshed_a_few_times_and_its_contact_stays_resolved(counted):
    made, options = rig_mesh.rig_mesh(model(**DOME), MeshOptions(element_size_mm=0.6, contact_element_size_mm=0.2))
    assert len(counted) <= 6
    assert options.contact_element_size_mm < 0.8  # of a dome 2 mm wide
    assert len(np.unique(made.twin)) < 3 * rig_mesh.MOST_NODES


def test_a_layered_mesh_has_as_many_nodes_as_allowed_at_most():
    made, _ = rig_mesh.rig_mesh(model(), MeshOptions(element_size_mm=0.3, contact_element_size_mm=0.1), 1500)
    assert len(np.unique(made.twin)) <= 1500
