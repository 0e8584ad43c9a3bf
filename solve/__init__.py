"""The finite-element method: solids, film, bonds, contact, rig and circuit, marched through time."""

from numba import config

# The layer on TBB, which MKL brings along, can wait for its workers for ever when the process ends.
config.THREADING_LAYER_PRIORITY = ["omp", "workqueue", "tbb"]  # type: ignore[attr-defined]
