"""Sizes of dots against hand-computed radii, and every refusal of a dot."""

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.dot_at_rest import resolve_dot
from geometry.dot_size import dot_size
from geometry.parameters import Dot
from tests.cases import for_each


@for_each(
    ("base", "height", "radius"),
    [(1.5, 0.6, 0.769), (1.44, 0.48, 0.780), (1.5, 0.5, 0.812), (1.6, 0.2, 1.70), (1.6, 0.8, 0.800)],
)
def test_radius_of_a_spherical_cap(segment, base, height, radius):
    shape = resolve_dot(Dot(base_diameter_mm=base, height_mm=height), segment)
    assert shape.radius_mm == pytest.approx(radius, abs=6e-4)
    assert dot_size(Dot(base_diameter_mm=base, height_mm=height)).foot_mm == 0.0
    assert shape.base_diameter_mm == pytest.approx(base)


def test_nothing_given_is_a_marburg_cap(segment):
    shape = resolve_dot(Dot(), segment)
    assert shape.kind == "cap"
    assert shape.radius_mm == 0.8125  # (0.75^2 + 0.5^2) / (2 * 0.5)
    assert shape.height_mm == 0.5
    assert shape.tips_mm.tolist() == [[0.0, 0.0, 0.0]]
    assert shape.origin_mm == pytest.approx([0.0, 0.0, 3.528])
    assert np.array_equal(shape.rotation, np.eye(3))


def test_a_cap_that_would_undercut_is_a_hemisphere_on_a_foot(segment):
    dot = Dot(base_diameter_mm=1.6, height_mm=0.9)
    shape = resolve_dot(dot, segment)
    assert (shape.radius_mm, shape.height_mm) == (0.8, 0.9)
    assert dot_size(dot).foot_mm == pytest.approx(0.1)
    assert shape.base_diameter_mm == pytest.approx(1.6)


@for_each("kind", ["cap", "ridge"])
def test_a_radius_alone_stands_out_by_itself(segment, kind):
    size = dot_size(Dot(shape=kind, radius_mm=1.15))
    assert (size.radius_mm, size.height_mm, size.foot_mm) == (1.15, 1.15, 0.0)
    shape = resolve_dot(Dot(shape=kind, radius_mm=1.15), segment)
    assert (shape.radius_mm, shape.height_mm) == (1.15, 1.15)


def test_a_radius_with_a_height_may_be_larger_or_smaller():
    shallow = dot_size(Dot(shape="ridge", radius_mm=3.0, height_mm=0.5))
    assert (shallow.radius_mm, shallow.height_mm, shallow.foot_mm) == (3.0, 0.5, 0.0)
    tall = dot_size(Dot(radius_mm=0.5, height_mm=0.75))
    assert (tall.radius_mm, tall.height_mm, tall.foot_mm) == (0.5, 0.75, 0.25)


def test_neighbours_lie_around_the_pressed_dot(segment):
    shape = resolve_dot(Dot(cell="⠿", cell_dot=5, standard="nls"), segment)
    p = 2.34  # dot 5: right column, middle row
    others = {(-p, p, 0.0), (-p, 0.0, 0.0), (-p, -p, 0.0), (0.0, p, 0.0), (0.0, -p, 0.0)}
    assert shape.tips_mm[0].tolist() == [0.0, 0.0, 0.0]
    assert {tuple(np.round(c, 12) + 0.0) for c in shape.tips_mm[1:]} == others


def test_each_dot_of_a_cell_may_have_its_own_height(segment):
    """Of dots 1, 2 and 3 the second is 0.1 mm lower, the third 0.05 mm higher; all stand on one plate."""
    dot = Dot(cell="⠇", cell_dot=1, standard="marburg-medium", cell_heights_mm=(0.5, 0.4, 0.55))
    shape = resolve_dot(dot, segment)
    assert shape.tips_mm == pytest.approx(np.array([[0.0, 0.0, 0.0], [0.0, 2.5, 0.1], [0.0, 5.0, -0.05]]))
    assert shape.heights_mm == pytest.approx([0.5, 0.4, 0.55])
    assert shape.radius_mm == resolve_dot(Dot(), segment).radius_mm


def test_the_highest_dot_of_a_cell_touches_first(segment):
    """The pressed dot, 0.05 mm lower, keeps that distance at rest."""
    dot = Dot(cell="⠃", standard="marburg-medium", cell_heights_mm=(0.5, 0.55))
    assert resolve_dot(dot, segment).origin_mm == pytest.approx([0.0, 0.0, 3.528 + 0.05])


REFUSED = {
    "standard and size": (
        Dot(standard="nls", height_mm=0.5),
        "dot.height_mm = 0.5: dot.standard = 'nls' fixes the sizes already; give either the standard or explicit sizes",
    ),
    "base and radius": (
        Dot(base_diameter_mm=1.5, radius_mm=0.8),
        "dot.radius_mm = 0.8: dot.base_diameter_mm = 1.5 is given too; give either of them",
    ),
    "height alone": (
        Dot(height_mm=0.5),
        "dot.height_mm = 0.5: a height alone is not a dot; add dot.base_diameter_mm or dot.radius_mm",
    ),
    "base alone": (
        Dot(base_diameter_mm=1.5),
        "dot.base_diameter_mm = 1.5: a base alone is not a dot; add dot.height_mm",
    ),
    "cell of ridges": (
        Dot(shape="ridge", cell="⠿"),
        "dot.cell = '⠿': a cell has dots of dot.shape = 'cap', not 'ridge'",
    ),
    "cell without pitch": (
        Dot(cell="⠿", radius_mm=0.8),
        "dot.cell = '⠿': the distance of its dots comes from dot.standard; name one with a dot pitch instead "
        "of explicit sizes",
    ),
    "pressed dot not raised": (
        Dot(cell="⠇", cell_dot=4),
        "dot.cell_dot = 4: not raised in dot.cell = '⠇', which has 1, 2, 3",
    ),
    "empty cell": (Dot(cell="\u2800"), "dot.cell_dot = 1: not raised in dot.cell = '\u2800', which has none"),
    "unknown standard": (
        Dot(standard="marburg"),
        "dot.standard = 'marburg': no such Braille standard; did you mean 'marburg-medium'?",
    ),
    "too few heights": (
        Dot(cell="⠇", standard="nls", cell_heights_mm=(0.5, 0.4)),
        "dot.cell_heights_mm = [0.5, 0.4]: dot.cell = '⠇' has 3 raised dots; give as many heights",
    ),
    "upended": (Dot(tilt_deg=(0.0, 90.0)), "dot.tilt_deg[1] = 90: must be above -90 and below 90"),
}


@for_each(("dot", "sentence"), REFUSED.values(), ids=REFUSED)
def test_an_impossible_dot_is_refused_in_one_sentence(segment, dot, sentence):
    with pytest.raises(InputError) as error:
        resolve_dot(dot, segment)
    assert str(error.value) == sentence


PLANE = "segment.section = 'plane-strain' has nothing that varies over y"
OUT_OF_PLANE = {
    "cap": (Dot(), f"dot.shape = 'cap': {PLANE}; use dot.shape = 'ridge' or 'plate'"),
    "cell": (Dot(shape="ridge", cell="⠿"), f"dot.cell = '⠿': {PLANE}; leave the cell out"),
    "offset": (Dot(shape="ridge", offset_mm=(0.0, 0.1)), f"dot.offset_mm[1] = 0.1: {PLANE}; must be 0"),
    "tilt": (
        Dot(shape="plate", tilt_deg=(1.0, 0.0)),
        f"dot.tilt_deg[0] = 1: {PLANE}; the tilt about x must be 0",
    ),
}


@for_each(("dot", "sentence"), OUT_OF_PLANE.values(), ids=OUT_OF_PLANE)
def test_nothing_varies_out_of_plane(make_segment, dot, sentence):
    with pytest.raises(InputError) as error:
        resolve_dot(dot, make_segment(section="plane-strain"))
    assert str(error.value) == sentence


def test_a_ridge_and_a_plate_fit_a_plane_strain_section(make_segment):
    sliced = make_segment(section="plane-strain", width_mm=16.0)
    assert resolve_dot(Dot(shape="ridge", radius_mm=1.15, offset_mm=(0.2, 0.0)), sliced).kind == "ridge"
    assert resolve_dot(Dot(shape="plate", tilt_deg=(0.0, 3.0)), sliced).kind == "plate"
