"""How the kernels of assembly are compiled: once, without a thread pool of numba's, and their loops in threads of ours.

numba's own parallel loops and its inlining take three times as long to compile as plain loops with called pieces, and
run no faster (docs/speed.md).
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, wraps
from typing import Any

import numba as nb

MATH = {"contract", "reassoc", "nsz", "arcp"}  # what keeps infinities and not-a-numbers as they are
PIECE: Any = {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
DIVISION: Any = "numpy"
"""By zero gives infinity, which Newton's iteration sees: an element that is all but flat has no inverse."""
THREADS: int = nb.config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]
LEAST_A_THREAD = 128  # elements or points that are worth waking a thread


def piece(math: Any = False) -> Callable[[Callable[..., Any]], Any]:
    """Decorator of what only kernels call, and LLVM puts in its place, so that it is vectorised there.

    math : numba's fastmath.
    """
    made: Callable[[Callable[..., Any]], Any] = nb.njit(fastmath=math, error_model=DIVISION, **PIECE)
    return made


def in_threads(math: Any = False) -> Callable[[Callable[..., Any]], Any]:
    """Decorator of kernel(start, stop, first, ...), a loop over a part of what first counts; called with (first, ...).

    Parts of the loop write to entries of their own. math : numba's fastmath.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        kernel = nb.njit(cache=True, nogil=True, fastmath=math, error_model=DIVISION)(function)

        @wraps(function)
        def execute(*arguments: Any) -> None:
            count = len(arguments[0])
            parts = max(1, min(THREADS, count // LEAST_A_THREAD))
            cuts = [count * part // parts for part in range(parts + 1)]
            others = [_pool().submit(kernel, *cuts[part : part + 2], *arguments) for part in range(1, parts)]
            kernel(0, cuts[1], *arguments)
            for other in others:
                other.result()

        execute.kernel = kernel  # type: ignore[attr-defined]
        return execute

    return decorate


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(THREADS, "kernel")


@piece()
def copy_numbers(source, target):  # type: ignore[no-untyped-def]
    """Copy an array (n,) into another: numba's target[:] = source compiles the words of an error, for three seconds."""
    for k in range(len(target)):
        target[k] = source[k]
