"""DXF and SVG read back by other programs: units, layers and lengths."""

from xml.etree import ElementTree as Xml

import ezdxf
import numpy as np
import pytest
from svgpathtools import parse_path

from export.cut_files.dxf import draw_cut_file
from export.cut_files.folder import write_cut_files
from export.cut_files.style import STYLES
from geometry.fabrication.device import lone_device
from geometry.fabrication.parameters import Fabrication
from geometry.flat.flat_kit import flat_kit
from geometry.parameters import Film, Medium, Segment
from tests.cases import for_each

SVG = "{http://www.w3.org/2000/svg}"
KERF = 0.2


@pytest.fixture(scope="module")
def patterns():
    sponge = Medium(thickness_mm=2.0, material="sponge")
    segment = Segment(medium1=Medium(thickness_mm=0.5), film=Film(thickness_um=28.0), medium2=sponge)
    return {p.name: p for p in flat_kit(lone_device(segment), Fabrication(kerf_mm=KERF)).patterns}


@pytest.fixture(scope="module")
def folder(patterns, tmp_path_factory):
    out = tmp_path_factory.mktemp("kit") / "cut"
    write_cut_files(list(patterns.values()), out)
    return out


def dxf_lengths(document, layer):
    """Length of every closed line of a layer, as ezdxf measures it."""
    found = []
    for one in document.modelspace().query(f'*[layer=="{layer}"]'):
        if one.dxftype() == "CIRCLE":
            found.append(2 * np.pi * one.dxf.radius)
        elif one.dxftype() == "LWPOLYLINE" and one.closed:
            points = np.array(one.get_points("xy"))
            found.append(np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum())
    return found


def svg_lengths(root, layer):
    """Length of every closed line of a group, as svgpathtools measures it."""
    group = next(g for g in root.iter(f"{SVG}g") if g.get("id") == layer)
    paths = [parse_path(p.get("d")) for p in group.iter(f"{SVG}path")]
    circles = [2 * np.pi * float(c.get("r")) for c in group.iter(f"{SVG}circle")]
    return [path.length() for path in paths if path.isclosed()] + circles


def expected(pattern):
    """Right angles: the perimeter grows by 8 half kerfs outside and shrinks by as much in holes; circles by 2 pi."""
    lengths = []
    for cut in pattern.cuts:
        per_half_kerf = 2 * np.pi if hasattr(cut, "radius") else 8.0
        lengths.append(cut.length_mm + (-1 if cut.hole else 1) * per_half_kerf * KERF / 2)
    return lengths


@for_each("name", ["film", "adhesive-flange-lower", "adhesive-base-medium2", "sheet-medium2"])
def test_cut_lines_read_back_have_the_right_lengths(patterns, folder, name):
    wanted = sorted(expected(patterns[name]))
    assert sorted(dxf_lengths(ezdxf.readfile(folder / f"{name}.dxf"), "CUT")) == pytest.approx(wanted)
    assert sorted(svg_lengths(Xml.parse(folder / f"{name}.svg").getroot(), "CUT")) == pytest.approx(wanted)


def test_medium_of_2_5_mm_is_cut_at_2_7_with_a_kerf_of_0_2(folder):
    (square,) = ezdxf.readfile(folder / "sheet-medium2.dxf").modelspace().query("LWPOLYLINE[layer=='CUT']")
    assert np.ptp(np.array(square.get_points("xy")), axis=0) == pytest.approx([2.7, 2.7])


def test_metal_is_not_compensated(patterns, folder):
    document = ezdxf.readfile(folder / "film.dxf")
    for layer in ("ELECTRODE-TOP", "ELECTRODE-BOTTOM"):
        outline = next(mark for mark in patterns["film"].marks if mark.layer == layer)
        assert dxf_lengths(document, layer) == pytest.approx([outline.length_mm])
        assert svg_lengths(Xml.parse(folder / "film.svg").getroot(), layer) == pytest.approx([outline.length_mm])


def test_files_say_millimetres_and_name_their_layers(patterns, folder):
    for name in patterns:
        document = ezdxf.readfile(folder / f"{name}.dxf")
        assert document.units == ezdxf.units.MM
        assert set(STYLES) <= {layer.dxf.name for layer in document.layers}
        assert len(document.audit().errors) == 0
        root = Xml.parse(folder / f"{name}.svg").getroot()
        box = [float(number) for number in root.get("viewBox").split()]
        assert [root.get("width"), root.get("height")] == [f"{box[2]:g}mm", f"{box[3]:g}mm"]
        assert [group.get("id") for group in root.iter(f"{SVG}g")] == list(STYLES)


def test_sizes_on_the_drawing_are_those_of_the_finished_part(patterns, folder):
    drawn = [one.get_measurement() for one in ezdxf.readfile(folder / "film.dxf").modelspace().query("DIMENSION")]
    assert sorted(drawn) == pytest.approx(sorted(size.length_mm for size in patterns["film"].dimensions))
    assert {1.6, 11.2, 6.15, 3.3} <= {round(size, 6) for size in drawn}
    texts = {text.text for text in Xml.parse(folder / "film.svg").getroot().iter(f"{SVG}text")}
    assert {"1.6", "11.2", "6.15", "3.3"} <= texts


def test_up_in_the_drawing_is_up_in_the_svg(folder):
    """y of an SVG runs down: the lead of the top electrode lies above that of the bottom one in both files."""
    root = Xml.parse(folder / "film.svg").getroot()
    middle = {}
    for layer in ("ELECTRODE-TOP", "ELECTRODE-BOTTOM"):
        group = next(g for g in root.iter(f"{SVG}g") if g.get("id") == layer)
        middle[layer] = np.mean([c.start.imag for c in parse_path(next(group.iter(f"{SVG}path")).get("d"))])
    assert middle["ELECTRODE-TOP"] < middle["ELECTRODE-BOTTOM"]


def test_picture_shows_red_cut_lines(folder, tmp_path):
    from matplotlib.image import imread

    draw_cut_file(folder / "film.dxf", tmp_path / "film.png")
    pixels = imread(tmp_path / "film.png")[..., :3]
    red = (pixels[..., 0] > 0.6) & (pixels[..., 1] < 0.5) & (pixels[..., 2] < 0.5)
    assert red.any(axis=0).mean() > 0.7
