"""The film with its electrodes: sizes by hand, nothing shorted, everything on the film."""

from math import pi

import pytest

from foundation.errors import InputError
from geometry.fabrication.device import lone_device
from geometry.fabrication.parameters import Fabrication
from geometry.flat.electrodes import stray_area_mm2
from geometry.flat.flat_kit import flat_kit
from geometry.flat.pattern import Label
from geometry.parameters import Electrode, Film
from geometry.polygons import polygon_gap_mm, shared_area_mm2, signed_area_mm2
from tests.cases import for_each

EXITS = ("+x", "-x", "+y", "-y")
TWO = (
    Electrode(name="left", center_mm=(0.0, 0.7), size_mm=(1.8, 0.8)),
    Electrode(name="right", center_mm=(0.0, -0.7), size_mm=(1.8, 0.8)),
)


def side_by_side(make_segment, way="+x"):
    """Both electrodes beside each other, as seen from the cable."""
    turn = slice(None, None, -1 if way.endswith("y") else 1)
    pair = (Electrode(name=one.name, center_mm=one.center_mm[turn], size_mm=one.size_mm[turn]) for one in TWO)
    return make_segment(film=Film(thickness_um=28.0, electrodes=tuple(pair)))


def by_name(kit):
    return {pattern.name: pattern for pattern in kit.patterns}


def test_film_is_footprint_flange_tab_and_head(segment):
    """Body 2.5 + 2 x 0.8 squared, tab 1.6 wide up to 12 beyond the footprint, head 6.15 by 2.54 + 1.5 + 4 x 0.15."""
    outline = by_name(flat_kit(lone_device(segment), Fabrication()))["film"].cuts[-1]
    assert outline.area_mm2 == pytest.approx(4.1**2 + (12.0 - 0.8) * 1.6 + 6.15 * 4.64)


def test_free_film_has_no_flange_and_no_ring(make_segment):
    kit = flat_kit(lone_device(make_segment(boundary="free")), Fabrication())
    assert by_name(kit)["film"].cuts[-1].area_mm2 == pytest.approx(2.5**2 + 12.0 * 1.6 + 6.15 * 4.64)
    assert not [name for name in by_name(kit) if name.startswith("adhesive-flange")]


@for_each("way", EXITS)
def test_active_film_is_where_both_faces_have_metal(make_segment, way):
    """The electrodes of the configuration overlap the common one entirely; no lead overlaps another on the tab."""
    kit = flat_kit(lone_device(side_by_side(make_segment, way)), Fabrication(cable_exit=way, tab_width_mm=2.4))
    *tops, bottom = kit.metals
    assert {metal.name for metal in tops} == {"left", "right"}
    for top in tops:
        assert (top.rect[1] - top.rect[0]) * (top.rect[3] - top.rect[2]) == pytest.approx(1.8 * 0.8)
        assert shared_area_mm2(corners(top.rect), corners(bottom.rect)) == pytest.approx(1.8 * 0.8)
        for piece in top.lead[1:]:
            assert all(shared_area_mm2(piece, other) < 1e-9 for other in bottom.lead)
    assert stray_area_mm2(kit.metals) < 0.05 * 2 * 1.8 * 0.8


@for_each("way", EXITS)
def test_metal_of_a_circle_and_a_polygon_is_electrode_and_lead(make_segment, way):
    """Area inside the outline by inclusion and exclusion; pads carry number and name."""
    round_one = Electrode(name="disc", shape="circle", center_mm=(0.0, 0.6), radius_mm=0.5)
    bent = ((-1.0, -1.1), (1.0, -1.1), (1.0, -0.3), (0.6, -0.3), (0.6, -0.8), (-1.0, -0.8))
    both = (round_one, Electrode(name="bent", shape="polygon", corners_mm=bent))
    turned = Fabrication(cable_exit=way, tab_width_mm=3.0)
    if way.endswith("y"):
        both = (round_one.model_copy(update={"center_mm": (0.6, 0.0)}), Electrode(name="bent", shape="polygon",
            corners_mm=tuple((y, x) for x, y in bent)))  # fmt: skip
    kit = flat_kit(lone_device(make_segment(film=Film(thickness_um=28.0, electrodes=both))), turned)
    areas = {"disc": pi * 0.25, "bent": 2.0 * 0.3 + 0.4 * 0.5}
    for metal in kit.metals[:-1]:
        electrode = sum(signed_area_mm2(piece) for piece in metal.plates)
        assert electrode == pytest.approx(areas[metal.name])
        lead = sum(signed_area_mm2(piece) for piece in metal.lead)
        both_mm2 = sum(shared_area_mm2(one, piece) for one in metal.lead for piece in metal.plates)
        assert metal.outline.area_mm2 == pytest.approx(electrode + lead - both_mm2)
    labels = {mark.text for mark in by_name(kit)["film"].marks if isinstance(mark, Label)}
    assert {f"{metal.pad} {metal.name}" for metal in kit.metals} < labels


def corners(rect):
    u0, u1, v0, v1 = rect
    return ((u0, v0), (u1, v0), (u1, v1), (u0, v1))


def test_whole_electrode_has_the_area_of_the_footprint_and_nothing_more(segment):
    top, bottom = metals = flat_kit(lone_device(segment), Fabrication()).metals
    assert top.rect == bottom.rect == (-1.25, 1.25, -1.25, 1.25)
    assert stray_area_mm2(metals) == 0.0


def test_a_lead_over_the_common_electrode_counts_as_stray_film(make_segment):
    """The upper one ends 0.5 mm earlier: its lead, 0.5 mm wide and straight, crosses the common electrode there."""
    pair = (Electrode(name="short", center_mm=(-0.25, 0.7), size_mm=(1.3, 0.8)), TWO[1])
    segment = make_segment(film=Film(thickness_um=28.0, electrodes=pair))
    metals = flat_kit(lone_device(segment), Fabrication(tab_width_mm=2.4)).metals
    whole = flat_kit(lone_device(side_by_side(make_segment)), Fabrication(tab_width_mm=2.4)).metals
    assert stray_area_mm2(metals) - stray_area_mm2(whole) == pytest.approx(0.5 * 0.5)


def test_leads_of_one_face_keep_their_distance(make_segment):
    one, other, _ = flat_kit(lone_device(side_by_side(make_segment)), Fabrication(tab_width_mm=2.4)).metals
    assert min(polygon_gap_mm(a, b) for a in one.lead for b in other.lead) >= 0.2


@for_each("way", EXITS)
def test_metal_ends_before_the_edge_of_the_film(make_segment, way):
    """Both outlines span a box; that of the metal lies inside, bare film all around but at free edges."""
    pattern = by_name(flat_kit(lone_device(make_segment()), Fabrication(cable_exit=way)))["film"]
    film = pattern.cuts[-1].points
    for metal in (mark for mark in pattern.marks if mark.layer.startswith("ELECTRODE")):
        for axis in (0, 1):
            assert min(p[axis] for p in film) < min(p[axis] for p in metal.points)
            assert max(p[axis] for p in film) > max(p[axis] for p in metal.points)


def test_words_run_along_the_panel(make_segment):
    for way, upright in (("+x", False), ("-x", False), ("+y", True), ("-y", True)):
        marks = by_name(flat_kit(lone_device(make_segment()), Fabrication(cable_exit=way)))["film"].marks
        assert {mark.upright for mark in marks if isinstance(mark, Label)} == {upright}


def test_tab_points_to_the_cable(segment):
    for way, axis, sign in (("+x", 0, 1), ("-x", 0, -1), ("+y", 1, 1), ("-y", 1, -1)):
        points = by_name(flat_kit(lone_device(segment), Fabrication(cable_exit=way)))["film"].cuts[-1].points
        far = max(points, key=lambda p: abs(p[0]) + abs(p[1]))
        assert sign * far[axis] == pytest.approx(1.25 + 12.0 + 6.15)


def test_turned_over_about_the_tab_the_lower_mask_lies_on_the_lower_electrode(segment):
    patterns = by_name(flat_kit(lone_device(segment), Fabrication()))
    bottom = next(mark for mark in patterns["film"].marks if mark.layer == "ELECTRODE-BOTTOM")
    window = patterns["mask-bottom"].cuts[-1]
    assert {(x, -y) for x, y in window.points} == set(bottom.points)


def test_registration_holes_fit_the_pins_and_each_other(segment):
    """Diameter of the pins and twice their clearance, on the axis of the tab, at the same places on every panel."""
    circles = [
        [cut for cut in one.cuts if hasattr(cut, "radius")]
        for one in flat_kit(lone_device(segment), Fabrication()).patterns
    ]
    holes = [found for found in circles if sum(circle.hole for circle in found) > 1]
    assert len(holes) == 5
    assert all(pair == holes[0] for pair in holes)
    assert [hole.area_mm2 for hole in holes[0]] == pytest.approx(2 * [pi * (3.0 + 2 * 0.15) ** 2 / 4])
    assert all(hole.center[1] == 0.0 for hole in holes[0])


def test_draw_direction_lies_as_in_the_configuration(make_segment):
    """Whatever the exit: the arrow is drawn in the axes of the segment."""
    for way in EXITS:
        kit = flat_kit(
            lone_device(make_segment(film=Film(thickness_um=28.0, draw_angle_deg=90.0))), Fabrication(cable_exit=way)
        )
        shaft = by_name(kit)["film"].marks[-1].points
        tips = max(shaft, key=lambda p: p[1]), min(shaft, key=lambda p: p[1])
        assert tips[0][0] == pytest.approx(tips[1][0])


@for_each(
    ("made", "electrodes", "sentence"),
    [
        ({"tab_width_mm": 1.0}, (), r"tab_width_mm = 1: leaves 2 leads of 0.2 mm, below the limit of 0.3 mm"),
        ({"tab_width_mm": 5.0}, (), r"tab_width_mm = 5: the film is only 4.1 mm wide"),
        ({"tab_length_mm": 1.0}, (), r"tab_length_mm = 1: the tab would end inside the frame, .* must be at least"),
        ({"array": (2, 1), "pitch_mm": 5.0}, (), r"array = \[2, 1\]: with cable_exit = '\+x' the tab of one segment"),
        ({"array": (1, 2), "pitch_mm": 4.0}, (), r"pitch_mm = 4.0: films side by side are 4.64 mm wide each"),
        ({"sheet_mm": (30.0, 30.0)}, (), r"sheet_mm = \[30.0, 30.0\]: the panel of film needs 12.7 x 40.1 mm"),
        ({"kerf_mm": 0.3}, (), r"kerf_mm = 0.3: the leads of 0.5 mm in the masks are narrower than two cuts"),
        ({"tab_width_mm": 1.6}, TWO, r"tab_width_mm = 1.6: leaves 3 leads of 0.233 mm.*must be at least 1.8"),
        (
            {"tab_width_mm": 2.4},
            (TWO[0], Electrode(name="right", center_mm=(0.0, -0.1), size_mm=(1.8, 0.8))),
            r"'left' and 'right' are 0 mm apart, below the limit of 0.2 mm",
        ),
        (
            {"tab_width_mm": 2.4},
            (
                Electrode(name="near", center_mm=(0.6, 0.0), size_mm=(0.6, 1.0)),
                Electrode(name="far", center_mm=(-0.6, 0.0), size_mm=(0.6, 1.0)),
            ),
            r"the lead of '\w+' comes within 0 mm of '\w+', below the limit of 0.2 mm",
        ),
    ],
)
def test_what_cannot_be_cut_is_refused_with_its_limit(make_segment, made, electrodes, sentence):
    film = Film(thickness_um=28.0, electrodes=electrodes)
    with pytest.raises(InputError, match=sentence):
        flat_kit(lone_device(make_segment(film=film)), Fabrication(**made))


def test_an_electrode_beside_the_tab_has_no_way_out_of_a_free_film(make_segment):
    aside = (Electrode(name="corner", center_mm=(1.0, 1.0), size_mm=(0.5, 0.5)),)
    segment = make_segment(boundary="free", film=Film(thickness_um=28.0, electrodes=aside))
    with pytest.raises(InputError, match="'corner' ends 0 mm from the edge of the film and beside the tab"):
        flat_kit(lone_device(segment), Fabrication())
