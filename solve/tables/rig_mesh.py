"""The mesh of a diagnosis: the user's own, or as much coarser as hundreds of presses ask for."""

from dataclasses import replace
from typing import TypeAlias

import numpy as np

from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from mesh.build import build
from mesh.crowding import crowded_mesh
from mesh.morphing import morphed_mesh
from mesh.options import MeshOptions
from mesh.outline import stack_outline
from mesh.symmetry import mirrored_mesh
from mesh.types import MeshingError, TetMesh
from solve.model import Model
from solve.symmetry import meshed_planes

Mesh: TypeAlias = TetMesh
MeshSettings: TypeAlias = MeshOptions
"""What a diagnosis holds and hands on without looking into it."""


MOST_NODES = 3000  # nodes: some 8,000 unknowns, and 2 s a press on one core
LEAST_SIZE_FACTOR = 1.06
WORTH_NODES_SHARE = 0.9  # of the nodes: what a coarser mesh has at most, or it is not worth its sizes
NODES_PER_CUBE = 8  # of an element's size: one corner and seven mid-sides


def rig_mesh(
    model: Model, options: MeshOptions, largest: int = MOST_NODES, coarsen: bool = True
) -> tuple[TetMesh, MeshOptions]:
    """Mesh whose whole has at most a number of nodes, and its sizes, which grow together until it is small enough.

    Layered wherever that mesher can, as it is repeatable and takes no time. Under a dome it cannot, and a round skin
    may need more nodes whatever the sizes: there the search ends where coarser elements save no more. InputError,
    MeshingError.
    """
    options = options.model_copy(update={"film_layers": 1, "file": None})
    if model.segment.effector is not None and model.segment.effector.shape == "dome":
        return _dome_mesh(model, options.model_copy(update={"coarsen": coarsen}), largest)
    options = options.model_copy(update={"mesher": "layered"})
    while True:
        made, count = _build_mesh(model, options)
        if count <= largest or options.contact_element_size_mm > model.segment.length_mm:
            return made, options
        options = options.scale_sizes(max(LEAST_SIZE_FACTOR, 0.7 * (count / largest) ** (1.0 / 3.0)))


def _dome_mesh(model: Model, options: MeshOptions, largest: int) -> tuple[TetMesh, MeshOptions]:
    """A mesh of a dome by the user's mesher: coarser in few attempts, as each takes seconds."""
    made, count = _build_mesh(model, options)
    while count > largest:
        factor = max(LEAST_SIZE_FACTOR, (count / largest) ** 0.6)  # nodes grow with size to about -1.7
        coarser = options.scale_sizes(factor)
        other, fewer = _build_mesh(model, coarser)
        if fewer > WORTH_NODES_SHARE * count:
            break
        made, count, options = other, fewer, coarser
    return made, options


def _build_mesh(model: Model, options: MeshOptions) -> tuple[TetMesh, int]:
    """A mesh, a half or a quarter where all is symmetric, and how many nodes the whole has.

    Those on both sides of an interface count once.
    """
    dot = _dot_without_gap(model)
    try:
        made = build(model.segment, dot, options, meshed_planes(model, dot, options))
    except MeshingError:
        if not options.coarsen:
            raise
        return _build_mesh(model, options.model_copy(update={"coarsen": False}))  # coarsening may leave flat elements
    return made, len(np.unique(mirrored_mesh(made).tet_mesh.twin))


def finer_mesh(model: Model, options: MeshOptions, factor: float, largest: int) -> tuple[TetMesh, MeshOptions]:
    """A mesh with elements smaller by a factor, more so at held sides, if it has few enough nodes, and its sizes.

    Not coarsened, which saves little there and costs shape.
    """
    made, options = rig_mesh(model, options.scale_sizes(factor), largest, coarsen=False)
    return (crowded_mesh(made, model.segment) if options.mesher == "layered" else made), options


def mesh_of(model: Model, known: Model, tet_mesh: TetMesh, options: MeshOptions, largest: int = MOST_NODES) -> TetMesh:
    """The mesh of a changed model: the known one's, moved with its layers, unless it is of another dimension.

    That has at most largest nodes, crowded towards held sides: nothing is subtracted from it on a mesh of its own.
    """
    if model.segment.section != known.segment.section:  # the sizes of a slice would make half a million nodes
        volume_mm3 = sum(stack_outline(model.segment).volumes().values())
        even_mm = (NODES_PER_CUBE * volume_mm3 / largest) ** (1.0 / 3.0)
        return finer_mesh(model, options, max(1.0, even_mm / options.element_size_mm), largest)[0]
    return morphed_mesh(tet_mesh, known.segment, model.segment)


def _dot_without_gap(model: Model) -> DotShape:
    """The dot as it touches: a gap makes no other mesh."""
    dot = resolve_dot(model.dot, model.segment)
    return replace(dot, origin_mm=dot.origin_mm - [0.0, 0.0, model.dot.gap_mm])
