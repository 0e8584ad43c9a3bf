"""Meshes kept on disk under a hash of what they depend on: pytetwild is slow and not repeatable."""

import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

import numpy as np

from geometry.base import InputError
from geometry.cache import read_arrays, write_arrays
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.fingerprint import data_hash
from mesh.parameters import MeshOptions
from mesh.types import LinearMesh

VERSION = 3  # raise it when the mesher changes what it makes


def folder() -> Path:
    """Where meshes are kept: SOFTDOT_CACHE, or the user's cache folder of this platform."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("SOFTDOT_CACHE") or user_cache_dir("softdot", appauthor=False))


def check_folder() -> None:
    """InputError where SOFTDOT_CACHE names a folder that cannot be made or written.

    The platform's own folder may be closed to this process; then nothing is kept.
    """
    stated = os.environ.get("SOFTDOT_CACHE")
    if not stated:
        return
    try:
        Path(stated).mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=stated):
            pass
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(
            f"SOFTDOT_CACHE = '{stated}': cannot be used as the folder of the cache ({reason}); name a folder that can "
            "be written, or unset it"
        ) from None


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
    return data_hash(content)


def _places(dot: DotShape) -> tuple[Any, Any, Any]:
    """The arrays of a dot."""
    return np.asarray(dot.centers_xy_mm), np.asarray(dot.origin_mm), np.asarray(dot.rotation)


def remembered(name: str, make: Callable[[], LinearMesh]) -> LinearMesh:
    """The mesh kept under this name, or a new one that is then kept. A damaged file is a miss."""
    path = folder() / f"mesh-{name}.npz"
    found = read_arrays(path, _decoded)
    if found is not None:
        return found
    made = make()
    names = np.array(made.region_names)
    arrays = {"points": made.points_mm, "tets": made.tets, "region": made.region, "names": names}
    with suppress(OSError):  # a cache that cannot be written is no cache
        write_arrays(path, arrays, compressed=True)
    return made


def _decoded(data: Mapping[str, Any]) -> LinearMesh:
    """The mesh in a file; ValueError when its arrays do not fit together."""
    found = LinearMesh(data["points"], data["tets"], data["region"], tuple(str(name) for name in data["names"]))
    if found.points_mm.shape[1:] != (3,) or found.tets.shape != (len(found.region), 4):
        raise ValueError("array shapes")
    if found.tets.min() < 0 or found.tets.max() >= len(found.points_mm):
        raise ValueError("node numbers")
    return found
