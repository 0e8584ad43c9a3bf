"""Every refusal of a segment, word for word, and what is allowed beside it."""

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.checks import check_press_depth, check_segment, press_warnings
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Bond, Dot, Effector, Electrode, Film, Medium
from tests.cases import for_each


def film(*electrodes):
    return Film(
        thickness_um=28.0,
        electrodes=tuple(Electrode(name=n, center_mm=c, size_mm=s) for n, c, s in electrodes),
    )


def bonds(*pairs):
    return tuple(Bond(between=p, normal_stiffness_N_per_mm3=1.0, shear_stiffness_N_per_mm3=1.0) for p in pairs)


PLANE = "segment.section = 'plane-strain' has nothing"
REFUSED = {
    "long block": (
        {"effector": Effector(shape="block", length_mm=3.0, width_mm=1.0)},
        "segment.effector.length_mm = 3: wider than the segment, at most segment.length_mm = 2.5",
    ),
    "wide block": (
        {"effector": Effector(shape="block", length_mm=1.0, width_mm=2.6)},
        "segment.effector.width_mm = 2.6: wider than the segment, at most segment.width_mm = 2.5",
    ),
    "cylinder against length": (
        {"effector": Effector(shape="cylinder", diameter_mm=2.0), "length_mm": 1.5},
        "segment.effector.diameter_mm = 2: wider than the segment, at most segment.length_mm = 1.5",
    ),
    "dome against width": (
        {"effector": Effector(shape="dome", diameter_mm=2.0), "width_mm": 1.5},
        "segment.effector.diameter_mm = 2: wider than the segment, at most segment.width_mm = 1.5",
    ),
    "block without length": (
        {"effector": Effector(shape="block", width_mm=1.0)},
        "segment.effector.length_mm is missing: shape = 'block' needs it",
    ),
    "block without width": (
        {"effector": Effector(shape="block", length_mm=1.0)},
        "segment.effector.width_mm is missing: shape = 'block' needs it",
    ),
    "dome without diameter": (
        {"effector": Effector(shape="dome")},
        "segment.effector.diameter_mm is missing: shape = 'dome' needs it",
    ),
    "pointed dome": (
        {"effector": Effector(shape="dome", diameter_mm=1.6, height_mm=0.81)},
        "segment.effector.height_mm = 0.81: a dome is at most half as high as its foot is wide, 0.8 for "
        "diameter_mm = 1.6",
    ),
    "sliced cylinder": (
        {"section": "plane-strain", "effector": Effector(shape="cylinder", diameter_mm=1.0)},
        f"segment.effector.shape = 'cylinder': {PLANE} round about z; use 'block' or 'layer'",
    ),
    "sliced narrow block": (
        {"section": "plane-strain", "effector": Effector(shape="block", length_mm=1.0, width_mm=1.0)},
        f"segment.effector.width_mm = 1: {PLANE} that varies over y; leave it out or give segment.width_mm, 2.5",
    ),
    "electrode over the edge": (
        {"film": film(("a", (0.8, 0.0), (1.0, 1.0)))},
        "segment.film.electrodes[0]: 'a' reaches 1.3 mm from the centre in x, beyond the edge of the film at 1.25 mm",
    ),
    "overlapping electrodes": (
        {"film": film(("a", (-0.4, 0.0), (1.0, 2.0)), ("b", (0.5, 0.5), (1.0, 1.0)))},
        "segment.film.electrodes: 'a' and 'b' overlap by 0.1 mm2",
    ),
    "electrodes of one name": (
        {"film": film(("a", (-0.6, 0.0), (1.0, 2.0)), ("a", (0.6, 0.0), (1.0, 1.0)))},
        "segment.film.electrodes: the name 'a' is given twice",
    ),
    "held but absent": (
        {"effector": None, "held_layers": ("effector", "film")},
        "segment.held_layers: 'effector' is named, but segment.effector is absent",
    ),
    "held twice": (
        {"held_layers": ("film", "film")},
        "segment.held_layers: 'film' is named twice",
    ),
    "far bond": (
        {"bonds": bonds(("medium1", "medium2"))},
        "segment.bonds[0].between = 'medium1' and 'medium2': must be two neighbours in the order base, "
        "medium2, film, medium1, effector",
    ),
    "bond to itself": (
        {"bonds": bonds(("film", "film"))},
        "segment.bonds[0].between = 'film' and 'film': must be two neighbours in the order base, medium2, "
        "film, medium1, effector",
    ),
    "a layer of atoms": (
        {"effector": None, "medium1": Medium(material="rubber", thickness_mm=1e-9)},
        "segment.medium1.thickness_mm = 1e-09: must be at least 0.0001",
    ),
    "a segment as long as a country": (
        {"length_mm": 1e9},
        "segment.length_mm = 1e+09: must be at most 1000",
    ),
    "bond to nothing": (
        {"effector": None, "bonds": bonds(("base", "medium2"), ("effector", "medium1"))},
        "segment.bonds[1].between: 'effector' is named, but segment.effector is absent",
    ),
    "bond twice": (
        {"bonds": bonds(("film", "medium2"), ("medium2", "film"))},
        "segment.bonds[1].between: the bond of 'medium2' and 'film' is given twice",
    ),
}


@for_each(("changes", "sentence"), REFUSED.values(), ids=REFUSED)
def test_an_impossible_segment_is_refused_in_one_sentence(make_segment, changes, sentence):
    with pytest.raises(InputError) as error:
        check_segment(make_segment(**changes))
    assert str(error.value) == sentence


ALLOWED = {
    "default": {},
    "no effector, default held layers": {"effector": None},
    "flush block": {"effector": Effector(shape="block", length_mm=2.5, width_mm=2.5)},
    "hemisphere": {"effector": Effector(shape="dome", diameter_mm=2.0, height_mm=1.0), "boundary": "free"},
    "sliced block": {
        "section": "plane-strain",
        "effector": Effector(shape="block", length_mm=1.0),
        "held_layers": ("film",),
    },
    "touching electrodes": {"film": film(("a", (-0.625, 0.0), (1.25, 2.5)), ("b", (0.625, 0.0), (1.25, 2.5)))},
    "bonds in either order": {"bonds": bonds(("base", "medium2"), ("medium1", "film"), ("medium1", "effector"))},
    "springs without stiffness": {"boundary": "elastic", "side_stiffness_N_per_mm3": 0.0},
}


@for_each("changes", ALLOWED.values(), ids=ALLOWED)
def test_a_possible_segment_passes_without_a_word(make_segment, changes):
    assert check_segment(make_segment(**changes)) == []


@for_each(
    "effector",
    [Effector(shape="block", length_mm=2.5, width_mm=1.0), Effector(shape="cylinder", diameter_mm=2.5)],
)
def test_a_held_effector_that_does_not_touch_the_case_is_told(make_segment, effector):
    (warning,) = check_segment(make_segment(effector=effector))
    assert warning == (
        "segment.held_layers: the effector is narrower than the segment, so that sides of it do not touch "
        "the case and are not held"
    )


def test_clamping_nothing_is_told(make_segment):
    (warning,) = check_segment(make_segment(held_layers=()))
    assert warning.startswith("segment.held_layers is empty: boundary = 'clamped'")


def test_a_press_through_the_stack_is_refused(segment):
    check_press_depth(segment, 3.5)
    with pytest.raises(InputError) as error:
        check_press_depth(segment, 3.6)
    assert str(error.value) == ("press.indentation_mm = 3.6: must be less than the height of the stack, 3.528 mm")


def test_a_press_deeper_than_the_dot_brings_the_plate_down(make_segment):
    segment = make_segment(boundary="free")
    shape = resolve_dot(Dot(), segment)
    assert press_warnings(shape, segment, 0.5) == []
    (warning,) = press_warnings(shape, segment, 0.6)
    assert warning == (
        "the indentation of 0.6 mm exceeds the dot's height of 0.5 mm: the plate around the dot touches the segment too"
    )


def test_a_dot_far_beside_the_segment_is_told(segment):
    # centre of the ball 2.75 mm beside the edge at x = 1.25 and a radius over its height
    clear = np.hypot(2.75, 0.8125) - 0.8125
    (warning,) = press_warnings(resolve_dot(Dot(offset_mm=(4.0, 0.0)), segment), segment, 0.3)
    assert warning.startswith(f"the pressed dot stays {clear:.3g} mm clear of the top of the segment")


def test_a_plate_that_comes_down_on_the_walls_is_told(segment):
    # the walls are flush with the held effector and reach 0.3 + 0.4 mm beyond the segment
    tilt = np.radians(8.0)
    travel = 0.8125 + (0.5 - 0.8125 - 1.95 * np.sin(tilt)) / np.cos(tilt)
    shape = resolve_dot(Dot(tilt_deg=(0.0, 8.0)), segment)
    (warning,) = press_warnings(shape, segment, travel + 0.01)
    assert warning.startswith(
        f"the plate around the dot meets the walls of the case at an indentation of {travel:.3g} mm"
    )
    assert press_warnings(shape, segment, travel - 0.01) == []
