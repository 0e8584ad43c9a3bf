"""Numba keeps the compiled kernels; who presses first is told that it compiles."""

from types import SimpleNamespace

from solve.fem import warm_up as kernels


def test_kernels_are_looked_for_where_numba_keeps_them(monkeypatch, tmp_path):
    stats = SimpleNamespace(cache_path=str(tmp_path))
    monkeypatch.setattr(kernels, "mixed_solid", SimpleNamespace(kernel=SimpleNamespace(stats=stats)))
    assert not kernels.is_compiled()
    (tmp_path / "kernels.mixed_solid-95.py311.1.nbc").touch()
    assert kernels.is_compiled()
