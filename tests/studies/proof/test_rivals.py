"""The rivals, on a bench whose presses cost nothing: the answer is the depth, behind the real amplifier."""

from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

from softdot.studies.proof import rivals
from softdot.studies.proof.localised import _select_forward
from softdot.studies.proof.world import reality
from softdot.studies.proof.world.cases import _noisy
from softdot.studies.proof.world.march import Course, Table
from softdot.studies.proof.world.rigs import CLAMPED


@pytest.fixture(autouse=True)
def linear_press(monkeypatch):
    depth = np.linspace(0.0, 0.3, 5)
    known = Table(depth, Course(30.0 * depth, 4e4 * depth[:, None], depth))
    monkeypatch.setattr(reality, "table", lambda _made, _depth: known)
    rivals._believed_runs.cache_clear()
    yield
    rivals._believed_runs.cache_clear()


def recorded(**changes):
    rng = np.random.default_rng(2)
    real = replace(reality.baseline(CLAMPED), **changes)
    return [_noisy(run, CLAMPED, rng) for run in reality.record(real, CLAMPED)]


@pytest.mark.press
def test_without_effect_only_the_stubborn_one_names_something():
    said = rivals.opinions(CLAMPED.name, recorded())
    assert not said["gaussian process"].detected
    assert said["always leakage"].named == ("charge-leakage", "readout")
    assert said["always leakage"].after == pytest.approx(1.0, abs=0.05)


@pytest.mark.press
def test_a_leak_is_what_the_stubborn_one_is_right_about():
    said = rivals.opinions(CLAMPED.name, recorded(leak_MOhm=1000.0))
    assert said["gaussian process"].detected
    assert said["gaussian process"].named is None
    assert said["always leakage"].after == pytest.approx(1.0, abs=0.05)


@pytest.mark.press
def test_local_terms_are_taken_in_only_where_there_is_something():
    none = rivals.opinions(CLAMPED.name, recorded())["localised sparse regression"]
    assert (none.detected, none.named) == (False, None)
    runs = recorded()
    stiff = [{**run, "force_N": run["force_N"] + 200.0 * run["displacement_mm"].clip(0.0) ** 3} for run in runs]
    said = rivals.opinions(CLAMPED.name, stiff)["localised sparse regression"]
    assert said.named == ("hyperelastic-stiffening", "medium1")
    assert said.after == pytest.approx(1.0, abs=0.05)


def test_forward_selection_takes_the_true_column_and_its_squares():
    """Of orthonormal columns each takes the square of its own weight; noise of one takes none in."""
    random = np.random.default_rng(4)
    columns = np.linalg.qr(random.standard_normal((400, 6)))[0]
    found = _select_forward(columns, 30.0 * columns[:, 2] - 20.0 * columns[:, 5] + random.standard_normal(400))
    assert list(found) == [2, 5]
    assert found[2] == pytest.approx(900.0, rel=0.2)


@pytest.mark.skipif(find_spec("pysindy") is None, reason="pysindy is not installed")
def test_a_cubic_force_is_what_sparse_regression_fits():
    runs = recorded()
    stiff = [{**run, "force_N": run["force_N"] + 200.0 * run["displacement_mm"].clip(0.0) ** 3} for run in runs]
    said = rivals._sparse(CLAMPED, stiff, rivals._believed_runs(CLAMPED.name))
    assert said.detected
    assert said.named is not None
    assert said.after == pytest.approx(1.0, abs=0.05)
