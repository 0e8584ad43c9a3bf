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

CAD_MODULES = ("geometry", "topology", "exporters3d", "mesher")
"""Modules of build123d; the rest of it loads scikit-learn, pandas and a reader of DXF files, in twice the time."""
DRAWING_MODULES = ("trimesh", "solve.result", "matplotlib.figure", "pyvista.plotting", "export.pictures")
"""Modules that drawing needs."""


class SecondProcess(WorkerProcess):
    """A worker that at once compiles kernels which are not cached on this machine, and loads its libraries.

    kernels : done when a press will find them.
    """

    def __init__(self) -> None:
        super().__init__()
        self.kernels = self(compile_kernels)
        self(load_libraries)


def compile_kernels() -> None:
    """Compile the slow kernels unless they are cached; the first process compiles the others while it waits."""
    from solve.fem.warm_up import is_compiled

    if not is_compiled():
        from solve.fem.warm_up import compile_element_kernels

        compile_element_kernels()


def load_libraries() -> None:
    """Load the libraries for parts and pictures, which takes two seconds."""
    with without_garbage_collection():
        load_alone("build123d", *CAD_MODULES)
        for name in DRAWING_MODULES:
            import_module(name)


def warm_drawing() -> None:
    """Draw what nobody sees: the first pictures of a process load fonts, OpenGL and more, for a second and a half."""
    from export.pictures import draw_sample

    draw_sample()


def make_cad(segment: "Segment", dot_shape: "DotShape", folder: Path) -> float:
    """Build the parts and write their files; the seconds that this took. InputError."""
    from geometry import assembly

    start = time.perf_counter()
    write_cad(assembly.build_parts(segment, dot_shape), folder)
    return time.perf_counter() - start


def write_cad(parts: "Sequence[Part]", folder: Path) -> None:
    """Write STEP, 3MF and STL files of the parts."""
    from export import cad

    cad.write_cad(parts, folder)


def draw(*arguments: Any) -> dict[str, Path]:
    """Draw the pictures of a run, with the arguments and the result of export.pictures.write_pictures."""
    from export.pictures import write_pictures

    return write_pictures(*arguments)
