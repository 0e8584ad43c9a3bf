"""Meshes kept on disk under a hash of what they depend on: pytetwild is slow and not repeatable."""

import hashlib
import json
import os
from collections.abc import Callable
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any
from zipfile import BadZipFile

import numpy as np

from geometry.dot_shape import DotShape
from geometry.parameters import Segment
from mesh.linear import LinearMesh
from mesh.parameters import MeshOptions

VERSION = 1  # raise it when the mesher changes what it makes


def folder() -> Path:
    """Where meshes are kept: SOFTDOT_CACHE, or the user's cache folder of this platform."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("SOFTDOT_CACHE") or user_cache_dir("softdot", appauthor=False))


def key(segment: Segment, dot: DotShape, options: MeshOptions) -> str:
    """Hash of the geometry, of the dot's place and size, of the options and of the mesher's version."""
    import pytetwild

    effector = segment.effector
    content = {
        "version": [VERSION, getattr(pytetwild, "__version__", "")],
        "segment": [segment.length_mm, segment.width_mm, segment.section, segment.film.thickness_um],
        "layers": [segment.medium1.thickness_mm, segment.medium2.thickness_mm],
        "effector": effector and effector.model_dump(exclude={"material"}),
        "dot": [dot.kind, dot.radius_mm, *(np.round(a, 9).tolist() for a in _places(dot))],
        "options": options.model_dump(exclude={"timeout_s"}),
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _places(dot: DotShape) -> tuple[Any, Any, Any]:
    """The arrays of a dot."""
    return np.asarray(dot.centers_xy_mm), np.asarray(dot.origin_mm), np.asarray(dot.rotation)


def remembered(name: str, make: Callable[[], LinearMesh]) -> LinearMesh:
    """The mesh kept under this name, or a new one that is then kept. An unreadable file is a miss."""
    path = folder() / f"mesh-{name}.npz"
    found = _read(path)
    if found is not None:
        return found
    made = make()
    _write(path, made)
    return made


def _read(path: Path) -> LinearMesh | None:
    """The mesh in a file, None when there is none or it is damaged."""
    try:
        with np.load(path, allow_pickle=False) as data:
            names = tuple(str(n) for n in data["names"])
            return _valid(LinearMesh(data["points"], data["tets"], data["region"], names))
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None


def _valid(found: LinearMesh) -> LinearMesh:
    """The mesh itself; ValueError when its arrays do not fit together."""
    if found.points_mm.shape[1:] != (3,) or found.tets.shape != (len(found.region), 4):
        raise ValueError("array shapes")
    if found.tets.min() < 0 or found.tets.max() >= len(found.points_mm):
        raise ValueError("node numbers")
    return found


def _write(path: Path, made: LinearMesh) -> None:
    """Write beside, then rename; a cache that cannot be written is no cache."""
    beside = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as file:
            beside = Path(file.name)
            names = np.array(made.region_names)
            np.savez_compressed(file, points=made.points_mm, tets=made.tets, region=made.region, names=names)
        beside.replace(path)
    except OSError:
        return
    finally:
        if beside is not None:
            beside.unlink(missing_ok=True)
