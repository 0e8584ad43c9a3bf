"""Tables kept on disk beside the meshes, under a hash of all that they depend on."""

import hashlib
import json
from functools import cache
from pathlib import Path
from tempfile import NamedTemporaryFile
from zipfile import BadZipFile

import numpy as np

from diagnose.segment.presses import Job
from mesh.cache import folder
from mesh.types import Floats, TetMesh
from solve.model import Model

ROOT = Path(__file__).parents[2]
SOURCES = "solve/**/*.py", "mesh/*.py", "geometry/*.py", "diagnose/segment/presses.py"
"""Any change of their code makes other tables."""


def key(job: Job) -> str:
    """Hash of model, mesh, depth, places, and the source of all that presses."""
    digest = hashlib.sha256(_source() + _told(job.model).encode() + _mesh(job.tet_mesh))
    digest.update(repr((job.depth_mm, job.shares, job.back, job.parts)).encode())
    return digest.hexdigest()


def _told(model: Model) -> str:
    """What of the model a press depends on."""
    content = {
        "segment": model.segment.model_dump(mode="json"),
        "dot": model.dot.model_dump(mode="json", exclude={"gap_mm"}),
        "materials": {name: material.model_dump(mode="json") for name, material in sorted(model.materials.items())},
        "physics": repr(model.physics),
    }
    return json.dumps(content, sort_keys=True)


def _mesh(tet_mesh: TetMesh) -> bytes:
    arrays = [tet_mesh.points_mm, tet_mesh.tets, tet_mesh.region, tet_mesh.twin]
    arrays += [tet_mesh.facets[name] for name in sorted(tet_mesh.facets)]
    digest = hashlib.sha256(repr((tet_mesh.thickness_mm, tet_mesh.region_names)).encode())
    for array in arrays:
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.digest()


@cache
def _source() -> bytes:
    digest = hashlib.sha256()
    for source in sorted(path for name in SOURCES for path in ROOT.glob(name)):
        digest.update(source.read_bytes())
    return digest.digest()


def recall(name: str) -> Floats | None:
    """The table kept under a name, None where there is none or its file is damaged."""
    try:
        with np.load(_path(name), allow_pickle=False) as data:
            return np.asarray(data["table"], dtype=np.float64)
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None


def keep(name: str, table: Floats) -> None:
    """Write beside, then rename; a cache that cannot be written is no cache."""
    path, beside = _path(name), None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as file:
            beside = Path(file.name)
            np.savez(file, table=table)
        beside.replace(path)
    except OSError:
        return
    finally:
        if beside is not None:
            beside.unlink(missing_ok=True)


def _path(name: str) -> Path:
    return folder() / f"press-table-{name}.npz"
