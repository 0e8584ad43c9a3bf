"""Segments that the tests of this folder mesh, each once; sizes are coarse to be quick."""

from functools import cache

import numpy as np

import mesh
from geometry.dot import DotShape
from geometry.parameters import Effector, Film, Medium, Segment
from mesh.options import MeshOptions
from mesh.types import TetMesh

EFFECTORS = {
    "none": None,
    "layer": Effector(shape="layer", height_mm=1.0),
    "block": Effector(shape="block", height_mm=0.8, length_mm=1.2, width_mm=1.0),
    "cylinder": Effector(shape="cylinder", height_mm=0.8, diameter_mm=1.5),
    "dome": Effector(shape="dome", height_mm=0.5, diameter_mm=1.6),
}
# effector, section, mesher
SAMPLES = {
    f"{effector} {section} {mesher}": (effector, section, mesher)
    for effector, section, mesher in [
        ("none", "solid", "layered"),
        ("block", "solid", "layered"),
        ("cylinder", "solid", "layered"),
        ("layer", "plane-strain", "layered"),
        ("block", "plane-strain", "layered"),
        ("layer", "solid", "pytetwild"),
        ("cylinder", "solid", "pytetwild"),
        ("dome", "solid", "pytetwild"),
        ("layer", "plane-strain", "pytetwild"),
        ("dome", "plane-strain", "pytetwild"),
    ]
}
OPTIONS = {"element_size_mm": 0.5, "contact_element_size_mm": 0.2, "film_layers": 2}


def segment(effector: str = "layer", section: str = "solid") -> Segment:
    return Segment(
        length_mm=2.5,
        width_mm=2.0,
        section=section,
        effector=EFFECTORS[effector],
        medium1=Medium(thickness_mm=0.5),
        film=Film(thickness_um=28.0),
        medium2=Medium(thickness_mm=1.5),
    )


def dot(of: Segment, x_mm: float = 0.0) -> DotShape:
    top = 2.028 + (of.effector.height_mm if of.effector else 0.0)
    kind = "ridge" if of.section == "plane-strain" else "cap"
    return DotShape(kind, 0.9, 0.5, np.zeros((1, 3)), np.array([x_mm, 0.0, top]), np.eye(3))


def options(mesher: str, **changes: object) -> MeshOptions:
    return MeshOptions.model_validate({**OPTIONS, "mesher": mesher, **changes})


@cache
def built(name: str) -> TetMesh:
    effector, section, mesher = SAMPLES[name]
    of = segment(effector, section)
    return mesh.build(of, dot(of), options(mesher))


def segment_of(name: str) -> Segment:
    effector, section, _ = SAMPLES[name]
    return segment(effector, section)


def corner_faces(tets: np.ndarray) -> np.ndarray:
    """All faces (4 m, 3) by sorted corner numbers."""
    return np.sort(tets[:, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]], axis=2).reshape(-1, 3)


def facet_area(points: np.ndarray, facets: np.ndarray) -> float:
    """Area of facets as flat triangles."""
    a, b, c = np.moveaxis(points[facets[:, :3]], 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
