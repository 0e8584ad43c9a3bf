"""The child process around pytetwild, which holds the GIL, swallows Ctrl-C and prints from C++.

Started as a module, with two arguments: a folder with input.npz, beside which output.npz is written, and the process
number of its parent.
"""

import sys
from pathlib import Path

import numpy as np

from geometry.processes import end_with_parent


def main(folder: Path) -> None:
    """Tetrahedralize the surface in folder/input.npz with its background sizes."""
    with np.load(folder / "input.npz") as data:
        given = {name: data[name] for name in data.files}
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
