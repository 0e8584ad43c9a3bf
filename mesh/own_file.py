"""What a user's own mesh file holds, as meshio reads it: tetrahedra, their parts by name, and named surfaces."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geometry.arrays import Bools, Floats, Ints
from geometry.base import InputError
from geometry.files import regular_file
from mesh.formats import REGIONS, SURFACES

READERS = {".msh": "gmsh", ".inp": "abaqus", ".xdmf": "xdmf"}
TETS, TRIANGLES = ("tetra", "tetra10"), ("triangle", "triangle6")
OTHER_FILES = re.compile(rb"([^\s<>\"']+\.h5):|^\*include\s*,\s*input\s*=\s*([^\r\n]+)", re.IGNORECASE | re.MULTILINE)


@dataclass(frozen=True)
class FileMesh:
    """points_mm (n, 3); tets (m, 4) or (m, 10) in VTK's order; regions : name -> (m,) which tetrahedra it has.

    surfaces : name -> (k, 3) corners of triangles, of either orientation. Names are in lower case.
    """

    points_mm: Floats
    tets: Ints
    regions: dict[str, Bools]
    surfaces: dict[str, Ints]


def told(file: str) -> str:
    """How a message calls the file."""
    return f"mesh.file = '{file}'"


def contents(file: str) -> bytes:
    """All bytes of a mesh file and of the files that it names; of those that are missing, none."""
    path = Path(file)
    if not path.is_file():
        return b""
    whole = path.read_bytes()
    if path.suffix.lower() == ".msh":
        return whole
    named = [(match[1] or match[2]).decode("utf-8", "replace").strip() for match in OTHER_FILES.finditer(whole)]
    found = [beside for name in dict.fromkeys(named) if (beside := path.parent / name).is_file()]
    return b"".join([whole, *(beside.read_bytes() for beside in found)])


def read_file(file: str) -> FileMesh:
    """Read a mesh of tetrahedra. InputError, naming mesh.file, for a file that is missing, no mesh, or has others."""
    import meshio

    path, where = Path(file), told(file)
    kind = READERS.get(path.suffix.lower())
    if kind is None:
        raise InputError(f"{where}: must end with .msh (Gmsh), .inp (Abaqus, CalculiX) or .xdmf")
    regular_file(path, where)
    try:
        found = getattr(meshio, kind).read(path)
    except Exception as error:  # meshio raises what a wrong file happens to lead to
        said = " ".join(str(error).split()) or type(error).__name__
        if "gmsh:physical" in said:
            said = "it holds elements of no physical group; save only those of physical groups"
        raise InputError(f"{where}: meshio cannot read it as a mesh of this format ({said})") from None
    return _file_mesh(found, where)


def _file_mesh(found: Any, where: str) -> FileMesh:
    """The tetrahedra of all blocks together. InputError for other solid elements and for a mixture."""
    kinds = {block.type for block in found.cells if block.dim == 3}
    if not kinds or not kinds <= set(TETS) or len(kinds) > 1:
        names = ", ".join(sorted(kinds)) or "no solid elements"
        raise InputError(f"{where}: holds {names}; all must be tetrahedra with 4 nodes, or all with 10")
    sets = _sets(found)
    tets = np.concatenate([block.data for block in found.cells if block.type in TETS]).astype(np.int64)
    if found.points.shape[1] != 3 or not np.isfinite(found.points).all() or tets.min() < 0:
        raise InputError(f"{where}: an element has a node without three finite coordinates")
    regions = {name: _mask(found, blocks) for name, blocks in sets.items() if name not in SURFACES}
    surfaces = {name: _triangles(found, blocks) for name, blocks in sets.items() if name in SURFACES}
    return FileMesh(
        np.asarray(found.points, dtype=np.float64),
        tets,
        {name: mask for name, mask in regions.items() if mask.any()},
        {name: corners for name, corners in surfaces.items() if len(corners)},
    )


def _sets(found: Any) -> dict[str, list[Ints]]:
    """For each name its cells in each block: from sets, physical groups, or the numbers that softdot writes."""
    count = len(found.cells)
    sets = {}
    for name, parts in found.cell_sets.items():
        if not name.startswith("gmsh:") and len(parts) == count:
            sets[name.lower()] = [np.asarray(part, dtype=np.int64) for part in parts]
    marks = found.cell_data.get("gmsh:physical", found.cell_data.get("region"))
    for name, number, dimension in _numbered(found) if marks is not None else ():
        numbers = (mark if block.dim == dimension else [] for block, mark in zip(found.cells, marks, strict=True))
        sets.setdefault(name.lower(), [np.flatnonzero(np.asarray(one) == number) for one in numbers])
    return sets


def _numbered(found: Any) -> Iterator[tuple[str, int, int]]:
    """Name, number and dimension of each physical group; a file without any names uses the numbers of softdot."""
    if found.field_data:
        for name, (number, dimension) in found.field_data.items():
            yield name, int(number), int(dimension)
    elif not found.cell_sets:
        for name, number in REGIONS.items():
            yield name, number, 3


def _mask(found: Any, parts: list[Ints]) -> Bools:
    """Which of all tetrahedra (m,) are in a set."""
    masks = []
    for block, part in zip(found.cells, parts, strict=True):
        if block.type in TETS:
            masks.append(np.isin(np.arange(len(block.data)), part))
    return np.concatenate(masks)


def _triangles(found: Any, parts: list[Ints]) -> Ints:
    """Corners (k, 3) of the triangles in a set."""
    chosen = [np.zeros((0, 3), dtype=np.int64)]
    for block, part in zip(found.cells, parts, strict=True):
        if block.type in TRIANGLES:
            chosen.append(block.data[part, :3].astype(np.int64))
    return np.concatenate(chosen)
