"""Reduced models kept on disk under a hash of all that they depend on."""

import json
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from foundation.cache import cache_folder, data_hash, read_arrays, write_arrays
from foundation.source_hash import source_hash
from mesh.types import mesh_hash
from solve.reduced.fit import ResponseTable
from solve.reduced.model import ReducedModel, structure_key
from solve.reduced.response import Accuracy
from solve.reduced.task import ReductionTask


def model_key(case: ReductionTask, check: bool) -> str:
    """Hash of mesh, segment, materials, dot, depth, relaxing layers, physics and the solver's own source."""
    dot = case.dot
    places = (np.asarray(array).tolist() for array in (dot.tips_mm, dot.origin_mm, dot.rotation))
    content = {
        "segment": case.segment.model_dump(mode="json"),
        "materials": {name: material.model_dump(mode="json") for name, material in case.materials.items()},
        "dot": [dot.kind, dot.radius_mm, dot.height_mm, repr(dot), *places],
        "asked": [case.depth_mm, list(case.relaxing.items()), structure_key(case.physics), case.depth_nodes, check],
        "mesh": mesh_hash(case.tet_mesh),
        "solver": source_hash("solve.reduced.build"),
    }
    return data_hash(content)


def recall_or_make(name: str, make: Callable[[], ReducedModel]) -> ReducedModel:
    """The model kept under a name, or a new one that is then kept. A damaged file is a miss."""
    path = cache_folder() / f"reduced-{name}.npz"
    found = read_model(path)
    if found is None:
        found = make()
        with suppress(OSError):  # a cache that cannot be written is no cache
            write_model(path, found)
    return found


def read_model(path: Path) -> ReducedModel | None:
    """The model in a file, None when there is none or it is damaged."""
    return read_arrays(path, _decode)


def _decode(data: Mapping[str, Any]) -> ReducedModel:
    """The model of the arrays of a file; ValueError when they do not fit together."""
    told = json.loads(str(data["told"]))
    fit = ResponseTable(data["table"], data["touch"], data["start"], data["pairs"], told["missing"])
    if fit.table.shape[1] != len(fit.touch) or fit.table.shape[2] != 2 + len(data["film"]) + fit.start[-1]:
        raise ValueError("array shapes")
    rest = (data["film"], told["pyroelectric"], told["structure"], Accuracy(**told["accuracy"]))
    return ReducedModel(fit, told["depth_mm"], dict(told["relaxing"]), *rest)


def write_model(path: Path, model: ReducedModel) -> None:
    """Write a model to a file, whole. OSError."""
    told = {
        "missing": model.fit.missing, "pyroelectric": model.pyroelectric_uC_per_m2_K, "structure": model.structure,
        "accuracy": asdict(model.accuracy), "depth_mm": model.depth_mm, "relaxing": list(model.relaxing.items()),
    }  # fmt: skip
    fit = model.fit
    arrays = {
        "told": np.array(json.dumps(told)), "film": model.film, "table": fit.table, "touch": fit.touch,
        "start": fit.start, "pairs": fit.pairs,
    }  # fmt: skip
    write_arrays(path, arrays, compressed=True)
