"""pytetwild in a child process that can be stopped: it holds the GIL, swallows Ctrl-C and prints from C++.

Started as a module, with two arguments: a folder with input.npz, beside which output.npz is written, and the process
number of its parent.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.child_processes import child_python_path, end_with_parent, python_command
from foundation.library_loading import load_alone
from foundation.scratch_folders import scratch_folder
from mesh.types import MeshingError


def tetrahedralize(timeout_s: float, **arrays: object) -> tuple[Floats, Ints]:
    """Points (n, 3) and tetrahedra (m, 4) that fill the bounding box of a surface, meshed in a child process.

    arrays : what main of this module reads. MeshingError when the child fails or takes longer than timeout_s; the child
    never outlives the call, whatever interrupts it.
    """
    with scratch_folder() as folder:
        np.savez(folder / "input.npz", timeout=timeout_s, **arrays)  # type: ignore[arg-type]
        _run_child(python_command("-m", "mesh.tetwild_process", str(folder), str(os.getpid())), timeout_s)
        with np.load(folder / "output.npz") as data:
            return data["points"].astype(np.float64), data["tets"].astype(np.int64)


def _run_child(command: list[str], timeout_s: float) -> None:
    """Run a command to its end, or kill it after the timeout. MeshingError."""
    # Its own session: Ctrl-C in the terminal reaches us alone, and we kill the child.
    child = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env={**os.environ, **child_python_path()},
        start_new_session=True,
    )
    try:
        said, _ = child.communicate(timeout=timeout_s)
    except subprocess.TimeoutExpired:
        raise MeshingError(
            f"the mesher pytetwild was stopped after mesh.timeout_s = {timeout_s:g} s: raise it, coarsen "
            "mesh.element_size_mm and mesh.contact_element_size_mm, or use mesher layered"
        ) from None
    finally:
        if child.poll() is None:
            child.kill()
            child.communicate()
    if child.returncode != 0:
        if child.returncode < 0:
            raise MeshingError(
                f"the mesher pytetwild was ended by signal {-child.returncode}, as a system does that runs out of "
                "memory; use larger mesh sizes"
            )
        lines = said.decode(errors="replace").strip().splitlines() or ["no message"]
        raise MeshingError(f"the mesher pytetwild failed with exit code {child.returncode}: {lines[-1]}")


def main(folder: Path) -> None:
    """Tetrahedralize the surface in folder/input.npz with its background sizes, into folder/output.npz."""
    with np.load(folder / "input.npz") as data:
        given = {name: data[name] for name in data.files}
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
    np.savez(folder / "output.npz", points=points, tets=tets)


if __name__ == "__main__":
    end_with_parent(int(sys.argv[2]))
    main(Path(sys.argv[1]))
