"""A kit that cannot be made is refused in one sentence that names the limit."""

import pytest

from foundation.errors import InputError
from geometry.fabrication.device import lone_device
from geometry.fabrication.kit import solid_kit
from geometry.fabrication.parameters import Fabrication
from geometry.parameters import Effector, Medium
from tests.cases import for_each

DOME = Effector(shape="dome", diameter_mm=2.0, height_mm=0.8)
REFUSED = {
    "wall at the pitch": (
        {},
        {"pitch_mm": 2.5},
        "fabrication.pitch_mm = 2.5",
        "limit for the supported wall of 0.4 mm",
    ),
    "array without a pitch": ({}, {"array": (2, 1)}, "fabrication.pitch_mm is missing", "array = [2, 1]"),
    "thin outer wall": ({}, {"wall_mm": 0.5}, "fabrication.wall_mm = 0.5", "unsupported wall of 0.6 mm"),
    "fdm": ({}, {"printer": "fdm"}, "mm", "FDM limit"),
    "upright dome": ({"effector": DOME}, {"lid_face": "top"}, "undercut", "the limit is 0"),
    "no draft": ({}, {"mould_style": "open", "draft_deg": 0.0}, "fabrication.draft_deg = 0", "less than 1 degree"),
    "deep and open": (
        {"medium2": Medium(thickness_mm=6.0)},
        {"mould_style": "open"},
        "fabrication.mould_style = 'open'",
        "tolerance_mm = 0.05",
    ),
    "thin and split": (
        {"medium1": Medium(thickness_mm=0.45), "held_layers": ("effector", "medium1")},
        {"mould_style": "split"},
        "fabrication.mould_style = 'split'",
        "supported wall of 0.4 mm",
    ),
    "thin cavity": (
        {"medium1": Medium(thickness_mm=0.3)},
        {},
        "segment.medium1",
        "engraving of 0.4 mm",
    ),
    "thin ledge": (
        {"medium1": Medium(thickness_mm=0.3), "effector": DOME},
        {},
        "segment.held_layers",
        "supported wall of 0.4 mm",
    ),
    "cast sponge": (
        {"medium2": Medium(thickness_mm=2.0, material="sponge")},
        {"routes": {"medium2": "cast"}},
        "fabrication.routes.medium2 = 'cast'",
        "fabrication.casting.sponge",
    ),
    "dome of sheet": ({"effector": DOME}, {"routes": {"effector": "sheet"}}, "segment.effector.shape", "sheet"),
    "no effector": ({"effector": None}, {"routes": {"effector": "cast"}}, "fabrication.routes.effector", "absent"),
    "wide tab": ({}, {"tab_width_mm": 2.4}, "fabrication.tab_width_mm = 2.4", "at most 1.9"),
    "deep tab slot": ({}, {"tab_slot_mm": 3.8}, "fabrication.tab_slot_mm = 3.8", "supported wall of 0.4 mm"),
    "short shelf": ({}, {"shelf_mm": 2.0}, "fabrication.shelf_mm = 2", "supported wall of 0.4 mm"),
    "deep vent": ({}, {"vent_depth_mm": 0.6}, "fabrication.vent_depth_mm = 0.6", "at most half"),
    "wide flange": ({}, {"film_flange_mm": 3.0}, "fabrication.film_flange_mm = 3", "at most"),
}


@for_each(("changes", "keys", "start", "limit"), REFUSED.values(), ids=REFUSED)
def test_refusals(make_kit_segment, changes, keys, start, limit):
    with pytest.raises(InputError) as refused:
        solid_kit(lone_device(make_kit_segment(**changes)), Fabrication(**{"cavities": (1, 1), **keys}))
    sentence = str(refused.value)
    assert start in sentence
    assert limit in sentence
    assert "\n" not in sentence
    assert ". " not in sentence


def test_a_narrower_segment_fits_the_pitch(make_kit_segment):
    """0.4 mm of wall, two glue lines and, beside medium 2, two clearances leave 1.5 mm of 2.5 mm."""
    everything = {"effector": "sheet", "medium1": "sheet", "medium2": "sheet"}
    keys = {"pitch_mm": 2.5, "array": (2, 1), "routes": everything, "tab_width_mm": 0.6}
    parts = solid_kit(lone_device(make_kit_segment(length_mm=1.5, width_mm=1.5)), Fabrication(**keys)).parts
    assert {part.label for part in parts} == {"frame-body", "frame-ring", "jig"}
    with pytest.raises(InputError, match=r"at most 1\.5 mm"):
        solid_kit(lone_device(make_kit_segment(length_mm=1.51, width_mm=1.5)), Fabrication(**keys))


def test_only_sides_with_neighbours_count_at_the_pitch(make_kit_segment):
    everything = {"effector": "sheet", "medium1": "sheet", "medium2": "sheet"}
    long = make_kit_segment(length_mm=1.5, width_mm=6.0)
    assert solid_kit(lone_device(long), Fabrication(pitch_mm=2.5, array=(2, 1), routes=everything)).parts
    with pytest.raises(InputError, match=r"fabrication\.pitch_mm = 2\.5: segments of 6 mm"):
        solid_kit(lone_device(long), Fabrication(pitch_mm=2.5, array=(1, 2), routes=everything, tab_width_mm=0.5))


def test_filament_serves_large_segments(make_kit_segment):
    segment = make_kit_segment(
        length_mm=16.0, width_mm=16.0, effector=None, medium1=Medium(thickness_mm=1.0), medium2=Medium(thickness_mm=5.0)
    )
    fabrication = Fabrication(
        printer="fdm", tab_slot_mm=0.8, vent_width_mm=0.8, cavities=(1, 1), routes={"medium2": "sheet"}
    )
    assert {part.process for part in solid_kit(lone_device(segment), fabrication).parts} == {"FDM", "either"}


def test_what_is_not_cast_is_cut(make_kit_segment):
    segment = make_kit_segment(medium2=Medium(thickness_mm=2.0, material="sponge"))
    kit = solid_kit(lone_device(segment), Fabrication(cavities=(1, 1), routes={"medium1": "sheet"}))
    assert kit.cut_from_sheet == ("medium1", "medium2")
    assert [pour.component for pour in kit.pours] == ["effector"]
