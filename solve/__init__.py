"""The finite-element method: solids, film, bonds, contact, rig and circuit, marched through time."""

from foundation.thread_pools import follow_free_cores

follow_free_cores()  # before numba and MKL are loaded

from numba import config  # noqa: E402

# The layer on TBB, which MKL brings along, can wait for its workers for ever when the process ends.
config.THREADING_LAYER_PRIORITY = ["omp", "workqueue", "tbb"]  # type: ignore[attr-defined]
