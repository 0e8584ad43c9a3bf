"""The finite-element method: solids, film, bonds, contact, rig and circuit, marched through time."""

import numba as nb

# The layer on TBB, which MKL brings along, can wait for its workers for ever when the process ends.
nb.config.THREADING_LAYER_PRIORITY = ["omp", "workqueue", "tbb"]
