"""Time and memory of one Newton step, and what the machine could do: python -m benchmarks.growth_point CELLS PRECISION.

PRECISION of the factorisation: "double", or "single" as a press has it, whose solutions GMRES then refines. The
operations of the factorisation are PARDISO's own count, those of the machine a dense product and a long read, all in
one process. From 25 cells on a factorisation is done once, together with its analysis.
"""

import json
import resource
import sys
import time

import numba as nb
import numpy as np
from pypardiso import PyPardisoSolver

from benchmarks.cube import cube
from benchmarks.step_ours import assembler
from benchmarks.timing import REPEATS, Phases
from solve.fem.tangent import Tangent
from solve.solution.factorisation import Pardiso, SinglePardiso
from solve.solution.linear import LinearSolver
from solve.solution.newton import RESIDUAL_TOLERANCE

FACTOR_ENTRIES, FACTOR_MFLOP, TWO_LEVEL, SINGLE = 17, 18, 23, 27  # iparm, counted from 0
SIMILAR = 1e-3  # a tolerance of the inexact Newton method
LARGE, HUGE = 20, 25  # cells from which on a phase is done three times, or once
KINDS = {"double": Pardiso, "single": SinglePardiso}


@nb.njit(parallel=True, fastmath=True)
def _sum(x):  # type: ignore[no-untyped-def]
    total = 0.0
    for i in nb.prange(len(x)):
        total += x[i]
    return total


def _best(work, repeats: int = 3) -> float:
    """Shortest of some seconds: a capacity, not a performance."""
    work()
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def capacity() -> dict[str, float]:
    """GFlop/s of a dense product and GB/s of a read, both on all cores."""
    a, x = np.ones((3000, 3000)), np.ones(50_000_000)
    return {"dgemm_gflops": 2e-9 * 3000**3 / _best(lambda: a @ a), "read_gb_s": 8e-9 * len(x) / _best(lambda: _sum(x))}


def counts(tangent: Tangent, direct: Pardiso) -> dict[str, float]:
    """Entries and operations of the factor, from an analysis with the same parameters in double precision."""
    probe = PyPardisoSolver(mtype=-2)
    probe.iparm[:] = direct._solver.iparm
    probe.iparm[SINGLE] = 0
    probe.iparm[FACTOR_ENTRIES] = probe.iparm[FACTOR_MFLOP] = -1
    probe.iparm[TWO_LEVEL] = 0  # its other values do not count
    probe.set_phase(11)
    probe._call_pardiso(tangent.upper, np.zeros(tangent.upper.shape[0]))
    entries, mflop = probe.iparm[[FACTOR_ENTRIES, FACTOR_MFLOP]].astype(np.uint32)  # they pass two thousand million
    answer = {"factor_entries": int(entries), "factor_gflop": 1e-3 * int(mflop)}
    probe.free_memory(everything=True)
    return answer


def measure(cells: int, precision: str) -> dict:
    """Medians of the phases, peak memory, counts and capacity."""
    case, phases, once = cube(cells), Phases(), Phases()
    assemble = once("prepare", assembler, case, "mixed")
    tangent, residual = assemble()
    direct = KINDS[precision]()
    timed = phases if cells >= HUGE else once
    timed("factorise" if cells >= HUGE else "analyse and factorise", direct.factorise, tangent)
    repeats = REPEATS if cells < LARGE else 3 if cells < HUGE else 1
    for _ in range(repeats):
        tangent, residual = phases("assemble", assemble)
        if cells < HUGE:
            phases("factorise", direct.factorise, tangent)
        phases("back substitute", direct.back_substitute, -residual)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    count = counts(tangent, direct)
    direct.free()
    return {
        "cells": cells,
        "precision": precision,
        "unknowns": case.count,
        "elements": len(case.tets),
        "entries": tangent.upper.nnz,
        "seconds": phases.medians() | refined(tangent, residual, case.count, repeats),
        "once": once.medians(),
        "peak_GB": peak,
        **count,
        **capacity(),
    }


def refined(tangent: Tangent, residual: np.ndarray, count: int, repeats: int) -> dict[str, float]:
    """Seconds of GMRES with a factor in single precision, loosely and to the tolerance of Newton's method."""
    linear, again = LinearSolver(np.zeros(count)), Phases()
    linear.solve(tangent, -residual, SIMILAR)
    for _ in range(repeats):
        again("gmres", linear.solve, tangent, -residual, SIMILAR, True)
        again("to 1e-10", linear.solve, tangent, -residual, RESIDUAL_TOLERANCE, True)
    linear.close()
    medians = again.medians()
    return {name: medians[name] for name in ("gmres", "to 1e-10")}


if __name__ == "__main__":
    print(json.dumps(measure(int(sys.argv[1]), sys.argv[2])))
