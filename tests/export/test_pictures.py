"""Pictures have the stated size, are not blank, and show the parts and numbers that they should."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image
from pressed_box import box_dot, box_mesh, made_up_press

from export.cutaway import draw_von_mises, open_scene
from export.film_maps import film_map
from export.pictures import PICTURE_NAMES, write_pictures
from export.rendering import OPENGL_ADVICE
from export.view import PICTURE_SIZE_PX, View
from geometry.dot import DotShape
from geometry.solids import PART_COLOURS
from mesh.types import TetMesh
from solve.model import Press, Readout
from solve.physics import Physics
from solve.readout.course import PressCourse, course
from solve.result import PressResult
from tests.cases import for_each


def course_of(press: PressResult, readout: Readout | None = None) -> PressCourse:
    return course(press, Press(), readout, Physics())


@pytest.fixture(scope="module")
def pictures(
    segment: TetMesh, press: PressResult, dot: DotShape, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Path]:
    return write_pictures(
        segment,
        press,
        dot,
        tmp_path_factory.mktemp("run") / "pictures",
        course_of(press, Readout(input_resistance_MOhm=0.1)),
    )


@pytest.fixture(scope="module")
def slice_pictures(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    thin = box_mesh(16, 0.15, 1)
    folder = tmp_path_factory.mktemp("run") / "pictures"
    pressed = made_up_press(thin)
    return write_pictures(thin, pressed, box_dot("ridge"), folder, course_of(pressed))


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def share_of(image: np.ndarray, colour: str, tolerance: int = 12) -> float:
    return float((np.abs(image - np.round(np.array(to_rgb(colour)) * 255)).max(axis=2) <= tolerance).mean())


@pytest.mark.press
@for_each("name", PICTURE_NAMES)
def test_pictures_are_png_not_blank_and_not_clipped(pictures: dict[str, Path], name: str) -> None:
    with Image.open(pictures[name]) as image:
        assert image.format == "PNG"
        assert image.size[0] == PICTURE_SIZE_PX[0]
        assert name in ("film", "force_voltage", "course") or image.size == PICTURE_SIZE_PX
    shown = pixels(pictures[name])
    assert shown.std() > 20
    border = np.concatenate([shown[:4].reshape(-1, 3), shown[-4:].reshape(-1, 3), shown[:, :4].reshape(-1, 3), shown[:, -4:].reshape(-1, 3)])  # noqa: E501  # fmt: skip
    assert (border == 255).all()


def test_slice_shows_each_part_in_its_own_colour_and_size(slice_pictures: dict[str, Path]) -> None:
    """Without light the colours are exact, and areas go like thicknesses."""
    image = pixels(slice_pictures["undeformed"])
    share = {name: share_of(image, PART_COLOURS[name], 3) for name in ("medium2", "medium1", "effector", "film")}
    assert share["medium2"] / share["effector"] == pytest.approx(2.0, rel=0.05)
    assert share["medium2"] / share["medium1"] == pytest.approx(4.0, rel=0.05)
    assert share["film"] > 0.0005


def test_pressing_changes_the_picture_where_the_dot_is(slice_pictures: dict[str, Path]) -> None:
    rest, pressed = (pixels(slice_pictures[name]) for name in ("undeformed", "deformed"))
    assert (np.abs(rest - pressed).max(axis=2) > 30).mean() > 0.01


def test_readout_curve_appears_when_given(pictures: dict[str, Path], slice_pictures: dict[str, Path]) -> None:
    green = "#3f7a4d"
    assert share_of(pixels(pictures["force_voltage"]), green) > 0.0005
    assert share_of(pixels(slice_pictures["force_voltage"]), green) == 0


def test_film_map_is_in_percent_and_picocoulomb(segment: TetMesh, press: PressResult) -> None:
    fields = press.steps[3].fields
    shown = film_map(segment, press.steps[3])
    assert 0.3 * fields.film_strain.max() < shown.strain_percent.max() / 100 <= fields.film_strain.max()
    mean_charge = fields.charge_density_C_per_m2.mean() * 1e6
    corners = np.column_stack([shown.x_mm, shown.y_mm])[shown.triangles]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    total = (area * shown.charge_pC_per_mm2[shown.triangles].mean(axis=1)).sum()
    assert total == pytest.approx(mean_charge * 2.5 * 2.5, rel=0.05)


def test_view_axes_are_right_handed_and_look_from_the_front() -> None:
    right, up, toward = View(0.0, 0.0).axes
    np.testing.assert_allclose([right, up, toward], [[1, 0, 0], [0, 0, 1], [0, -1, 0]], atol=1e-15)
    right, up, toward = View(28.0, 18.0).axes
    np.testing.assert_allclose(np.cross(right, up), toward, atol=1e-15)
    assert toward[0] > 0 > toward[1]


def test_missing_opengl_is_one_sentence_not_a_crash() -> None:
    """A window class that this machine cannot open stands for a missing library."""
    code = (
        "import subprocess; from types import SimpleNamespace\n"
        "from export import rendering as headless\n"
        "headless.subprocess.run = lambda *a, **k: SimpleNamespace(returncode=-11, stdout=b'')\n"
        "headless.ensure_rendering()"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, encoding="utf-8", timeout=60, check=False)
    assert run.stderr.strip().splitlines()[-1] == f"foundation.errors.InputError: {OPENGL_ADVICE}"


def test_parts_whose_stresses_are_far_apart_have_scales_of_their_own(
    segment: TetMesh, press: PressResult, dot: DotShape, tmp_path: Path
) -> None:
    """With one scale, a soft layer under a stiff one would be drawn without colour."""
    scene = open_scene(segment, press.steps[3], dot)
    scene.parts["medium2"]["von_mises_MPa"] = 1e-3 * np.asarray(scene.parts["medium2"]["von_mises_MPa"])
    draw_von_mises(scene, "one", tmp_path / "apart.png")
    shown = pixels(tmp_path / "apart.png")
    height = len(shown)
    yellow = (shown[..., 0] > 150) & (shown[..., 1] > 150) & (shown[..., 2] < 110)
    assert yellow[height // 2 :, : 3 * shown.shape[1] // 4].any()  # medium2 reaches the top of its scale, too
