"""STEP, 3MF and STL files of the parts, in millimetres."""

from collections.abc import Sequence
from copy import copy
from pathlib import Path
from typing import Any

import numpy as np

from export.files import whole_folder
from geometry.part import Part

RELATIVE_DEFLECTION = 5e-4
"""Largest distance of a facet from the true surface, against the longest side of the part."""
ANGULAR_DEFLECTION = 0.1
"""Largest angle between neighbouring facets, in radians."""


def write_cad(parts: Sequence[Part], folder: Path) -> None:
    """Write segment.step (AP214), segment.3mf and <part>.stl; the folder appears whole or not at all."""
    with whole_folder(folder) as scratch:
        _write_step(parts, scratch / "segment.step")
        _write_3mf(parts, scratch / "segment.3mf")
        for part in parts:
            _write_stl(part, scratch / f"{part.label}.stl")


def _write_step(parts: Sequence[Part], path: Path) -> None:
    from build123d import Compound, export_step

    # copies, because an assembly takes its children from other assemblies
    export_step(Compound(label="segment", children=[copy(part.solid) for part in parts]), str(path))


def _write_3mf(parts: Sequence[Part], path: Path) -> None:
    from build123d import Mesher

    mesher = Mesher()
    for part in parts:
        mesher.add_shape(
            _without_facets(part.solid), RELATIVE_DEFLECTION, ANGULAR_DEFLECTION, part_number=part.label
        )
    mesher.write(str(path))


def _write_stl(part: Part, path: Path) -> None:
    """A binary STL with merged vertices, without flat facets."""
    import trimesh

    solid = _without_facets(part.solid)
    points, triangles = solid.tessellate(RELATIVE_DEFLECTION * _longest_side(part), ANGULAR_DEFLECTION)
    surface = trimesh.Trimesh(np.array([tuple(p) for p in points]), np.array(triangles), process=True)
    surface.update_faces(surface.nondegenerate_faces(height=1e-9))
    if not surface.is_volume:
        raise RuntimeError(f"the surface of part '{part.label}' is not closed")
    path.write_bytes(trimesh.exchange.stl.export_stl(surface))


def _longest_side(part: Part) -> float:
    return float(max(part.solid.bounding_box().size))


def _without_facets(solid: Any) -> Any:
    """The solid without facets that an earlier, perhaps finer, triangulation left on it."""
    from OCP.BRepTools import BRepTools  # type: ignore[import-untyped]

    BRepTools.Clean_s(solid.wrapped)
    return solid
