"""Presses in processes of their own."""

import numpy as np
import pytest

from foundation.executor import LocalProcesses
from solve.tables import cache as store
from solve.tables import workers
from tests.diagnose.segment.rigs import engine, silent


@pytest.fixture
def jobs():
    """Two presses to different depths."""
    base = engine().first_presses.presses.press_job(engine().model)
    return [type(base)(base.model, base.tet_mesh, depth, (0.5, 1.0)) for depth in (0.02, 0.03)]


@pytest.mark.process
def test_a_process_answers_as_this_one_does(jobs, monkeypatch, tmp_path):
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    here = [job.solve()[0] for job in jobs]
    monkeypatch.setattr(workers, "WORTH_A_PROCESS", 1)
    with LocalProcesses(2) as executor:
        there = workers.run_all(jobs, silent, executor=executor)
    for found, wanted in zip(there, here, strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-9)
    assert all(store.recall(store.key(job)) is not None for job in jobs)


def test_a_damaged_table_is_none(tmp_path, monkeypatch):
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    store.keep("one", np.ones((2, 3)))
    np.testing.assert_array_equal(store.recall("one"), np.ones((2, 3)))
    (path,) = tmp_path.glob("press-table-*")
    path.write_bytes(path.read_bytes()[:50])
    assert store.recall("one") is None
    assert store.recall("other") is None
