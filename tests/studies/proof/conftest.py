"""Without scikit-fem there is no world to test. The presses of the tests are kept apart from those of proofs."""

import pytest

pytest.importorskip("skfem")


@pytest.fixture(autouse=True)
def own_store(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("SOFTDOT_PROOF_CACHE", str(tmp_path_factory.getbasetemp() / "proof-cache"))
    monkeypatch.delenv("SOFTDOT_RECORDINGS", raising=False)
