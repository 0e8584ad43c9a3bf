"""What robot simulators get: the kernel with NumPy alone, and as the skin of a finger in MuJoCo."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.softdot.arrays.test_kernel import plane

ROBOT = Path(__file__).parents[3] / "examples" / "robot"
WEIGHT_N = 0.02 * 9.81


@pytest.fixture
def folder(tmp_path):
    about = {"labels": ["a", "b"], "capacitance_pF": [20.0, 20.0], "centres_mm": [[-1.0, 0.0], [1.0, 0.0]]}
    replace(plane(), about=about).save(tmp_path)
    return tmp_path


@pytest.fixture
def robot(monkeypatch):
    monkeypatch.syspath_prepend(str(ROBOT))
    yield
    for name in ("kernel_numpy", "finger_mujoco"):
        sys.modules.pop(name, None)


@pytest.mark.usefixtures("robot")
def test_numpy_alone_reads_what_softdot_reads(folder):
    from kernel_numpy import Kernel

    kernel, random = Kernel(folder), np.random.default_rng(1)
    for x, y, depth in random.uniform([-3.5, -2.5, -0.1], [3.5, 2.5, 0.4], (50, 3)):
        charge, force = plane().of_one(np.array(x), np.array(y), np.array(depth))
        told, push = kernel.press(x, y, depth)
        np.testing.assert_allclose(told, charge, atol=1e-5)
        assert push == pytest.approx(float(force), abs=1e-6)
    with pytest.raises(ValueError, match=r"depth_mm = 0\.41: the kernel ends at 0\.4"):
        kernel.press(0.0, 0.0, 0.41)


@pytest.mark.usefixtures("robot")
def test_a_finger_sinks_until_the_dot_carries_its_weight(folder):
    """The table's dot pushes back with 2 N/mm, so the finger rests where 2 N/mm times the depth is its weight."""
    from finger_mujoco import slide
    from kernel_numpy import Kernel

    kernel = Kernel(folder)
    _, place, force, voltage = slide(kernel, 0.0, start_mm=(0.0, 0.5), seconds=2.0, damping=4.0)
    assert force[-1] == pytest.approx(WEIGHT_N, rel=1e-3)
    assert 0.5 - place[-1, 1] == pytest.approx(WEIGHT_N / 2.0, rel=1e-3)
    assert voltage[-1, 0] == pytest.approx(10.0 * WEIGHT_N / 2.0 / 20.0, rel=1e-3)
    _, place, _, _ = slide(kernel, 10.0, start_mm=(-2.0, 0.5), seconds=0.1)
    assert place[-1, 0] == pytest.approx(-1.0, abs=0.02)
