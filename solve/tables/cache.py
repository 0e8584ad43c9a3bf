"""Tables kept on disk beside the meshes, under a hash of all that they depend on."""

from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from foundation.arrays import Floats
from foundation.cache import cache_folder, data_hash, read_arrays, write_arrays
from foundation.source_hash import source_hash
from mesh.types import mesh_hash
from solve.model import Model
from solve.solution.similar_press import Equilibria
from solve.tables.depth_press import DepthPress


def key(job: DepthPress) -> str:
    """Hash of model, mesh, depth, places, and the source of all that presses."""
    asked = repr((job.depth_mm, job.shares, job.back, job.returns, job.parts))
    return data_hash([source_hash(DepthPress.__module__), _model_content(job.model), mesh_hash(job.tet_mesh), asked])


def _model_content(model: Model) -> dict[str, Any]:
    """Content of the model that a press depends on."""
    return {
        "segment": model.segment.model_dump(mode="json"),
        "dot": model.dot.model_dump(mode="json", exclude={"gap_mm"}),
        "materials": {name: material.model_dump(mode="json") for name, material in model.materials.items()},
        "physics": repr(model.physics),
    }


def recall(name: str) -> Floats | None:
    """The table kept under a name, None where there is none or its file is damaged."""
    return read_arrays(_path(name), lambda data: np.asarray(data["table"], dtype=np.float64))


def keep(name: str, table: Floats) -> None:
    """Write a table under its name, whole; a cache that cannot be written is no cache."""
    with suppress(OSError):
        write_arrays(_path(name), {"table": table})


@lru_cache(maxsize=2)
def recall_equilibria(name: str) -> Equilibria | None:
    """Equilibria kept under the name of a press, None where there are none."""
    return read_arrays(_path(name, "equilibria"), lambda data: Equilibria(**{key: data[key] for key in data}))


def keep_equilibria(name: str, found: Equilibria) -> None:
    """Write equilibria under the name of their press; a cache that cannot be written is no cache."""
    with suppress(OSError):
        write_arrays(_path(name, "equilibria"), vars(found))


def _path(name: str, what: str = "table") -> Path:
    return cache_folder() / f"press-{what}-{name}.npz"
