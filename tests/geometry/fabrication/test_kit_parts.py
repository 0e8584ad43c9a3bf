"""Every printable part is one closed volume that CAD programs and slicers read back."""

import shutil
import subprocess

import pytest
import trimesh
from build123d import import_step

from export.cad import write_step, write_stl

pytestmark = pytest.mark.press


@pytest.fixture(scope="module")
def written(design, tmp_path_factory):
    folder = tmp_path_factory.mktemp("kit")
    write_step(design.kit.parts, folder / "kit.step")
    for part in design.kit.parts:
        write_stl(part, folder / f"{part.label}.stl")
    return design, folder


def test_labels_are_unique_and_every_purpose_is_one_sentence(design):
    labels = [part.label for part in design.kit.parts]
    assert len(set(labels)) == len(labels)
    for part in design.kit.parts:
        assert part.purpose.endswith(".")
        assert part.purpose.count(". ") == 0


def test_every_part_is_one_valid_solid_of_positive_volume(design):
    for part in design.kit.parts:
        assert part.solid.is_valid
        assert len(part.solid.solids()) == 1
        assert 0.0 < part.volume_mm3 < part.size_mm[0] * part.size_mm[1] * part.size_mm[2]


def test_every_mesh_is_watertight(written):
    design, folder = written
    for part in design.kit.parts:
        surface = trimesh.load(folder / f"{part.label}.stl")
        assert surface.is_watertight
        assert surface.is_volume
        assert surface.body_count == 1
        assert surface.volume == pytest.approx(part.volume_mm3, rel=3e-3)


def test_step_volumes_come_back(written):
    design, folder = written
    found = {child.label: child for child in import_step(folder / "kit.step").children}
    assert set(found) == {part.label for part in design.kit.parts}
    for part in design.kit.parts:
        assert found[part.label].volume == pytest.approx(part.volume_mm3, rel=1e-6)


@pytest.mark.skipif(shutil.which("prusa-slicer") is None, reason="PrusaSlicer is not installed")
def test_prusaslicer_slices_every_part_without_a_manifold_warning(written, tmp_path):
    design, folder = written
    for part in design.kit.parts:
        said = slicer("--info", folder / f"{part.label}.stl")
        assert "manifold = yes" in said, part.label
        code = tmp_path / f"{part.label}.gcode"
        said = slicer("--export-gcode", "--output", code, folder / f"{part.label}.stl")
        assert "manifold" not in said.lower(), part.label
        assert "repair" not in said.lower(), part.label
        assert code.stat().st_size > 1000


def slicer(*arguments) -> str:
    done = subprocess.run(["prusa-slicer", *arguments], capture_output=True, encoding="utf-8", timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr
