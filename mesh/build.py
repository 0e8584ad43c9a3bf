"""Entry of the mesher: a mesher is chosen, and what pytetwild makes is kept on disk."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from foundation.cache import cache_folder, data_hash, read_arrays, write_arrays
from foundation.source_hash import source_hash
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.options import MeshOptions
from mesh.types import LinearMesh, Planes

if TYPE_CHECKING:
    from mesh.types import TetMesh


def build(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> TetMesh:
    """Mesh a segment, film included, as curved ten-node tetrahedra with named facets.

    dot : where and how round the dot is, which is where the mesh is fine. planes : mirror planes of the whole press
    (solve.symmetry), at which the mesh ends; an own mesh has none.
    Raises InputError when the mesher cannot mesh the shape or options.file is no mesh of it, MeshingError when the
    mesher fails or takes too long.
    """
    from mesh.quadratic import quadratic_mesh

    if options.file is not None:
        from mesh.files.user_mesh import user_mesh

        return user_mesh(options.file, segment)
    return quadratic_mesh(_linear_mesh(segment, dot, options, planes), segment, options, planes)


def _linear_mesh(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes) -> LinearMesh:
    """The linear mesh by the mesher that the options name; meshes of pytetwild are kept on disk."""
    from mesh.layered import layered_mesh
    from mesh.slice import layered_slice, tetwild_slice
    from mesh.tetwild import tetwild_mesh

    is_slice = segment.section == "plane-strain"
    if options.mesher == "layered":
        return (layered_slice if is_slice else layered_mesh)(segment, dot, options, planes)
    make = tetwild_slice if is_slice else tetwild_mesh
    return cached_mesh(mesh_key(segment, dot, options, planes), lambda: make(segment, dot, options, planes))


def mesh_key(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> str:
    """SHA-256 of the geometry, of the dot's place and size, of the options and of the meshers' sources."""
    from importlib.metadata import version

    effector = segment.effector
    content = {
        "meshers": [*(source_hash(f"mesh.{one}") for one in ("tetwild", "layered", "slice")), version("pytetwild")],
        "segment": [segment.length_mm, segment.width_mm, segment.section, segment.film.thickness_um],
        "layers": [segment.medium1.thickness_mm, segment.medium2.thickness_mm],
        "effector": effector and effector.model_dump(exclude={"material"}),
        "dot": [dot.kind, dot.radius_mm, *(np.round(a, 9).tolist() for a in _dot_arrays(dot))],
        **({} if dot.profile is None else {"profile": repr(dot.profile)}),
        "options": options.model_dump(exclude={"timeout_s", "file", "symmetry", "accuracy_percent"}),
        "planes": planes,
    }
    return data_hash(content)


def _dot_arrays(dot: DotShape) -> tuple[Any, Any, Any]:
    """Tips, origin and rotation of a dot as arrays."""
    return np.asarray(dot.tips_mm), np.asarray(dot.origin_mm), np.asarray(dot.rotation)


def cached_mesh(name: str, make: Callable[[], LinearMesh]) -> LinearMesh:
    """The mesh kept under this name, or that which make returns, which is then kept. A damaged file is made again.

    Where another process has kept one meanwhile, that one: a mesher may make another mesh at each call, and presses
    that are compared need the same.
    """
    path = cache_folder() / f"mesh-{name}.npz"
    found = read_arrays(path, _decode_mesh)
    if found is not None:
        return found
    made = make()
    found = read_arrays(path, _decode_mesh)
    if found is not None:
        return found
    names = np.array(made.region_names)
    arrays = {"points": made.points_mm, "tets": made.tets, "region": made.region, "names": names}
    with suppress(OSError):  # a cache that cannot be written is no cache
        write_arrays(path, arrays, compressed=True)
    return made


def _decode_mesh(data: Mapping[str, Any]) -> LinearMesh:
    """The mesh in the arrays of a file. ValueError when they do not fit together."""
    found = LinearMesh(data["points"], data["tets"], data["region"], tuple(str(name) for name in data["names"]))
    if found.points_mm.shape[1:] != (3,) or found.tets.shape != (len(found.region), 4):
        raise ValueError("array shapes")
    if found.tets.min() < 0 or found.tets.max() >= len(found.points_mm):
        raise ValueError("node numbers")
    return found
