"""CAD files, read back by the programs that they are written for."""

import shutil
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest
import trimesh
from build123d import import_step

from export.cad import write_cad
from geometry.assembly import build_parts
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Effector, Film, Medium, Segment
from geometry.solids import PART_COLOURS, volume_mm3

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
DOME = Effector(shape="dome", diameter_mm=2.0, height_mm=0.8)
CASES = {
    "default": ({"effector": Effector()}, Dot()),
    "dome and hemisphere": ({"effector": DOME, "boundary": "free"}, Dot(radius_mm=0.8)),
    "cell": ({"effector": Effector()}, Dot(cell="⠿")),
    "tilted, footed": (
        {"effector": Effector(shape="cylinder", diameter_mm=1.5)},
        Dot(base_diameter_mm=1.6, height_mm=0.9, tilt_deg=(8.0, -10.0), offset_mm=(0.2, 0.1)),
    ),
    "ridge": (
        {"section": "plane-strain", "width_mm": 16.0, "effector": Effector(shape="block", length_mm=1.0)},
        Dot(shape="ridge", radius_mm=1.15),
    ),
}


def parts_of(case):
    changes, dot = CASES[case]
    layers = {"medium1": Medium(thickness_mm=0.5), "medium2": Medium(thickness_mm=2.0)}
    segment = Segment(film=Film(thickness_um=28.0), **layers, **changes)
    return build_parts(segment, resolve_dot(dot, segment))


@pytest.fixture(scope="module", params=CASES)
def written(request, tmp_path_factory):
    """The parts of one case and the folder that they were written to."""
    parts = parts_of(request.param)
    folder = tmp_path_factory.mktemp("out") / "cad"
    write_cad(parts, folder)
    return parts, folder


def test_one_file_for_each_part_and_nothing_else(written):
    parts, folder = written
    names = {"segment.step", "segment.3mf"} | {f"{part.label}.stl" for part in parts}
    assert {path.name for path in folder.iterdir()} == names
    assert [path.name for path in folder.parent.iterdir()] == ["cad"]


def test_step_keeps_labels_volumes_and_colours(written):
    parts, folder = written
    text = (folder / "segment.step").read_text(encoding="utf-8")
    assert "AUTOMOTIVE_DESIGN" in text  # the schema of AP214
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    found = {child.label: child for child in import_step(folder / "segment.step").children}
    assert set(found) == {part.label for part in parts}
    for part in parts:
        child = found[part.label]
        assert volume_mm3(child) == pytest.approx(part.volume_mm3, rel=1e-6)
        assert tuple(child.color)[:3] == pytest.approx(part.colour, abs=1e-3)
        low, expected = child.bounding_box().min, part.solid.bounding_box().min
        assert tuple(low) == pytest.approx(tuple(expected), abs=1e-4)


def test_every_stl_is_a_binary_closed_outward_volume(written):
    parts, folder = written
    for part in parts:
        path = folder / f"{part.label}.stl"
        surface = trimesh.load(path)
        assert path.stat().st_size == 84 + 50 * len(surface.faces)  # the size of a binary STL
        assert surface.is_volume
        assert surface.volume > 0.0
        assert surface.volume == pytest.approx(part.volume_mm3, rel=3e-3)
        assert surface.area_faces.min() > 0.0
        assert surface.body_count == 1


def test_3mf_keeps_millimetres_names_and_colours(written):
    parts, folder = written
    with zipfile.ZipFile(folder / "segment.3mf") as archive:
        model = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    assert model.get("unit") == "millimeter"
    groups = {group.get("id"): group[0].get("displaycolor") for group in model.iter(CORE + "basematerials")}
    found = {thing.get("name"): thing for thing in model.iter(CORE + "object") if thing.get("name")}
    assert set(found) == {part.label for part in parts}
    assert len(list(model.iter(CORE + "item"))) == len(parts)
    for part in parts:
        thing = found[part.label]
        assert groups[thing.get("pid")].lower() == PART_COLOURS[part.label] + "ff"
        surface = trimesh.Trimesh(
            [[float(v.get(axis)) for axis in "xyz"] for v in thing.iter(CORE + "vertex")],
            [[int(t.get(corner)) for corner in ("v1", "v2", "v3")] for t in thing.iter(CORE + "triangle")],
            process=False,
        )
        assert surface.is_volume
        assert surface.volume == pytest.approx(part.volume_mm3, rel=5e-3)


def test_facets_do_not_depend_on_an_earlier_triangulation(tmp_path):
    parts = parts_of("dome and hemisphere")
    write_cad(parts, tmp_path / "first")
    for part in parts:
        part.solid.tessellate(5e-4, 0.05)
    write_cad(parts, tmp_path / "second")
    for name in ("effector.stl", "dot.stl"):
        assert (tmp_path / "first" / name).stat().st_size == (tmp_path / "second" / name).stat().st_size


def test_an_error_leaves_the_earlier_folder(written, tmp_path, monkeypatch):
    parts, _ = written
    old = tmp_path / "cad"
    old.mkdir()
    (old / "kept").write_text("earlier", "utf-8")

    def fail(*_):
        raise OSError("disk full")

    monkeypatch.setattr("export.cad.write_stl", fail)
    with pytest.raises(OSError, match="disk full"):
        write_cad(parts, old)
    assert [path.name for path in tmp_path.iterdir()] == ["cad"]
    assert [path.name for path in old.iterdir()] == ["kept"]


def slicer_info(path: Path) -> dict[str, str]:
    """What PrusaSlicer says of a file; it ends with 0 on a broken surface too, so its words count."""
    done = subprocess.run(["prusa-slicer", "--info", path], capture_output=True, encoding="utf-8", timeout=120)
    assert done.returncode == 0, done.stderr
    lines = [line.split(" = ", 1) for line in done.stdout.splitlines() if " = " in line]
    return {key.strip(): value.strip() for key, value in lines}


@pytest.mark.press
@pytest.mark.skipif(shutil.which("prusa-slicer") is None, reason="PrusaSlicer is not installed")
def test_prusaslicer_finds_every_part_manifold(written):
    parts, folder = written
    for part in parts:
        info = slicer_info(folder / f"{part.label}.stl")
        assert info["manifold"] == "yes", part.label
        assert float(info["volume"]) == pytest.approx(part.volume_mm3, rel=3e-3)
    assert slicer_info(folder / "segment.3mf")["manifold"] == "yes"


@pytest.mark.press
@pytest.mark.skipif(shutil.which("prusa-slicer") is None, reason="PrusaSlicer is not installed")
def test_prusaslicer_reports_a_hole(written, tmp_path):
    _, folder = written
    surface = trimesh.load(folder / "dot.stl")
    surface.update_faces(range(1, len(surface.faces)))
    surface.export(tmp_path / "holed.stl")
    assert slicer_info(tmp_path / "holed.stl")["manifold"] == "no"
