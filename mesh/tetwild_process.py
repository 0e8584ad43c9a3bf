"""pytetwild in a worker process that can be stopped: it holds the GIL, swallows Ctrl-C and prints from C++."""

from collections.abc import Callable
from tempfile import TemporaryFile
from typing import IO, Any

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.library_loading import load_alone
from foundation.worker_process import ProcessDiedError, WorkerProcess
from mesh.types import MeshingError


def tetrahedralize(timeout_s: float, **arrays: Any) -> tuple[Floats, Ints]:
    """Points (n, 3) and tetrahedra (m, 4) that fill the bounding box of a surface, meshed in a worker process.

    arrays : what fill_box reads. MeshingError when the process fails or takes longer than timeout_s; it never outlives
    the call, whatever interrupts it.
    """
    points, tets = _call_mesher(timeout_s, fill_box, arrays)
    return points.astype(np.float64), tets.astype(np.int64)


def _call_mesher(timeout_s: float, function: Callable[..., Any], *arguments: Any) -> Any:
    """Result of a function that runs in a worker process of its own. MeshingError."""
    with TemporaryFile() as log, WorkerProcess(log=log) as worker:
        try:
            return worker.call_within(timeout_s, function, *arguments)
        except TimeoutError:
            raise MeshingError(
                f"the mesher pytetwild was stopped after mesh.timeout_s = {timeout_s:g} s: raise it, coarsen "
                "mesh.element_size_mm and mesh.contact_element_size_mm, or use mesher layered"
            ) from None
        except ProcessDiedError:
            raise MeshingError(_reason(worker.exit_status(), log)) from None
        except Exception as error:
            raise MeshingError(f"the mesher pytetwild failed: {type(error).__name__}: {error}") from None


def _reason(status: int, log: IO[bytes]) -> str:
    """Why a mesher has no answer, from its exit status and what it has printed."""
    if status < 0:
        return (
            f"the mesher pytetwild was ended by signal {-status}, as a system does that runs out of memory; use larger "
            "mesh sizes"
        )
    log.seek(0)
    lines = log.read().decode(errors="replace").strip().splitlines() or ["no message"]
    return f"the mesher pytetwild failed with exit code {status}: {lines[-1]}"


def fill_box(given: dict[str, Any]) -> tuple[Floats, Ints]:
    """Points (n, 3) and tetrahedra (m, 4) of the bounding box of a surface with its background sizes.

    given : vertices (v, 3), faces (f, 3), edge_length, epsilon, stop_energy, coarsen; bg_vertices (b, 3),
    bg_tets (t, 4) and bg_values (b,) of the background mesh.
    """
    load_alone("pytetwild", "pytetwild")  # the whole package loads VTK
    from pytetwild.pytetwild import tetrahedralize

    points, tets = tetrahedralize(
        given["vertices"],
        given["faces"].astype(np.int32),
        edge_length_abs=float(given["edge_length"]),
        epsilon=float(given["epsilon"]),
        stop_energy=float(given["stop_energy"]),
        coarsen=bool(given["coarsen"]),
        disable_filtering=True,
        quiet=True,
        bg_vertices=given["bg_vertices"],
        bg_tets=given["bg_tets"].astype(np.int32),
        bg_values=given["bg_values"],
    )
    return np.asarray(points, dtype=np.float64), np.asarray(tets, dtype=np.int64)
