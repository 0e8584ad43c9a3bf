"""Each worker of pytest-xdist calculates on one thread; set here, before a library that reads it is loaded."""

import os

from geometry.one_thread import ONE_THREAD

if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.update(ONE_THREAD)
