"""What a process that shares the cores with others like it has in its environment."""

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
"""One thread each for OpenMP, MKL, numba and OpenBLAS, which read it once, when they are loaded."""
