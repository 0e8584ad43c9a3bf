"""The film of an array: every electrode has a pad of its own, and no metal comes near to other metal."""

from itertools import combinations
from math import pi

import numpy as np
import pytest
from matplotlib.path import Path

from foundation.errors import InputError
from geometry.array.layout import array_layout
from geometry.array.parameters import Array
from geometry.fabrication.device import array_device
from geometry.fabrication.parameters import Fabrication
from geometry.flat.electrodes import stray_area_mm2
from geometry.flat.escape import Lattice
from geometry.flat.flat_kit import flat_kit
from geometry.parameters import Dot, Effector, Film, Medium, Segment
from geometry.polygons import shared_area_mm2
from tests.cases import for_each

FINE = {"trace_width_mm": 0.1, "trace_gap_mm": 0.05, "kerf_mm": 0.02}
ARRAYS = {
    "cell": ({}, {}),
    "cell, cable at -y": ({}, {"cable_exit": "-y"}),
    "cell, ZIF": ({}, {"cable_exit": "-x", "pad_pitch_mm": 1.0}),
    "two cells": ({"cells": 2}, {"cable_exit": "+y"}),
    "row of five": ({"columns": 5, "rows": 1}, {"cable_exit": "+y"}),
    "column of four, one behind the other": ({"columns": 1, "rows": 4}, {"cable_exit": "+y", **FINE}),
    "three by three": ({"columns": 3, "electrode_margin_mm": 0.25}, {}),
    "clamped": ({"columns": 3, "electrode_margin_mm": 0.25}, {"film_flange_mm": 1.0}),
    "narrow electrodes": ({"columns": 1, "rows": 3, "electrode_margin_mm": 0.8}, {}),
    "five by five": ({"columns": 5, "rows": 5, "electrode_margin_mm": 0.2}, {"cable_exit": "-y", **FINE}),
    "six by three": ({"columns": 6, "electrode_margin_mm": 0.3}, FINE),
}  # fmt: skip


def film_of(array, made, boundary="free"):
    segment = Segment(
        length_mm=2.3, width_mm=2.3, boundary=boundary, effector=Effector(), medium1=Medium(thickness_mm=0.5),
        film=Film(thickness_um=28.0), medium2=Medium(thickness_mm=2.0),
    )  # fmt: skip
    fabrication = Fabrication(**made)
    layout = array_layout(Array(**array), segment, Dot(standard="marburg-medium"))
    return layout, flat_kit(array_device(layout, fabrication), fabrication)


@pytest.fixture(scope="module", params=ARRAYS)
def film(request):
    array, made = ARRAYS[request.param]
    return *film_of(array, made, "clamped" if request.param == "clamped" else "free"), Fabrication(**made)


def lines(points):
    """Start and end of each side of a closed polygon, (n, 2) each."""
    start = np.array(points)
    return start, np.roll(start, -1, axis=0)


def clearance(one, other):
    """Least distance of the outlines of two polygons, 0 where they cross."""
    (a, b), (c, d) = lines(one), lines(other)
    a_, b_, c_, d_ = a[:, None], b[:, None], c[None], d[None]
    crossing = (_side(a_, b_, c_) * _side(a_, b_, d_) < 0) & (_side(c_, d_, a_) * _side(c_, d_, b_) < 0)
    if crossing.any():
        return 0.0
    return min(_to_lines(a, c, d), _to_lines(c, a, b))


def _side(p, q, r):
    """Positive where r lies to the left of the way from p to q."""
    return (q - p)[..., 0] * (r - p)[..., 1] - (q - p)[..., 1] * (r - p)[..., 0]


def _to_lines(points, start, end):
    way = end - start
    share = ((points[:, None] - start) * way).sum(-1) / (way**2).sum(-1)
    foot = start + np.clip(share, 0.0, 1.0)[..., None] * way
    return float(np.linalg.norm(points[:, None] - foot, axis=-1).min())


def test_traces_keep_their_clearance_from_each_other_and_from_all_electrodes(film):
    """Measured between the cut lines themselves."""
    _, kit, made = film
    *tops, _ = kit.metals
    nearest = min(clearance(one.outline.points, other.outline.points) for one, other in combinations(tops, 2))
    assert nearest > made.trace_gap_mm - 1e-9


def test_no_outline_contains_another(film):
    _, kit, _ = film
    *tops, _ = kit.metals
    for one, other in combinations(tops, 2):
        assert not Path(one.outline.points).contains_point(other.outline.points[0])
        assert not Path(other.outline.points).contains_point(one.outline.points[0])


def test_every_electrode_has_exactly_one_pad(film):
    """The metal around the middle of an electrode reaches the middle of one pad, and of its own electrode alone."""
    layout, kit, _ = film
    *tops, common = kit.metals
    assert {metal.name for metal in tops} == {place.label for place in layout.places}
    end = kit.layout.tab_end + kit.layout.taper + 2.0
    pads = [(end, v) for v in kit.layout.pads]
    found = []
    for metal in kit.metals:
        reached = Path(metal.outline.points).contains_points(pads)
        assert reached.sum() == 1
        found.append(int(np.flatnonzero(reached)[0]))
        own = [name for name, (u0, u1, v0, v1) in kit.layout.electrodes.items()
               if Path(metal.outline.points).contains_point(((u0 + u1) / 2, (v0 + v1) / 2))]  # fmt: skip
        assert own == (list(kit.layout.electrodes) if metal is common else [metal.name])
    assert sorted(found) == list(range(len(kit.metals)))
    assert [kit.layout.pad_count - metal.pad for metal in kit.metals] == found


def test_electrodes_lie_on_their_segments(film):
    """In the drawing, which is in the axes of the array whatever the exit."""
    layout, kit, _ = film
    size = [length - 2 * layout.array.electrode_margin_mm for length in layout.size_mm]
    for metal, mark in zip(kit.metals, kit.patterns[0].marks, strict=False):
        if metal.face == "top":
            place = next(place for place in layout.places if place.label == metal.name)
            corners = [
                (place.x_mm + x * size[0] * 0.4999, place.y_mm + y * size[1] * 0.4999) for x in (-1, 1) for y in (-1, 1)
            ]
            assert Path(mark.points).contains_points(corners).all()
            u0, u1, v0, v1 = metal.rect
            assert (u1 - u0) * (v1 - v0) == pytest.approx(size[0] * size[1])


def test_the_common_electrode_lies_under_all_electrodes_and_under_no_trace(film):
    _, kit, _ = film
    *tops, common = kit.metals
    for metal in tops:
        (plate,) = metal.plates
        u0, u1, v0, v1 = metal.rect
        assert sum(shared_area_mm2(plate, one) for one in common.plates) == pytest.approx((u1 - u0) * (v1 - v0))
    assert stray_area_mm2(kit.metals) < 1e-9


def test_all_metal_stays_on_the_film(film):
    """Each corner on it or on its edge, which a free array's electrodes reach; pads 0.15 mm inside."""
    _, kit, _ = film
    edge = next(cut for cut in kit.patterns[0].cuts[::-1] if not hasattr(cut, "radius")).points
    for mark in kit.patterns[0].marks[: len(kit.metals)]:
        corners = np.array(mark.points)
        on_edge = [_to_lines(corner[None], *lines(edge)) < 1e-9 for corner in corners]
        assert (Path(edge).contains_points(corners) | on_edge).all()
    for metal in kit.metals:
        u, v = np.array(metal.outline.points).T
        assert np.abs(v[u > kit.layout.tab_end]).max() <= kit.layout.half_head - 0.15
        assert u.max() == pytest.approx(kit.layout.tab_end + kit.layout.head_length - 0.15)


def test_pads_lie_at_the_pitch_of_their_connector(film):
    _, kit, made = film
    pads = kit.layout.pads
    assert np.diff(pads) == pytest.approx(np.full(len(pads) - 1, made.pad_pitch_mm))
    assert sum(pads) == pytest.approx(0.0)


def test_masks_have_the_windows_of_the_layout(film):
    """One window for each top electrode and one below; panels with the same two holes for the pins."""
    layout, kit, _ = film
    by_name = {pattern.name: pattern for pattern in kit.patterns}
    for name, count in (("mask-top", len(layout.places)), ("mask-bottom", 1)):
        windows = [cut for cut in by_name[name].cuts if cut.hole and not hasattr(cut, "radius")]
        assert len(windows) == count
    metal = sum(one.outline.area_mm2 for one in kit.metals if one.face == "top")
    top = [cut for cut in by_name["mask-top"].cuts if cut.hole and not hasattr(cut, "radius")]
    assert sum(window.area_mm2 for window in top) == pytest.approx(metal)
    holes = {tuple(cut for cut in by_name[name].cuts if hasattr(cut, "radius")) for name in ("film", "mask-top")}
    assert len(holes) == 1
    assert [hole.area_mm2 for hole in holes.pop()] == pytest.approx(2 * [pi * 3.3**2 / 4])


def squares(count, gap, ranks=3):
    """Electrodes of 2 mm in files that are gap apart."""
    return {
        f"r{rank}f{file}": (3.0 * rank, 3.0 * rank + 2.0, (2.0 + gap) * file, (2.0 + gap) * file + 2.0)
        for rank in range(ranks)
        for file in range(count)
    }


@for_each("traces", [1, 2, 3])
def test_a_gap_takes_as_many_traces_as_it_is_wide_for(traces):
    """n traces of w and n + 1 gaps of g beside them."""
    exact = traces * 0.3 + (traces + 1) * 0.2
    for gap, room in ((exact, traces), (exact - 1e-3, traces - 1)):
        assert Lattice(squares(3, gap), 0.3, 0.2, 0.0).channel_rooms[1:-1] == [room, room]


def test_a_trace_of_a_farthest_electrode_goes_around_where_the_gaps_are_full():
    """Of three files the middle one: through the gap where there is room, else behind and beside all others."""
    around, through = (Lattice(squares(3, gap, ranks=2), 0.3, 0.2, 0.0) for gap in (0.5, 0.7))
    assert around.width_behind == pytest.approx(0.5)
    assert around.width_beside == pytest.approx(1.0)
    assert (through.width_behind, through.width_beside) == (0.0, pytest.approx(0.5))


@for_each(
    ("array", "made", "sentence"),
    [
        (
            {"columns": 3}, {},
            r"array.electrode_margin_mm = 0: .* a gap of 0.2 mm between electrodes takes 0 traces of 0.3 mm .*, and 1 "
            r"must pass; must be at least 0.25",
        ),
        ({"columns": 3, "electrode_margin_mm": 0.249}, {}, r"takes 0 traces of 0.3 mm .* must be at least 0.25"),
        ({"pitch_mm": 2.4}, {}, r"margin_mm = 0: 'segment-r1c1' and 'segment-r1c2' are 0.1 mm apart.*give 0.05"),
        ({}, {"tab_width_mm": 4.0}, r"tab_width_mm = 4: leaves 7 leads of 0.271 mm.*must be at least 4.2"),
        ({}, {"array": (1, 2)}, r"fabrication.array = \[1, 2\]: .* leave it out"),
        ({}, {"pitch_mm": 9.0}, r"fabrication.pitch_mm = 9.0: .* leave it out"),
        ({"shared": ("medium2",)}, {}, r"array.shared = \['medium2'\]: no trace leads out of a film that is an island"),
        (
            {"electrode_margin_mm": 0.6}, {"trace_width_mm": 1.0, "trace_gap_mm": 0.05},
            r"trace_width_mm = 1: leaves a bridge of 0.05 mm in the common electrode",
        ),
    ],
)  # fmt: skip
def test_traces_that_cannot_be_led_out_are_refused(array, made, sentence):
    with pytest.raises(InputError, match=sentence) as refused:
        film_of(array, made)
    assert "\n" not in str(refused.value)


def test_electrodes_of_0_25_mm_margin_let_one_trace_through():
    """0.2 + 2 x 0.25 mm of gap: 0.2, a trace of 0.3, 0.2."""
    _, kit = film_of({"columns": 3, "electrode_margin_mm": 0.25}, {})
    assert len(kit.metals) == 10
