"""The printability check on parts whose thinnest place is known."""

import json
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import trimesh
from build123d import Box, Cylinder, Pos, Rot, Sphere
from matplotlib.image import imread

from export.printability import CriticalSize, check_part, draw_findings, printer_names, printer_profile
from export.printability.check import check_on_printers
from export.printability.drawing import RING_DIAMETER_IN, VIEWS, buried_mm, clearest_view
from export.printability.measure import measure
from export.printability.surface import surface_of
from export.view import picture_box, picture_page
from foundation.errors import InputError
from geometry.fabrication.part import LimitName
from tests.cases import for_each

pytestmark = pytest.mark.press

FDM, SLA = printer_profile("fdm"), printer_profile("sla")
UP = (0.0, 0.0, 1.0)


def block(x, y, z):
    """A box on the bed, its middle at x = y = 0."""
    return Pos(0, 0, z / 2) * Box(x, y, z)


def fin(thickness):
    """A wall of this thickness, 10 mm long and 6 mm high, on a block of 4 mm."""
    return (block(12, 12, 4) + Pos(0, 0, 7) * Box(thickness, 10, 6)).solid()


def pin(diameter):
    return (block(12, 12, 4) + Pos(2, 1, 7) * Cylinder(diameter / 2, 6)).solid()


def bump(diameter, height, sign=1):
    """A spherical cap on, or for sign -1 in, the top of a block of 4 mm."""
    radius = (diameter**2 / 4 + height**2) / (2 * height)
    ball = Pos(2, 1, 4 + sign * (height - radius)) * Rot(90, 0, 0) * Sphere(radius)
    return (block(12, 12, 4) + ball).solid() if sign > 0 else (block(12, 12, 4) - ball).solid()


def slotted(width):
    return (block(12, 12, 6) - Pos(1, 0, 5) * Box(width, 20, 4)).solid()


def drilled(diameter, depth):
    return (block(12, 12, 6) - Pos(1, 2, 6 - depth / 2) * Cylinder(diameter / 2, depth)).solid()


def table(x, y):
    """A plate of 2 mm on a leg of 4 mm by 4 mm, 10 mm high."""
    return (block(4, 4, 10) + Pos(0, 0, 11) * Box(x, y, 2)).solid()


def found(body, profile, **more):
    """Findings by rule."""
    return {finding.rule: finding for finding in check_part("part", body, profile, **more).findings}


def test_a_stout_block_has_no_findings():
    for profile in (FDM, SLA):
        answer = check_part("block", block(20, 10, 5), profile)
        assert answer.findings == ()
        assert answer.printable
        assert (answer.advised_process, answer.advice) == (profile.process, f"print this by {profile.process.upper()}")


@for_each(
    ("thickness", "fdm", "sla"),
    [(0.3, "error", "error"), (0.5, "error", "warning"), (0.7, "error", None), (0.8, None, None), (1.5, None, None)],
)
def test_a_thin_wall_is_measured_where_it_is(thickness, fdm, sla):
    for profile, severity in ((FDM, fdm), (SLA, sla)):
        finding = found(fin(thickness), profile).get("wall")
        assert (finding and finding.severity) == severity
        if finding:
            assert finding.value == pytest.approx(thickness, abs=1e-3)
            x, y, z = finding.place_mm
            assert abs(x) < 1e-3
            assert abs(y) <= 5.0
            assert 4.0 <= z <= 10.0


@for_each("angles", [(30, 0, 0), (10, 50, 70), (45, 45, 0)])
def test_thickness_does_not_depend_on_how_the_part_lies(angles):
    turned = Rot(*angles) * fin(0.5)
    assert measure(turned, UP).walls.length_mm[0] == pytest.approx(0.5, abs=1e-3)


def test_a_sheet_is_cast():
    answer = check_part("medium1", Box(16, 16, 0.5), FDM)
    assert answer.advised_process == "cast"
    assert answer.advice == "cast this: 0.5 mm sheet cannot be printed by FDM"
    assert not answer.printable


def test_a_thin_wall_that_is_no_sheet_goes_to_the_finer_printer():
    answer = check_part("frame", fin(0.5), FDM)
    assert answer.advised_process == "sla"
    assert answer.advice == "print this by SLA, not by FDM: a wall of 0.5 mm cannot be printed by FDM"
    assert check_part("frame", fin(0.2), FDM).advised_process == "cast"


@for_each(
    ("diameter", "fdm", "sla"),
    [(0.3, "error", "error"), (0.7, "error", None), (1.5, "warning", None), (2.1, None, None)],
)
def test_a_thin_pin_is_a_feature_and_no_wall(diameter, fdm, sla):
    for profile, severity in ((FDM, fdm), (SLA, sla)):
        findings = found(pin(diameter), profile)
        assert (findings.get("feature") and findings["feature"].severity) == severity
        assert "wall" not in findings
        if severity:
            assert findings["feature"].value == pytest.approx(diameter, abs=0.02)
            assert findings["feature"].place_mm[:2] == pytest.approx((2, 1), abs=0.05)


@for_each("sign", [1, -1])
def test_a_braille_dot_is_measured_as_a_bump_and_its_mould_as_a_dent(sign):
    findings = found(bump(1.5, 0.5, sign), FDM)
    assert findings["feature"].value == pytest.approx(1.5, abs=0.01)
    assert findings["relief"].value == pytest.approx(0.5, abs=0.01)
    assert findings["relief"].place_mm == pytest.approx((2, 1, 4 + sign * 0.5), abs=0.1)
    assert "2.5 layers" in findings["relief"].problem
    assert found(bump(1.5, 0.5, sign), SLA) == {}


def test_a_bump_lower_than_a_layer_cannot_be_printed():
    assert found(bump(1.5, 0.19), FDM)["relief"].severity == "error"
    assert found(bump(1.5, 0.21), FDM)["relief"].severity == "warning"


def test_a_slot_and_holes():
    assert found(slotted(0.3), FDM)["gap"].value == pytest.approx(0.3, abs=1e-3)
    assert found(slotted(0.3), FDM)["gap"].place_mm[0] == pytest.approx(1.0, abs=1e-3)
    assert "gap" not in found(slotted(0.5), FDM)
    for depth in (3.0, 6.0):
        hole = found(drilled(1.0, depth), FDM)["gap"]
        assert hole.value == pytest.approx(1.0, abs=0.02)
        assert hole.place_mm[:2] == pytest.approx((1, 2), abs=0.05)
        assert "hole" in hole.problem
    assert "gap" not in found(drilled(2.1, 6.0), FDM)
    assert "gap" not in found(drilled(1.0, 6.0), SLA)


def test_the_ground_between_four_posts_is_no_hole():
    posts = [Pos(x, y, 4.5) * Cylinder(0.775, 1) for x in (0, 2.4) for y in (0, 2.4)]
    assert "gap" not in found((block(12, 12, 4) + posts).solid(), FDM)


def test_an_underside_is_measured_in_the_orientation_of_the_printer():
    finding = found(table(12, 8), FDM)["overhang"]
    assert finding.value == pytest.approx(12 * 8 - 4 * 4, rel=1e-6)
    assert finding.place_mm[2] == pytest.approx(10.0)
    assert finding.severity == "warning"
    assert "overhang" not in found(table(12, 8), FDM, up=(0.0, 0.0, -1.0))


@for_each(("slope", "needs_support"), [(40.0, True), (50.0, False)])
def test_a_slope_steeper_than_the_limit_holds_itself(slope, needs_support):
    run = 10.0
    rise = run * np.tan(np.radians(slope))
    # a prism in x-z that leans over by the run, 10 mm deep
    corners = np.array([[0, 0], [6, 0], [6 + run, rise], [6 + run, rise + 5], [0, rise + 5]])
    section = [[0, 1, 2], [0, 2, 4], [2, 3, 4]]
    wedge = trimesh.creation.extrude_triangulation(corners, section, 10.0)
    findings = found(wedge, FDM, up=(0.0, 1.0, 0.0))
    assert ("overhang" in findings) == needs_support
    if needs_support:
        assert findings["overhang"].value == pytest.approx(10.0 * run / np.cos(np.radians(slope)))


def test_a_part_may_be_turned_on_the_bed_but_not_be_larger():
    assert "size" not in found(block(200, 240, 10), FDM)
    finding = found(block(240, 240, 10), FDM)["size"]
    assert (finding.value, finding.limit) == (240.0, 210.0)
    assert found(block(20, 20, 210), FDM)["size"].limit == 200.0
    answer = check_part("rail", block(300, 20, 10), FDM)
    assert answer.advised_process == "split"
    assert "at most 250 mm" in answer.advice


def test_a_size_that_must_come_out_right():
    sizes = [CriticalSize("bore", 5.0, 0.1, (1.0, 2.0, 3.0)), CriticalSize("length", 20.0, 0.5, (0.0, 0.0, 0.0))]
    answer = check_part("part", block(20, 10, 5), FDM, sizes)
    assert [finding.rule for finding in answer.findings] == ["tolerance"]
    assert answer.findings[0].place_mm == (1.0, 2.0, 3.0)
    assert "bore of 5 mm may be off by 0.1 mm" in answer.findings[0].problem
    assert answer.printable


def test_a_hole_in_the_surface_is_found_at_its_place():
    surface = trimesh.creation.box((10, 10, 10)).subdivide()
    lost = 7
    edges = surface.triangles[lost]
    surface.update_faces(np.arange(len(surface.faces)) != lost)
    answer = check_part("part", surface, SLA)
    assert [finding.rule for finding in answer.findings] == ["manifold"]
    assert answer.findings[0].value == 3
    middles = (edges + np.roll(edges, -1, axis=0)) / 2
    assert np.linalg.norm(middles - answer.findings[0].place_mm, axis=1).min() < 1e-9
    assert answer.advised_process == "repair"


def test_a_surface_that_faces_inwards_is_refused():
    surface = trimesh.creation.box((10, 10, 10))
    surface.invert()
    finding = found(surface, SLA)["manifold"]
    assert "inwards" in finding.problem
    assert finding.value < 0


def test_findings_come_worst_first_and_fit_into_json():
    answer = check_part("part", (fin(0.5) + Pos(0, 0, 11) * Box(12, 8, 2)).solid(), FDM)
    assert [finding.severity for finding in answer.findings] == ["error", "warning"]
    assert [finding.rule for finding in answer.findings] == ["wall", "overhang"]
    words = json.loads(json.dumps(answer.as_dict()))
    assert words["printable"] is False
    assert words["findings"][0]["place_mm"] == list(answer.findings[0].place_mm)


def test_several_printers_answer_as_each_alone():
    body = pin(1.5)
    assert check_on_printers("part", body, (FDM, SLA)) == (check_part("part", body, FDM), check_part("part", body, SLA))


@for_each("name", printer_names())
def test_every_number_of_a_profile_has_a_source_and_a_confidence(name):
    profile = printer_profile(name)
    assert set(profile.limits) == set(get_args(LimitName))
    for limit in profile.limits.values():
        assert limit.value > 0
        assert limit.source
        assert limit.confidence in ("high", "medium", "low")
    assert profile["supported_wall_mm"] <= profile["wall_mm"]


def test_the_table_holds_both_processes_and_says_which_names_it_knows():
    assert {printer_profile(name).process for name in printer_names()} == {"fdm", "sla"}
    with pytest.raises(InputError, match="--printer = 'xyz': no such printer profile; known are fdm, sla"):
        printer_profile("xyz")


def test_the_picture_is_drawn_from_where_the_place_is_seen():
    surface = surface_of(table(12, 8))
    under = np.array([[4.0, 0.0, 10.0]])
    assert clearest_view(surface, under).elevation_deg < 0
    assert clearest_view(surface, np.array([[4.0, 0.0, 12.0]])).elevation_deg > 0
    for side in (-1, 1):
        assert clearest_view(surface, np.array([[side * 6.0, 0.0, 11.0]])).axes[2][0] * side > 0
    assert buried_mm(surface, under, clearest_view(surface, under)) == pytest.approx(0.0, abs=1e-6)
    # straight through the plate: 2 mm of it, seen at 40 degrees
    assert buried_mm(surface, under, VIEWS[0]) == pytest.approx(2.0 / np.sin(np.radians(40.0)))


def test_the_picture_marks_the_place(tmp_path):
    """A red ring lies around the place of the error, and nothing else is red but its number."""
    body = fin(0.3)
    answer = check_part("fin", body, FDM)
    surface, places = surface_of(body), np.array([answer.findings[0].place_mm])
    view = clearest_view(surface, places)
    _, axes, _ = picture_page(picture_box(view.flat(surface.vertices)), "")
    x, y = axes.transData.transform(view.flat(places)[0])
    pixels = imread(draw_findings(body, answer, tmp_path / "fin.png"))[:, :1100, :3]  # the list is at the right
    red = np.abs(pixels - np.array([0xB5, 0x26, 0x3B]) / 255).max(axis=2) < 0.02
    rows, columns = np.nonzero(red)
    distance = np.hypot(columns - x, pixels.shape[0] - rows - y)
    ring = (distance > 0.5 * RING_DIAMETER_IN * 200 - 4) & (
        distance < 0.5 * RING_DIAMETER_IN * 200 + 4
    )  # 200 pixels an inch
    assert ring.sum() > 300
    assert distance.max() < 90  # the number stands beside it


def test_the_table_of_the_documents_is_that_of_the_profiles():
    text = (Path(__file__).parents[2] / "docs" / "printability.md").read_text("utf-8")
    for limit in get_args(LimitName):
        cells = " | ".join(f"{p[limit]:g} ({p.limits[limit].confidence})" for p in (FDM, SLA))
        assert f"| `{limit}` | {cells} |" in text
