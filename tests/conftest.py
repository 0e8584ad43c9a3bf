"""Each worker of pytest-xdist calculates on one thread; set here, before a library that reads it is loaded."""

import os

if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"))
