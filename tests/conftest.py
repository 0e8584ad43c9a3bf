"""Before any test: one thread for each worker of pytest-xdist, and random examples that depend on their seed alone."""

import os

from hypothesis.internal.conjecture import providers

from geometry.environment import ONE_THREAD

if "PYTEST_XDIST_WORKER" in os.environ:  # set before a library that reads it is loaded
    os.environ.update(ONE_THREAD)

# Hypothesis mixes in constants of whatever modules are imported, which tests that ran before decide.
providers.is_local_module_file = lambda _: False
