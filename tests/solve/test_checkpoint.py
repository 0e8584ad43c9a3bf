"""A press that is killed goes on where it was."""

import numpy as np
import pytest

import solve.solution.checkpoint
from solve.materials.prony import Prony
from solve.model import Press
from solve.physics import Physics
from solve.solution.archive import read_archive, write_archive
from solve.solution.checkpoint import Checkpoint
from solve.waveform import Waveform
from tests.pressing import press_segment
from tests.solve.segments import cap, coarse_mesh, materials, segment

PRESS = Press(indentation_mm=0.1, load_steps=2, waveform=Waveform(shape="trapezoid", hold_s=0.2))
VISCOUS = Physics(inelastic={"medium2": (Prony((0.3,), (0.2,)),)}, prestretch=(0.002, 0.001))


class KilledError(Exception):
    """Stands for the end of the process."""


def press(checkpoint=None, on_step=None):
    stack = segment()
    tet_mesh = coarse_mesh(stack, cap(stack))
    return press_segment(stack, materials(), cap(stack), PRESS, tet_mesh, on_step, VISCOUS, checkpoint=checkpoint)


def kill_at(step):
    def on_step(_, number, __):
        if number == step:
            raise KilledError

    return on_step


@pytest.mark.process
def test_a_killed_press_ends_as_one_that_was_not(tmp_path, monkeypatch):
    monkeypatch.setattr(solve.solution.checkpoint, "WRITE_EVERY_S", 0.0)
    file = Checkpoint(tmp_path / "press.npz", "key")
    with pytest.raises(KilledError):
        press(file, kill_at(4))
    assert file.path.exists()
    solved = []
    resumed = press(file, lambda _, number, __: solved.append(number))
    whole = press(Checkpoint(tmp_path / "whole.npz", "key"))
    assert solved == [4, 5, 6]  # the first three were not solved again
    assert not file.path.exists()
    for name in ("time_s", "reaction_force_N", "film_charge_C"):
        alone, once = getattr(resumed.trace, name), getattr(whole.trace, name)  # MKL's threads add up in any order
        np.testing.assert_allclose(alone, once, rtol=0.0, atol=1e-11 * np.abs(once).max())
    assert [step.newton_iterations for step in resumed.steps] == [step.newton_iterations for step in whole.steps]
    strain, reference = (result.steps[1].fields.film_strain for result in (resumed, whole))
    np.testing.assert_allclose(strain, reference, rtol=0.0, atol=1e-11 * np.abs(reference).max())


@pytest.mark.process
def test_a_checkpoint_of_another_press_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setattr(solve.solution.checkpoint, "WRITE_EVERY_S", 0.0)
    with pytest.raises(KilledError):
        press(Checkpoint(tmp_path / "press.npz", "one"), kill_at(3))
    solved = []
    press(Checkpoint(tmp_path / "press.npz", "other"), lambda _, number, __: solved.append(number))
    assert solved == [1, 2, 3, 4, 5, 6]


def test_a_damaged_archive_counts_as_none(tmp_path):
    path = tmp_path / "a.npz"
    write_archive(path, [1.5, (np.arange(3), None, "text")])
    again = read_archive(path, {})
    assert again[0] == 1.5
    np.testing.assert_array_equal(again[1][0], np.arange(3))
    path.write_bytes(path.read_bytes()[:100])
    assert read_archive(path, {}) is None
