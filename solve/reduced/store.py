"""Reduced models kept on disk under a hash of all that they depend on."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import TYPE_CHECKING
from zipfile import BadZipFile

import numpy as np

from mesh.cache import folder
from solve.reduced.answer import Accuracy
from solve.reduced.fit import Fit
from solve.reduced.model import ReducedModel, structure

if TYPE_CHECKING:
    from solve.reduced.build import Case

ROOT = Path(__file__).parents[1]  # the solver: any change of its code makes another model


def key(case: "Case", check: bool) -> str:
    """Hash of mesh, segment, materials, dot, depth, relaxing layers, physics and the solver's own source."""
    content = {
        "segment": case.segment.model_dump(mode="json"),
        "materials": {name: material.model_dump(mode="json") for name, material in sorted(case.materials.items())},
        "dot": [case.dot.kind, case.dot.radius_mm, case.dot.height_mm, repr(case.dot)],
        "asked": [case.depth_mm, list(case.relaxing.items()), structure(case.physics), case.depth_nodes, check],
        "thickness": case.tet_mesh.thickness_mm,
        "regions": case.tet_mesh.region_names,
    }
    digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode())
    arrays = [case.tet_mesh.points_mm, case.tet_mesh.tets, case.tet_mesh.region, case.tet_mesh.twin]
    arrays += [case.tet_mesh.facets[name] for name in sorted(case.tet_mesh.facets)]
    arrays += [np.asarray(a) for a in (case.dot.centers_xy_mm, case.dot.origin_mm, case.dot.rotation)]
    for array in arrays:
        digest.update(str(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    for source in sorted(ROOT.rglob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()


def remembered(name: str, make: Callable[[], ReducedModel]) -> ReducedModel:
    """The model kept under this name, or a new one that is then kept. An unreadable file is a miss."""
    path = folder() / f"reduced-{name}.npz"
    found = read(path)
    if found is None:
        found = make()
        write(path, found)
    return found


def read(path: Path) -> ReducedModel | None:
    """The model in a file, None when there is none or it is damaged."""
    try:
        with np.load(path, allow_pickle=False) as data:
            told = json.loads(str(data["told"]))
            fit = Fit(data["table"], data["touch"], data["start"], data["pairs"], told["missing"])
            if fit.table.shape[1] != len(fit.touch) or fit.table.shape[2] != 2 + len(data["film"]) + fit.start[-1]:
                return None
            rest = (data["film"], told["pyroelectric"], told["structure"], Accuracy(**told["accuracy"]))
            return ReducedModel(fit, told["depth_mm"], dict(told["relaxing"]), *rest)
    except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile):
        return None


def write(path: Path, model: ReducedModel) -> None:
    """Write beside, then rename; a cache that cannot be written is no cache."""
    told = {
        "missing": model.fit.missing, "pyroelectric": model.pyroelectric_uC_per_m2_K, "structure": model.structure,
        "accuracy": asdict(model.accuracy), "depth_mm": model.depth_mm, "relaxing": list(model.relaxing.items()),
    }  # fmt: skip
    fit, beside = model.fit, None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as file:
            beside = Path(file.name)
            np.savez_compressed(
                file, told=np.array(json.dumps(told)), film=model.film, table=fit.table, touch=fit.touch,
                start=fit.start, pairs=fit.pairs,
            )  # fmt: skip
        beside.replace(path)
    except OSError:
        return
    finally:
        if beside is not None:
            beside.unlink(missing_ok=True)
