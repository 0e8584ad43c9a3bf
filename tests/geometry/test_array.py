"""Where the segments of an array lie, what is refused, and the solids."""

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.array.checks import check_array
from geometry.array.layout import array_layout
from geometry.array.parameters import Array, Groove
from geometry.array.parts import array_parts
from geometry.braille_cells import dot_offset_mm
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Effector, Electrode, Film, Medium, Segment
from tests.cases import for_each

ALL = ("effector", "medium1", "film", "medium2")


def segment(**changes):
    """2.3 mm square, which leaves 0.2 mm at the pitch of 2.5 mm."""
    values = {
        "length_mm": 2.3,
        "width_mm": 2.3,
        "boundary": "free",
        "effector": Effector(),
        "medium1": Medium(thickness_mm=0.5),
        "film": Film(thickness_um=28.0),
        "medium2": Medium(thickness_mm=2.0),
    }
    return Segment(**{**values, **changes})


def layout(array=None, **changes):
    return array_layout(array or Array(), segment(**changes), Dot())


def test_segments_lie_under_the_dots_of_a_cell():
    """Row and column of each segment are those of a dot, at the pitch of the standard, about the middle."""
    places = layout().places
    assert [place.label for place in places][:3] == ["segment-r1c1", "segment-r1c2", "segment-r2c1"]
    at = {(place.column, place.row): (place.x_mm, place.y_mm) for place in places}
    for dot, where in {1: (1, 1), 2: (1, 2), 3: (1, 3), 4: (2, 1), 5: (2, 2), 6: (2, 3)}.items():
        np.testing.assert_allclose(np.subtract(at[where], at[1, 1]), dot_offset_mm(dot, 2.5), atol=1e-12)
    np.testing.assert_array_equal(np.mean(list(at.values()), axis=0), 0.0)


def test_cells_stand_at_the_cell_pitch():
    """Marburg medium: 6.0 mm from cell to cell."""
    columns = layout(Array(cells=2, rows=1)).centres(0)
    np.testing.assert_allclose(columns, [-4.25, -1.75, 1.75, 4.25])


def test_a_layer_has_material_where_it_runs_through_and_islands_only_on_segments():
    """Over the middle of the gap there is film, but no effector."""
    one = layout(Array(columns=2, rows=1))
    gap = np.zeros((1, 2))
    assert one.holds("film", gap, 2.01)[0]
    assert not one.holds("effector", gap, 3.0)[0]
    assert one.holds("effector", np.array([[1.25, 0.0]]), 3.0)[0]


def test_a_groove_takes_the_top_of_its_layer():
    """Above its floor there is nothing, below it the layer runs through."""
    one = layout(Array(columns=2, rows=1, grooves=(Groove(layer="medium2", width_mm=0.4, depth_mm=0.5),)))
    assert not one.holds("medium2", np.zeros((1, 2)), 1.8)[0]
    assert one.holds("medium2", np.zeros((1, 2)), 1.2)[0]
    assert one.holds("medium2", np.array([[0.3, 0.0]]), 1.8)[0]


def test_a_grid_holds_its_layers_and_a_clamped_rim_its_own():
    """What the whole holds is both; the whole then is clamped."""
    whole = layout(Array(grid_layers=("film",)), boundary="clamped", held_layers=("medium2",)).whole
    assert (whole.boundary, whole.held_layers) == ("clamped", ("film", "medium2"))
    assert layout(Array(grid_layers=("film",))).whole.held_layers == ("film",)


REFUSED = {
    "overlap": (Array(pitch_mm=2.0), {}, r"array.pitch_mm = 2: the segments overlap along x, segment.length_mm = 2.3"),
    "cells overlap": (Array(cells=2, cell_pitch_mm=4.0), {}, r"array.cell_pitch_mm = 4: the cells overlap.* 4.8 for"),
    "no gap": (Array(), {"length_mm": 2.5}, r"segment.length_mm = 2.5: leaves a gap of 0 mm along x.*effector.*not in"),
    "no gap for the grid": (
        Array(shared=ALL, grid_layers=("medium1",)),
        {"width_mm": 2.49},
        r"segment.width_mm = 2.49: .*along y.*medium1, which is held by the grid",
    ),
    "rows of slices": (Array(), {"section": "plane-strain"}, r"array.rows = 3: .*'plane-strain'.*; must be 1"),
    "electrodes": (
        Array(),
        {"film": Film(thickness_um=28.0, electrodes=(Electrode(name="a", size_mm=(1.0, 1.0)),))},
        r"segment.film.electrodes: an array has one electrode",
    ),
    "wide dome": (
        Array(),
        {"effector": Effector(shape="dome", diameter_mm=2.25)},
        r"segment.effector.diameter_mm = 2.25: in an array at most 2.185",
    ),
    "block that runs through": (
        Array(shared=ALL),
        {"effector": Effector(shape="block", length_mm=1.0, width_mm=1.0)},
        r"array.shared: names 'effector', whose shape 'block'",
    ),
    "absent": (
        Array(shared=ALL),
        {"effector": None},
        r"array.shared: names 'effector', but segment.effector is absent",
    ),
    "twice": (Array(shared=("film", "film")), {}, r"array.shared: 'film' is named twice"),
    "elastic rim beside a grid": (
        Array(grid_layers=("film",)),
        {"boundary": "elastic"},
        r"segment.boundary = 'elastic': beside a stiff grid",
    ),
    "groove in an island": (
        Array(grooves=(Groove(layer="effector", width_mm=0.3, depth_mm=0.2),)),
        {},
        r"array.grooves\[0\].layer = 'effector': has no groove, as it does not run through",
    ),
    "groove too deep": (
        Array(grooves=(Groove(layer="medium1", width_mm=0.3, depth_mm=0.6),)),
        {},
        r"array.grooves\[0\].depth_mm = 0.6: deeper than medium1, 0.5 mm",
    ),
    "groove as wide as the pitch": (
        Array(grooves=(Groove(layer="medium1", width_mm=2.5, depth_mm=0.1),)),
        {},
        r"array.grooves\[0\].width_mm = 2.5: must be less than the pitch, 2.5 mm",
    ),
    "no electrode left": (Array(electrode_margin_mm=1.2), {}, r"array.electrode_margin_mm = 1.2: leaves no electrode"),
}


@for_each("case", REFUSED)
def test_impossible_arrays_are_refused_by_name(case):
    array, changes, sentence = REFUSED[case]
    with pytest.raises(InputError, match=sentence):
        check_array(layout(array, **changes))


def test_a_standard_without_a_pitch_is_refused():
    """Small English states a cell pitch only."""
    with pytest.raises(InputError, match=r"array.pitch_mm is missing: .*'small-english'"):
        array_layout(Array(), segment(), Dot(standard="small-english"))
    with pytest.raises(InputError, match=r"array.pitch_mm is missing: the dot has sizes of its own"):
        array_layout(Array(), segment(), Dot(radius_mm=0.8))
    assert array_layout(Array(pitch_mm=2.6), segment(), Dot(radius_mm=0.8)).pitch_mm == 2.6


def test_electrodes_that_would_touch_are_told():
    """With a margin there is nothing to tell."""
    touching = Array(shared=ALL)
    assert "0 mm apart" in check_array(layout(touching, length_mm=2.5))[0]
    assert check_array(layout(touching.model_copy(update={"electrode_margin_mm": 0.1}), length_mm=2.5)) == []


def test_solids_are_labelled_by_segment_and_as_large_as_stated():
    """A grid holds effector and medium 1; film and medium 2 run through, the latter with a groove."""
    array = Array(
        columns=2,
        rows=1,
        shared=("film", "medium2"),
        grid_layers=("effector", "medium1", "film"),
        grooves=(Groove(layer="medium2", width_mm=0.4, depth_mm=0.5),),
    )
    one = layout(array)
    check_array(one)
    parts = array_parts(one, resolve_dot(Dot(), one.whole))
    volume = {part.label: part.volume_mm3 for part in parts}
    assert volume["segment-r1c1-effector"] == pytest.approx(2.3**2)
    assert volume["segment-r1c2-medium1"] == pytest.approx(0.5 * 2.3**2)
    assert volume["film"] == pytest.approx(0.028 * 4.8 * 2.3)
    assert volume["medium2"] == pytest.approx(2.0 * 4.8 * 2.3 - 0.4 * 0.5 * 2.3)
    wall = 0.4  # of a printed case; the gap between segments is narrower
    assert volume["grid"] == pytest.approx(1.5 * ((4.8 + 2 * wall) * (2.3 + 2 * wall) - 2 * 2.3**2))
    assert {"case", "dot"} < volume.keys()
