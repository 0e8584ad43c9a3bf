"""A mesh that would fill the memory is refused; a usual one is counted about right."""

import pytest

from foundation.errors import InputError
from geometry.dot_at_rest import resolve_dot
from mesh.build import build
from mesh.options import MeshOptions
from softdot.checks import expected_tetrahedra, refuse_huge_mesh
from softdot.config.loading import load_config
from tests.cases import for_each

SEGMENT = load_config().segment
DOT = resolve_dot(load_config().dot, SEGMENT)


@for_each("name", ["element_size_mm", "contact_element_size_mm", "film_element_size_mm"])
def test_a_slip_of_the_decimal_point_is_refused(name):
    with pytest.raises(InputError, match=f"mesh.{name} = 0.001: means about"):
        refuse_huge_mesh(SEGMENT, DOT, MeshOptions(**{name: 0.001}))


def test_a_usual_mesh_is_accepted():
    refuse_huge_mesh(SEGMENT, DOT, MeshOptions())
    refuse_huge_mesh(SEGMENT, DOT, MeshOptions(element_size_mm=0.15, contact_element_size_mm=0.05))


def test_the_estimate_has_the_right_size():
    options = MeshOptions(element_size_mm=0.6, contact_element_size_mm=0.3, mesher="layered")
    made = build(SEGMENT, DOT, options)
    soft = sum(len(made.region_tets(name)) for name in ("medium2", "medium1", "effector"))
    assert 0.4 * soft < expected_tetrahedra(SEGMENT, DOT, options) < 2.5 * soft
