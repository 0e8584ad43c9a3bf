"""What the writer of VTK XML stores is what VTK and meshio read, whether it shrinks or not."""

import zlib

import meshio
import numpy as np
import pytest
import pyvista

from export.vtk_xml import BLOCK_BYTES, VtkGrid, encode_blocks

QUADRATIC_TRIANGLE = 22


def grid_of(cells):
    points = np.random.default_rng(0).standard_normal((6 * cells, 3))
    return VtkGrid(points, np.arange(6 * cells).reshape(-1, 6), QUADRATIC_TRIANGLE), points


@pytest.mark.parametrize("cells", [1, BLOCK_BYTES // 8, BLOCK_BYTES // 8 + 1])  # one block, just a block, a little more
def test_noise_and_zeros_are_read_as_they_were_written(tmp_path, cells):
    grid, points = grid_of(cells)
    noise, zeros = np.random.default_rng(1).standard_normal(cells), np.zeros(cells)
    half = np.where(np.arange(cells) < cells // 2, 0.0, noise)
    written = {"noise": noise, "zeros": zeros, "half": half, "number": np.arange(cells, dtype=np.int32)}
    grid.write(tmp_path / "a.vtu", {}, {name: (values, ()) for name, values in written.items()})
    by_vtk, by_meshio = pyvista.read(tmp_path / "a.vtu"), meshio.read(tmp_path / "a.vtu")
    np.testing.assert_array_equal(by_vtk.points, points)
    np.testing.assert_array_equal(by_meshio.points, points)
    for name, values in written.items():
        np.testing.assert_array_equal(by_vtk.cell_data[name], values)
        np.testing.assert_array_equal(by_meshio.cell_data[name][0], values)


def test_what_shrinks_is_compressed_and_noise_hardly_grows():
    noise = np.random.default_rng(2).standard_normal(100_000)
    assert len(encode_blocks(np.zeros(100_000))) < 0.01 * noise.nbytes
    assert len(encode_blocks(noise)) < 4 / 3 * 1.001 * noise.nbytes  # base64 writes three bytes as four
    assert len(zlib.compress(noise.tobytes(), 1)) > 0.9 * noise.nbytes  # why it is stored as it is


def test_an_array_of_another_length_is_refused(tmp_path):
    grid, _ = grid_of(2)
    with pytest.raises(ValueError, match="stress has the length 3, not 2"):
        grid.write(tmp_path / "a.vtu", {}, {"stress": (np.zeros(3), ())})
    assert not list(tmp_path.iterdir())
