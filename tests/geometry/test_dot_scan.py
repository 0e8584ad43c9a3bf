"""A dot from a scan: the sphere it was made of comes back, wherever the scan lies; what is no single dot is refused."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from foundation.errors import InputError
from geometry.dot_scan import scanned_dot

BASE, HEIGHT = 0.75, 0.48
RADIUS = (BASE**2 + HEIGHT**2) / (2.0 * HEIGHT)
NOISE_MM = 0.005


def cap(x, y):
    """Height in mm of a spherical cap on a plate."""
    return np.maximum(np.sqrt(np.maximum(RADIUS**2 - x**2 - y**2, 0.0)) - (RADIUS - HEIGHT), 0.0)


@pytest.fixture
def scan(tmp_path):
    """Write a surface over 3.2 x 3.2 mm, with noise, turned and moved; returns the path."""

    def write(height, turn=(0.0, 0.0, 0.0), scale=1.0, noise=NOISE_MM, count=161):
        line = np.linspace(-1.6, 1.6, count)
        x, y = np.meshgrid(line, line, indexing="ij")
        z = height(x, y) + noise * np.random.default_rng(1).standard_normal(x.shape)
        points = Rotation.from_euler("xyz", turn, degrees=True).apply(
            np.column_stack([x.ravel(), y.ravel(), z.ravel()])
        )
        n = np.arange(count * count).reshape(count, count)
        a, b, c, d = (corner.ravel() for corner in (n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]))
        faces = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
        trimesh.Trimesh(scale * points + [3.0, 4.0, 5.0], faces).export(tmp_path / "scan.stl")
        return tmp_path / "scan.stl"

    return write


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (20.0, -35.0, 50.0), (180.0, 10.0, 0.0)])
def test_the_sphere_of_a_dot_comes_back_from_any_side(scan, turn):
    """Heights within half the noise of one point, wherever the dot stands in the patch."""
    found = scanned_dot(scan(lambda x, y: cap(x - 0.3, y + 0.2), turn))
    radius = np.linspace(0.0, 0.98 * BASE, 40)
    height = found.profile.height_mm - found.profile.curve(radius)
    assert height == pytest.approx(cap(radius, 0.0), abs=0.5 * NOISE_MM)
    assert found.deviation_rms_mm < NOISE_MM
    assert found.out_of_round_mm < 0.1 * NOISE_MM
    assert np.diff(found.profile.depth_mm).min() >= 0.0


def test_how_far_a_dot_is_from_round_is_told(scan):
    """Axes of 0.9 and 1/0.9 of the base: the difference of heights at one radius, to the second harmonic."""
    found = scanned_dot(scan(lambda x, y: cap(x * 0.9, y / 0.9)))
    angle, radius = np.meshgrid(np.linspace(0.0, np.pi, 181)[:-1], BASE * np.sqrt(np.linspace(0.01, 0.99, 50)))
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    amplitude = 2.0 * np.mean(cap(x * 0.9, y / 0.9) * np.cos(2.0 * angle))
    assert found.out_of_round_mm == pytest.approx(amplitude, rel=0.15)
    assert found.deviation_95_mm > 5.0 * NOISE_MM


@pytest.mark.parametrize(
    ("height", "scale", "words"),
    [
        (lambda x, y: 0.0 * (x + y), 1.0, "rises .* one dot and the plate"),
        (lambda x, y: cap(x - 0.8, y) + cap(x + 0.8, y), 1.0, "cut the scan to one dot"),
        (cap, 1e-3, "state it in mm"),
        (cap, 1e3, "state it in mm"),
    ],
)
def test_what_is_no_single_dot_in_mm_is_refused(scan, height, scale, words):
    with pytest.raises(InputError, match=words):
        scanned_dot(scan(height, scale=scale))


def test_a_file_without_triangles_is_refused(tmp_path):
    (tmp_path / "scan.stl").write_text("solid nothing\nendsolid nothing\n")
    with pytest.raises(InputError, match="scan"):
        scanned_dot(tmp_path / "scan.stl")
    with pytest.raises(InputError, match="no such file"):
        scanned_dot(tmp_path / "none.stl")
