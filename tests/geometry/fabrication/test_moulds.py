"""A mould forms the designed part, lets the air out and the part too."""

from dataclasses import replace
from math import hypot, radians, sqrt, tan

import pytest
from build123d import Pos, Vector

from geometry.fabrication.casting import check_cavity
from geometry.fabrication.cavity import check_mould_sizes, least_draft_deg, styled_cavity
from geometry.fabrication.device import lone_device
from geometry.fabrication.mould import mould_of
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import box, printer_profile, shape_volume_mm3
from geometry.parameters import Effector
from geometry.stack import layers

pytestmark = pytest.mark.press

EXACT = 1e-6
DOME = Effector(shape="dome", diameter_mm=2.0, height_mm=0.8)
CYLINDER = Effector(shape="cylinder", diameter_mm=1.6, height_mm=0.7)
SHAPES = {
    "layer, open": (Effector(), "open"),
    "layer, split": (Effector(), "split"),
    "block, split": (Effector(shape="block", length_mm=1.6, width_mm=1.2, height_mm=0.7), "split"),
    "dome": (DOME, "auto"),
    "cylinder, open": (CYLINDER, "open"),
    "cylinder, split": (CYLINDER, "split"),
}


@pytest.fixture(scope="module", params=SHAPES)
def mould(request, make_kit_segment):
    effector, style = SHAPES[request.param]
    fabrication = Fabrication(mould_style=style, cavities=(1, 1))
    found, cavity = styled_cavity("effector", lone_device(make_kit_segment(effector=effector)), 0.02, fabrication)
    return mould_of("effector", found, cavity, fabrication)


def test_the_shrunk_void_is_the_designed_part(design):
    """Without draft exactly, with draft within the deviation that half the height of a wall gives."""
    stack = {layer.name: layer for layer in layers(design.segment)}
    assert {check.component for check in design.kit.cavity_checks} == {pour.component for pour in design.kit.pours}
    for check in design.kit.cavity_checks:
        effector = design.segment.effector
        domed = check.component == "effector" and effector.shape == "dome"
        assert check.deviation_mm <= check.tolerance_mm
        if check.style == "split" or domed:
            assert check.difference_mm3 < EXACT * check.designed_volume_mm3
            assert check.deviation_mm < EXACT
        else:
            aside = tan(radians(1.0)) * stack[check.component].thickness_mm / 2
            assert check.deviation_mm == pytest.approx(sqrt(2.0) * aside, rel=1e-6)
            assert check.cast_volume_mm3 == pytest.approx(check.designed_volume_mm3, rel=1e-3)


def test_a_forgotten_compensation_shows(make_kit_segment):
    """The farthest corner of a box that is larger by 1 / 0.98 lies beyond the box by that share of its diagonal."""
    fabrication = Fabrication(mould_style="split", cavities=(1, 1))
    style, cavity = styled_cavity("effector", lone_device(make_kit_segment()), 0.02, fabrication)
    check = check_cavity(mould_of("effector", style, replace(cavity, shrinkage=0.0), fabrication), fabrication)
    growth = 1.0 / 0.98 - 1.0
    assert check.deviation_mm == pytest.approx(growth * sqrt(1.25**2 + 1.25**2 + 1.0), rel=1e-6)
    grown = ((1.0 + growth) ** 3 - 1.0) * 6.25
    assert check.difference_mm3 == pytest.approx(grown, rel=0.05)  # a little of it stands in the vents


def test_a_missing_wall_shows(make_kit_segment):
    """A step of 0.1 mm in the wall of the cavity is found by the cuts."""
    fabrication = Fabrication(mould_style="open", cavities=(1, 1))
    style, cavity = styled_cavity("effector", lone_device(make_kit_segment()), 0.0, fabrication)
    mould = mould_of("effector", style, cavity, fabrication)
    notch = box((-0.2, 0.2), (1.0, 1.35), (0.3, 0.6))
    dented = replace(mould, solids={**mould.solids, "plate": mould.solids["plate"].cut(notch)})
    assert check_cavity(dented, fabrication).deviation_mm == pytest.approx(0.1, rel=1e-3)


def test_the_parts_of_a_closed_mould_do_not_overlap(mould):
    solids = list(mould.solids.values())
    for number, one in enumerate(solids):
        for other in solids[number + 1 :]:
            assert shape_volume_mm3(one.intersect(other)) < 1e-9


def test_air_leaves_every_cavity(mould):
    """The void around the cavity reaches the edge of the closed mould."""
    gang, height = mould.gang, mould.cavity.height
    inside = box((-gang.half_x, gang.half_x), (-gang.half_y, gang.half_y), (-1.0, height))
    voids = inside.cut(*mould.solids.values()).solids()
    around = next(void for void in voids if void.is_inside(Vector(0, 0, 0.9 * height)))
    assert pytest.approx(gang.half_y) == around.bounding_box().max.Y
    assert pytest.approx(-gang.half_y) == around.bounding_box().min.Y


def test_vents_leave_the_lid_and_the_floor_face_of_the_part_alone(mould):
    for notch in mould.vents:
        assert mould.cavity.height / 2 < notch.bounding_box().min.Z
        assert notch.bounding_box().min.X > 0.0 or notch.bounding_box().max.X < 0.0


def test_the_part_leaves_the_mould_without_meeting_a_wall(mould):
    part = mould.cavity.solid
    for way in (0.05, 0.4, 1.5):
        if mould.style == "open":
            assert shape_volume_mm3((Pos(0, 0, way) * part).intersect(mould.solids["plate"])) < 1e-9
        else:
            assert shape_volume_mm3(part.intersect(Pos(0, -way, 0) * mould.solids["bar-1"])) < 1e-9
            assert shape_volume_mm3(part.intersect(Pos(0, way, 0) * mould.solids["bar-2"])) < 1e-9


def test_walls_of_an_open_mould_have_their_draft(make_kit_segment):
    def least(effector, **keys):
        _, cavity = styled_cavity(
            "effector", lone_device(make_kit_segment(effector=effector)), 0.0, Fabrication(**keys)
        )
        return least_draft_deg(cavity.solid, cavity.height)

    assert least(Effector(), draft_deg=2.0) == pytest.approx(2.0, abs=1e-6)
    assert least(CYLINDER, draft_deg=2.0) == pytest.approx(2.0, abs=1e-6)
    assert least(CYLINDER, mould_style="split") == pytest.approx(0.0, abs=1e-6)
    assert least(Effector(shape="dome", diameter_mm=2.0, height_mm=1.0)) == pytest.approx(0.0, abs=1e-6)
    # the rim of a flat cap rises at the angle whose sine is (R - h) / R: R = 1.025, h = 0.8
    assert least(DOME) == pytest.approx(12.680, abs=0.01)


def test_deep_parts_get_a_split_mould_by_themselves(make_kit_segment):
    def style_of(height):
        return styled_cavity(
            "effector", lone_device(make_kit_segment(effector=Effector(height_mm=height))), 0.0, Fabrication()
        )[0]

    limit = 2 * 0.05 / sqrt(2.0) / tan(radians(1.0))
    assert [style_of(limit - 0.01), style_of(limit + 0.01)] == ["open", "split"]


def test_every_cavity_of_a_gang_is_there(make_kit_segment):
    """The plate of 1 x 2 cavities lacks two drafted boxes: h (a^2 + w^2 / 3), w = h tan(draft)."""
    fabrication = Fabrication(cavities=(1, 2), vent_depth_mm=1e-3)
    style, cavity = styled_cavity("effector", lone_device(make_kit_segment()), 0.0, fabrication)
    mould = mould_of("effector", style, cavity, fabrication)
    assert len(mould.gang.centers) == 2
    one = 6.25 + tan(radians(1.0)) ** 2 / 3.0
    assert cavity.solid.volume == pytest.approx(one, rel=1e-9)
    filled = mould.solids["plate"]
    for x, y in mould.gang.centers:
        filled = filled.fuse(Pos(x, y, 0) * cavity.solid)
    assert filled.volume - mould.solids["plate"].volume == pytest.approx(2 * one, rel=1e-6)
    apart = [hypot(a[0] - b[0], a[1] - b[1]) for a in mould.gang.centers for b in mould.gang.centers if a != b]
    assert min(apart) > cavity.size_x + 2 * fabrication.land_mm


def test_the_defaults_are_printable_on_their_printer():
    check_mould_sizes(Fabrication(), printer_profile("sla"))
