"""One thread for each worker of pytest-xdist, random examples that are the same in every run, and a browser."""

import os
import shutil
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import settings
from hypothesis.internal.conjecture import providers

from foundation.thread_pools import ONE_THREAD_VARIABLES

if "PYTEST_XDIST_WORKER" in os.environ:  # set before a library that reads it is loaded
    os.environ.update(ONE_THREAD_VARIABLES)

# Hypothesis mixes in constants of whatever modules are imported, which tests that ran before decide.
providers.is_local_module_file = lambda _: False
# A change is not judged by examples that another draw would not have met: --hypothesis-profile=explore draws new ones.
settings.register_profile("repeatable", derandomize=True, database=None)
settings.register_profile("explore", derandomize=False)
settings.load_profile("repeatable")

CHROMIUM = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None
)
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium of the system, which draws without a GPU. Tests are skipped without it."""
    if CHROMIUM is None:
        pytest.skip("Chromium is not installed")
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as engine:
        found = engine.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield found
        found.close()
