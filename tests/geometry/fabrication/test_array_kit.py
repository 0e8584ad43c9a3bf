"""The solids of an array's kit: moulds hold its layers, the grid its segments, the locator its effectors."""

from functools import cache

import pytest
import trimesh

from export.cad import write_stl
from foundation.errors import InputError
from geometry.array.layout import array_layout
from geometry.array.parameters import Array, Groove
from geometry.array.parts import array_parts
from geometry.dot_at_rest import resolve_dot
from geometry.fabrication.clamp_frame import frame_parts
from geometry.fabrication.device import Device, array_device, lone_device
from geometry.fabrication.kit import jig_device, jig_parts, solid_kit, stacked_tops
from geometry.fabrication.parameters import CastingNumbers, Fabrication
from geometry.fabrication.part import box, shape_volume_mm3
from geometry.flat.flat_kit import flat_kit
from geometry.parameters import Dot, Effector, Film, Medium, Segment
from tests.cases import for_each

pytestmark = pytest.mark.press

OWN = CastingNumbers(shrinkage_percent=2.0, density_g_cm3=1.1)
"""Shrinks ten times as much as silicone, so that a forgotten compensation shows."""
DOME = Effector(shape="dome", diameter_mm=1.6, height_mm=0.6, material="own")
LAYER = Effector(material="own")
GLUE, AIR, DOT = 0.05, 0.3, Dot(standard="marburg-medium")
GRID = {"grid_layers": ("effector", "medium1", "film"), "shared": ("film", "medium2")}
GROOVE = {"grooves": (Groove(layer="medium2", width_mm=0.5, depth_mm=1.4),)}


def a_device(array=None, size=2.3, made=None, **segment) -> Device:
    soft = {"medium1": Medium(thickness_mm=0.5, material="own"), "medium2": Medium(thickness_mm=2.0, material="own")}
    tables = {"boundary": "free", "effector": LAYER, "film": Film(thickness_um=28.0), **soft, **segment}
    layout = array_layout(Array(**(array or {})), Segment(length_mm=size, width_mm=size, **tables), DOT)
    return array_device(layout, fabrication(**(made or {})))


def fabrication(**keys) -> Fabrication:
    return Fabrication(casting={"own": OWN}, **keys)


ARRAYS = {
    "cell": ({}, {}),
    "grid": ({"columns": 1, "rows": 2, **GRID}, {"size": 2.0}),
    "domes over grooves": ({"rows": 2, **GROOVE}, {"effector": DOME}),
    "cell in a grid": (GRID, {"size": 2.0}),
    "only the film runs through": ({"columns": 3, "rows": 1, "shared": ("film",)}, {"made": {"cable_exit": "+y"}}),
    "held all around": ({"columns": 2, "rows": 2}, {"boundary": "clamped", "held_layers": ("medium1", "film")}),
}


@cache
def kit_of(name):
    device, made = device_of(name)
    return device, solid_kit(device, made)


def device_of(name):
    array, more = ARRAYS[name]
    return a_device(array, **more), fabrication(**more.get("made", {}))


@pytest.fixture(scope="module", params=list(ARRAYS))
def kit(request):
    return kit_of(request.param)


def designed_volumes(device):
    """Of each layer, from the solids that softdot array writes."""
    dot = resolve_dot(DOT, device.layout.whole)
    found: dict[str, float] = {}
    for part in array_parts(device.layout, dot):
        name = part.label.rpartition("-")[2]
        found[name] = found.get(name, 0.0) + part.volume_mm3
    return found


def test_castings_have_the_volume_of_the_arrays_layers(kit):
    """What the shrunk voids hold, as many of them as there are pieces, is what the simulated array is made of."""
    device, solids = kit
    volumes = designed_volumes(device)
    assert {check.component for check in solids.cavity_checks} == {"effector", "medium1", "medium2"}
    for check in solids.cavity_checks:
        pieces = device.piece_count(check.component)
        assert pieces * check.designed_volume_mm3 == pytest.approx(volumes[check.component], rel=1e-6)
        assert pieces * check.cast_volume_mm3 == pytest.approx(volumes[check.component], rel=2e-3)
        assert check.deviation_mm <= check.tolerance_mm


def test_one_pour_makes_the_pieces_of_one_array(kit):
    device, solids = kit
    for pour in solids.pours:
        assert pour.cavities == device.piece_count(pour.component)


def test_grooves_are_ridges_in_the_mould():
    """Grooves take w d (sum of lengths) less their crossings; the ridges stand where the grooves will be."""
    device, solids = kit_of("domes over grooves")
    check = next(one for one in solids.cavity_checks if one.component == "medium2")
    half_x, half_y = device.layout.half_mm
    along_y, along_x = (len(device.layout.seams(axis)) for axis in (0, 1))
    area = 0.5 * (along_y * 2 * half_y + along_x * 2 * half_x) - along_x * along_y * 0.5**2
    assert check.designed_volume_mm3 == pytest.approx(4 * half_x * half_y * 2.0 - 1.4 * area)
    plate = next(part for part in solids.parts if part.label == "mould-medium2-plate").solid
    ridge = box((-0.2, 0.2), (-1.0, 1.0), (0.0, 1.39))
    assert shape_volume_mm3(plate.intersect(ridge)) == pytest.approx(ridge.volume)


def test_every_part_is_one_closed_solid(kit, tmp_path):
    _, solids = kit
    assert len({part.label for part in solids.parts}) == len(solids.parts)
    for part in solids.parts:
        assert part.solid.is_valid
        write_stl(part, tmp_path / f"{part.label}.stl")
        surface = trimesh.load(tmp_path / f"{part.label}.stl")
        assert surface.is_volume
        assert surface.body_count == 1
        assert surface.volume == pytest.approx(part.volume_mm3, rel=3e-3)


def test_no_layer_overlaps_frame_or_base(kit):
    device, solids = kit
    holders = [part for part in solids.parts if part.label.startswith(("frame", "base"))]
    assert holders
    for name in ("medium2", "film", "medium1", "effector"):
        for piece in device.solids(name):
            assert all(shape_volume_mm3(part.solid.intersect(piece)) < 1e-9 for part in holders)


def test_the_grid_is_a_glue_line_away_from_every_segment():
    """On all four sides of each: a piece that is wider by the glue touches the bars, one that is not does not."""
    device, solids = kit_of("grid")
    ring = next(part for part in solids.parts if part.label == "frame-ring").solid
    for name in ("medium1", "effector"):
        for piece in device.solids(name):
            assert ring.distance_to(piece) == pytest.approx(GLUE)
    for x, y in device.layout.middles:
        for way in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            beside = [(x - 0.5, x + 0.5), (y - 0.5, y + 0.5), (2.1, 3.5)]
            for axis, side in enumerate(way):
                if side:
                    edge = (x, y)[axis] + side * (1.0 + GLUE)
                    beside[axis] = (edge, edge + 0.1) if side > 0 else (edge - 0.1, edge)
            wall = box(*beside)
            assert shape_volume_mm3(ring.intersect(wall)) == pytest.approx(wall.volume)


def test_the_film_is_bonded_to_the_bars_of_the_grid():
    """The upper ring of adhesive has a window for each opening of the frame's ring, the lower one a single window."""
    device, _ = kit_of("grid")
    patterns = {one.name: one for one in flat_kit(device, fabrication()).patterns}
    upper, lower = (
        [cut for cut in patterns[f"adhesive-flange-{side}"].cuts if cut.hole and not hasattr(cut, "radius")]
        for side in ("upper", "lower")
    )
    assert [window.area_mm2 for window in upper] == pytest.approx([(2.0 + 2 * GLUE) ** 2] * 2)
    half_x, half_y = device.layout.half_mm
    assert [window.area_mm2 for window in lower] == pytest.approx([4 * (half_x + AIR) * (half_y + AIR)])


def test_medium_2_that_runs_through_a_grid_has_one_opening_with_air():
    device, solids = kit_of("grid")
    body = next(part for part in solids.parts if part.label == "frame-body").solid
    half_x, half_y = device.layout.half_mm
    inside = box((-half_x - AIR, half_x + AIR), (-half_y - AIR, half_y + AIR), (0.0, 2.0))
    assert shape_volume_mm3(body.intersect(inside)) < 1e-9


def test_the_film_with_its_traces_lies_on_the_frame():
    """The frame reaches as far as the film, which goes around the array with its traces."""
    device, made = device_of("held all around")
    film = flat_kit(device, made).layout
    body = next(part for part in frame_parts(device, made) if part.label == "frame-body").solid.bounding_box()
    assert -film.back_end >= body.min.X
    assert film.half_body <= body.max.Y


def test_the_locator_centres_every_dome():
    device, solids = kit_of("domes over grooves")
    (locator,) = [part.solid for part in solids.parts if part.label == "jig-locator"]
    assert set(stacked_tops(device, fabrication())) == {"medium1", "effector"}
    for x, y in device.layout.middles:
        foot = box((x - 0.01, x + 0.01), (y - 0.01, y + 0.01), (0.6, 1.0))
        assert locator.distance_to(foot) == pytest.approx(0.8 + GLUE - 0.01 * 2**0.5, abs=2e-3)


def test_islands_in_a_grid_are_stacked_one_segment_at_a_time():
    grid, _ = device_of("grid")
    assert len(jig_device(grid, fabrication()).layout.places) == 1
    whole, _ = device_of("cell")
    assert jig_device(whole, fabrication()) is whole


@for_each("name", ["cell", "only the film runs through"])
def test_islands_and_spacers_fill_the_array(name):
    """Along each direction: the islands and the strips between them; notches as wide as the strip that they take."""
    device, made = device_of(name)
    strips = [one for one in flat_kit(device, made).patterns if one.name.startswith("spacer")]
    columns, rows = len(device.layout.centres(0)), len(device.layout.centres(1))
    counts = {one.name: one.count for one in strips}
    assert counts == {key: count for key, count in (("spacer-y", columns - 1), ("spacer-x", rows - 1)) if count}
    for axis, key in ((0, "spacer-y"), (1, "spacer-x")):
        for strip in (one for one in strips if one.name == key):
            assert 2.3 * (columns, rows)[axis] + strip.thickness_mm * strip.count == pytest.approx(
                2 * device.layout.half_mm[axis]
            )
            (cut,) = strip.cuts
            crossing = (rows, columns)[axis] - 1
            length, tall = 2 * device.layout.half_mm[1 - axis], max(y for _, y in cut.points)
            assert cut.area_mm2 == pytest.approx(length * tall - crossing * 0.2 * tall / 2)


def test_a_single_segment_is_an_array_of_one(make_kit_segment):
    """Whose layers all run through: base and jig are those of the segment itself, and so is what is cast."""
    segment, made = make_kit_segment(boundary="free"), fabrication()
    shared = Array(columns=1, rows=1, shared=("effector", "medium1", "film", "medium2"))
    one, alone = array_device(array_layout(shared, segment, DOT), made), lone_device(segment)
    for make in (frame_parts, jig_parts):
        pairs = zip(make(one, made), make(alone, made), strict=True)
        assert all(a.label == b.label and a.volume_mm3 == pytest.approx(b.volume_mm3) for a, b in pairs)
    for name in ("effector", "medium1", "medium2"):
        assert one.piece_count(name) == alone.piece_count(name) == 1
        assert one.piece(name).volume == pytest.approx(alone.piece(name).volume)


WIDE_DOME = Effector(shape="dome", diameter_mm=2.1, height_mm=0.6, material="own")
REFUSED = {
    "bars of the grid": (GRID, {}, {}, r"array.grid_layers = .* bars of 0.1 mm, below the SLA.*at most 2 mm wide"),
    "ridge": (
        {"grooves": (Groove(layer="medium2", width_mm=0.3, depth_mm=1.0),)}, {}, {},
        r"array.grooves\[0\].width_mm = 0.3: its mould has a ridge of 0.3 mm, below the SLA limit .* 0.4 mm",
    ),
    "web": (
        {"grooves": (Groove(layer="medium2", width_mm=0.5, depth_mm=1.9),)}, {}, {},
        r"array.grooves\[0\].depth_mm = 1.9: leaves a web of medium2 of 0.1 mm",
    ),
    "ridge at the lid": (GROOVE, {}, {"lid_face": "top"}, r"lid_face = 'top': the ridges .*use 'base'"),
    "split mould with ridges": (GROOVE, {}, {"mould_style": "split"}, r"grooves\[0\].layer = 'medium2': .*open mould"),
    "grooves in a sheet": (GROOVE, {}, {"routes": {"medium2": "sheet"}}, r"grooves: names 'medium2', which is cut"),
    "walls of the locator": ({}, {"effector": WIDE_DOME}, {}, r"effector: .* walls between the holes .* 0.3 mm"),
    "film under bars": (
        {"grid_layers": ("film",)}, {}, {}, r"array.grid_layers = \['film'\]: the bars .* would cut medium1"
    ),
    "leads wider than a short side": (
        {"columns": 20, "rows": 1}, {}, {}, r"tab_width_mm = 12.6: must be at most 12.*cable leave on a longer side"
    ),
    "far too many": ({"columns": 8, "rows": 8}, {}, {}, r"margin_mm = 0: .* 0 traces .* no margin is enough, so give"),
}  # fmt: skip


@for_each(("array", "segment", "made", "sentence"), REFUSED.values(), ids=REFUSED)
def test_arrays_that_cannot_be_made_are_refused(array, segment, made, sentence):
    def make():
        device = a_device(array, made=made, **segment)
        flat_kit(device, fabrication(**made))
        solid_kit(device, fabrication(**made))

    with pytest.raises(InputError, match=sentence) as refused:
        make()
    assert "\n" not in str(refused.value)
