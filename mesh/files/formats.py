"""Files of the mesh that other codes read: Gmsh 4.1, Abaqus or CalculiX, XDMF. Lengths in mm.
meshio writes the nodes and elements. What it leaves out, or would write for no solver to read, is put right here.
"""

import re
from collections.abc import Callable, Sequence
from io import StringIO
from pathlib import Path

import numpy as np

from foundation.arrays import Ints
from foundation.errors import InputError
from foundation.nearest_name import nearest_name_hint
from mesh.types import TET_FACES, TetMesh

REGION_NUMBERS = {"medium2": 1, "film": 2, "medium1": 3, "effector": 4}
"""Number of each part, the same in every file: of its physical group, and in the field "region" of XDMF."""
SURFACE_NUMBERS = {"contact": 11, "base": 12, "film-bottom": 13, "film-top": 14} | {
    f"side-{name}": 20 + number for name, number in REGION_NUMBERS.items()
}
"""Number of each named surface: of its physical group, and in the field "surface" of XDMF."""
FILE_STEM = "segment"
INP_NUMBER_FORMAT = ".14g"
"""Numbers of at most 20 characters: neither Abaqus nor CalculiX reads longer ones."""


def write_mesh(tet_mesh: TetMesh, formats: Sequence[str], folder: Path) -> list[Path]:
    """Write segment.msh, segment.inp or segment.xdmf into the folder, which is made; return the paths.

    formats : keys of WRITERS; InputError for another. XDMF has a second file segment_surfaces.xdmf, and the
    numbers of both stand beside them in .h5. OSError where the folder cannot be written.
    """
    check_formats(formats)
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name in dict.fromkeys(formats):
        path = folder / f"{FILE_STEM}.{name}"
        WRITERS[name](tet_mesh, path)
        paths.append(path)
    return paths


def check_formats(formats: Sequence[str]) -> None:
    """Raise InputError for a format that has no writer."""
    for name in formats:
        if name not in WRITERS:
            raise InputError(f"--mesh-format = '{name}': there is no such format; {nearest_name_hint(name, WRITERS)}")


def _named_surfaces(tet_mesh: TetMesh) -> dict[str, Ints]:
    """Name -> facets (k, 6) of the named surfaces that have any."""
    return {name: facets for name, facets in tet_mesh.facets.items() if len(facets)}


def _write_msh(tet_mesh: TetMesh, path: Path) -> None:
    """Write Gmsh 4.1 as text: one entity and one physical group for each part and each named surface."""
    import meshio

    regions = {name: tet_mesh.tets[tet_mesh.region_tets(name)] for name in tet_mesh.region_names}
    blocks = [("tetra10", 3, REGION_NUMBERS[name], tets) for name, tets in regions.items()]
    blocks += [("triangle6", 2, SURFACE_NUMBERS[name], facets) for name, facets in _named_surfaces(tet_mesh).items()]
    tags = [np.full(len(cells), tag) for _, _, tag, cells in blocks]
    names = {name: (REGION_NUMBERS[name], 3) for name in regions} | {
        name: (SURFACE_NUMBERS[name], 2) for name in _named_surfaces(tet_mesh)
    }
    whole = meshio.Mesh(
        tet_mesh.points_mm,
        [(kind, cells) for kind, _, _, cells in blocks],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        point_data={"gmsh:dim_tags": _node_entities(len(tet_mesh.points_mm), blocks)},
        field_data={name: np.array(value) for name, value in names.items()},
    )
    meshio.gmsh.write(path, whole, "4.1", binary=False)


def _node_entities(count: int, blocks: Sequence[tuple[str, int, int, Ints]]) -> Ints:
    """Dimension and tag (count, 2) of the entity of each node: that of a surface before that of a part.

    meshio lists an entity, and with it its physical group, only where a node belongs to it. An entity without a node of
    its own therefore gets one of its shared nodes.
    """
    owner = np.full(count, -1)
    for number, (_, _, _, cells) in enumerate(blocks):
        owner[cells] = number
    for number, (_, _, _, cells) in enumerate(blocks):
        if not (owner == number).any():
            nodes = np.unique(cells)
            owner[nodes[np.argmax(np.bincount(owner, minlength=len(blocks))[owner[nodes]])]] = number
    return np.asarray(np.array([(dimension, tag) for _, dimension, tag, _ in blocks])[owner])


def _write_inp(tet_mesh: TetMesh, path: Path) -> None:
    """Write C3D10 elements, an ELSET for each part, an NSET and a SURFACE of element faces for each named surface.

    Both codes number the nodes of an element as VTK does, and its faces S1 to S4 in the order of TET_FACES.
    """
    import meshio

    sets = {name: [tet_mesh.region_tets(name)] for name in tet_mesh.region_names}
    nodes = {name: np.unique(facets) for name, facets in _named_surfaces(tet_mesh).items()}
    nodes["all"] = np.arange(len(tet_mesh.points_mm))
    whole = meshio.Mesh(tet_mesh.points_mm, [("tetra10", tet_mesh.tets)], cell_sets=sets, point_sets=nodes)
    text = StringIO()
    meshio.abaqus.write(text, whole, float_fmt=INP_NUMBER_FORMAT)
    mesh_text = re.sub(r"(\*ELEMENT, TYPE=)\w+", r"\1C3D10", text.getvalue())  # meshio takes the hybrid C3D10MH
    head = ["** softdot: lengths in mm; with forces in N, stresses are in MPa.", *_slice_note(tet_mesh)]
    surfaces = [
        line for name, facets in _named_surfaces(tet_mesh).items() for line in _surface_keyword(tet_mesh, name, facets)
    ]
    path.write_text("\n".join([*head, mesh_text.rstrip("\n"), *surfaces]) + "\n", "utf-8")


def _slice_note(tet_mesh: TetMesh) -> list[str]:
    if (tet_mesh.twin == np.arange(len(tet_mesh.twin))).all():
        return []
    return ["** A plane-strain slice: hold direction 2 of the node set all; nodes of equal x and z move alike."]


def _surface_keyword(tet_mesh: TetMesh, name: str, facets: Ints) -> list[str]:
    """Lines of the keyword of one surface: element and face whose outward normal is that of the facet."""
    tet, face = facet_owners(tet_mesh.tets, facets)
    rows = [f"{element}, S{number}" for element, number in zip(tet + 1, face + 1, strict=True)]
    return [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *rows]


def facet_owners(tets: Ints, facets: Ints) -> tuple[Ints, Ints]:
    """Tetrahedra (k,) of which facets (k, 3 or 6) are outward faces, and the numbers (k,) of these faces in TET_FACES.

    ValueError where a facet is no face of an element, or looks into its element.
    """
    faces = _smallest_corner_first(tets[:, TET_FACES[:, :3]].reshape(-1, 3))
    number = {tuple(corners): place for place, corners in enumerate(faces.tolist())}
    try:
        place = np.array(
            [number[tuple(corners)] for corners in _smallest_corner_first(facets[:, :3]).tolist()], dtype=np.int64
        )
    except KeyError:
        raise ValueError("a facet is no outward face of an element") from None
    return place // 4, place % 4


def _smallest_corner_first(corners: Ints) -> Ints:
    """Triangles (k, 3) of the same normal whose smallest node comes first."""
    first = np.argmin(corners, axis=1)[:, None]
    return np.asarray(np.take_along_axis(corners, (first + np.arange(3)) % 3, axis=1))


def _write_xdmf(tet_mesh: TetMesh, path: Path) -> None:
    """Write the elements with the field "region", and the facets with the field "surface" in a file of their own.

    meshio cannot read a file that holds quadratic tetrahedra and triangles together, and XDMF has no names.
    """
    region = np.array([REGION_NUMBERS[name] for name in tet_mesh.region_names])[tet_mesh.region]
    _write_grid(path, tet_mesh, "tetra10", tet_mesh.tets, "region", region)
    surfaces = _named_surfaces(tet_mesh)
    if surfaces:
        surface = np.concatenate([np.full(len(facets), SURFACE_NUMBERS[name]) for name, facets in surfaces.items()])
        beside = path.with_name(f"{path.stem}_surfaces.xdmf")
        _write_grid(beside, tet_mesh, "triangle6", np.concatenate(list(surfaces.values())), "surface", surface)


def _write_grid(path: Path, tet_mesh: TetMesh, kind: str, cells: Ints, field: str, values: Ints) -> None:
    import meshio

    whole = meshio.Mesh(tet_mesh.points_mm, [(kind, cells)], cell_data={field: [values]})
    meshio.xdmf.write(path, whole)


WRITERS: dict[str, Callable[[TetMesh, Path], None]] = {"msh": _write_msh, "inp": _write_inp, "xdmf": _write_xdmf}
"""Ending of the file -> its writer."""
