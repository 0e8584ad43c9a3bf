"""What the mesh adds to the answer: refinement, the other mesher, and the film as one layer or two."""

import functools

import pytest

from mesh.build import build
from mesh.options import MeshOptions
from solve.model import Press
from tests.cases import for_each
from tests.pressing import press_segment
from tests.solve.segments import cap, materials, segment

pytestmark = pytest.mark.evidence


@functools.cache
def force_and_voltage(boundary="clamped", mesher="pytetwild", contact_mm=0.2, element_mm=0.6, film_layers=1):
    """The true segment, 2.5 x 2.5 mm, on a Marburg dot, 0.3 mm deep."""
    stack = segment(boundary=boundary)
    options = MeshOptions(
        mesher=mesher, contact_element_size_mm=contact_mm, element_size_mm=element_mm, film_layers=film_layers
    )
    result = press_segment(stack, materials(), cap(stack), Press(load_steps=3), build(stack, cap(stack), options))
    assert result.converged, result.failure
    return result.steps[-1].reaction_force_N, float(result.steps[-1].open_circuit_voltage_V[0])


def agree(a, b, force, voltage):
    assert a[0] == pytest.approx(b[0], rel=force)
    assert a[1] == pytest.approx(b[1], rel=voltage)


@for_each("boundary", ["free", "clamped"])
def test_one_quadratic_layer_of_film_is_enough(boundary):
    """Against the film resolved by two quadratic layers: 2 %."""
    one, two = (force_and_voltage(boundary, "layered", 0.2, 0.5, layers) for layers in (1, 2))
    agree(one, two, 0.02, 0.02)


def test_both_meshers_agree():
    """The default mesh against the other mesher: 1 % in force, 2 % in voltage."""
    pytetwild = force_and_voltage("clamped", "pytetwild", 0.1, 0.3)
    agree(pytetwild, force_and_voltage("clamped", "layered", 0.15, 0.4), 0.01, 0.02)


def test_a_mesh_of_half_the_elements_changes_little():
    """From 0.14 to 0.1 mm under the dot the squared size, and with it the error, halves: what is left is as much."""
    coarse, fine = (force_and_voltage(contact_mm=h, element_mm=3 * h) for h in (0.14, 0.1))
    agree(coarse, fine, 0.01, 0.02)
