"""The examples in docstrings give what they say."""

import doctest
from importlib import import_module
from pathlib import Path

import pytest

import softdot

ROOT = Path(__file__).parents[2]
PACKAGES = ("foundation", "geometry", "mesh", "solve", "export", "diagnose", "softdot")
MODULES = sorted(
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    for top in PACKAGES
    for path in (ROOT / top).rglob("*.py")
    if ">>> " in path.read_text("utf-8")
)
SHOWN_ELSEWHERE = {
    "Config",
    "ConvergenceWarning",
    "ResultWarning",
    "InputError",
    "MeshingError",
    "__version__",
    "diagnose",
    "load_family",
    "sweep",
    "run_config",
    "Verdict",
}
"""Exceptions, warnings, and Config, whose docstring is in the schema. What writes folders or takes minutes is shown by
the tutorial and the notebooks, which tests run too."""


@pytest.mark.parametrize("name", MODULES)
def test_examples_give_what_they_say(name, monkeypatch, tmp_path):
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    found = doctest.testmod(import_module(name), optionflags=doctest.ELLIPSIS | doctest.FAIL_FAST)
    assert found.attempted > 0
    assert found.failed == 0


def test_every_public_name_has_an_example():
    shown = {name for name in softdot.__all__ if ">>> " in (getattr(softdot, name).__doc__ or "")}
    assert set(softdot.__all__) - shown == SHOWN_ELSEWHERE
