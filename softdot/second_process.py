"""What a second process does for a run while the first one meshes and presses: kernels, the parts' files and pictures.
This module itself loads in no time, so that the second process starts before the first one has loaded anything.
"""

import time
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foundation.library_loading import load_alone, without_garbage_collection
from foundation.worker_process import WorkerProcess

if TYPE_CHECKING:
    from geometry.dot import DotShape
    from geometry.parameters import Segment
    from geometry.solids import Part

PARTS = ("geometry", "topology", "exporters3d", "mesher")
"""Of build123d; the rest of it loads scikit-learn, pandas and a reader of DXF files, in twice the time of these."""
DRAWING = ("trimesh", "solve.result", "matplotlib.figure", "pyvista.plotting", "export.pictures")


class SecondProcess(WorkerProcess):
    """Begins at once to compile kernels that this machine has not kept, and to load what it needs.

    kernels : done when a press will find them.
    """

    def __init__(self) -> None:
        super().__init__()
        self.kernels = self(compile_kernels)
        self(load_libraries)


def compile_kernels() -> None:
    """The dear ones, unless they are kept; the first process compiles the others while it waits."""
    from solve.fem.warm_up import compiled

    if not compiled():
        from solve.fem.warm_up import compile_dear

        compile_dear()


def load_libraries() -> None:
    """Load what parts and pictures take, which is two seconds of work."""
    with without_garbage_collection():
        load_alone("build123d", *PARTS)
        for name in DRAWING:
            import_module(name)


def warm_drawing() -> None:
    """Draw what nobody sees: the first pictures of a process load fonts, OpenGL and more, for a second and a half."""
    from export.pictures import draw_sample

    draw_sample()


def make_cad(segment: "Segment", dot_shape: "DotShape", folder: Path) -> float:
    """The parts and their files; returns how many seconds they took. InputError."""
    from geometry import assembly

    start = time.perf_counter()
    write_cad(assembly.build_parts(segment, dot_shape), folder)
    return time.perf_counter() - start


def write_cad(parts: "Sequence[Part]", folder: Path) -> None:
    """STEP, 3MF and STL files of the parts."""
    from export import cad

    cad.write_cad(parts, folder)


def draw(*arguments: Any) -> dict[str, Path]:
    """As export.pictures.write_pictures."""
    from export.pictures import write_pictures

    return write_pictures(*arguments)
