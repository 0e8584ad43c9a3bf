"""Hashes that name what is kept on disk: of plain data, of a mesh, of files. All SHA-256, in hexadecimal."""

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from mesh.types import TetMesh


def data_hash(content: Any) -> str:
    """Of what JSON can hold, whatever the order of its keys."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def mesh_hash(tet_mesh: TetMesh) -> str:
    """Of all that a mesh holds."""
    facets = sorted(tet_mesh.facets)
    told = (tet_mesh.thickness_mm, tet_mesh.region_names, facets)
    digest = hashlib.sha256(repr(told).encode())
    arrays = [tet_mesh.points_mm, tet_mesh.tets, tet_mesh.region, tet_mesh.twin]
    for array in [*arrays, *(tet_mesh.facets[name] for name in facets)]:
        digest.update(str(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def files_hash(files: Iterable[Path]) -> str:
    """Of the content of files, in the order of their paths."""
    return hashlib.sha256(b"".join(path.read_bytes() for path in sorted(files))).hexdigest()
