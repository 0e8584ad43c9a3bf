"""STEP, 3MF and STL files of the parts, in millimetres.
In the STEP file of an array what belongs to a segment is an assembly of its own, labelled segment-r1c2.
"""

from collections.abc import Sequence
from copy import copy
from pathlib import Path
from typing import Any

from foundation.files import whole_folder
from geometry.array.layout import ArrayLayout
from geometry.array.parts import electrode_face
from geometry.solids import Part
from geometry.triangulation import triangulated

RELATIVE_DEFLECTION = 5e-4
"""Largest distance of a facet from the true surface, against the longest side of the part."""
ANGULAR_DEFLECTION = 0.1
"""Largest angle between neighbouring facets, in radians."""


def write_cad(parts: Sequence[Part], folder: Path) -> None:
    """Write segment.step (AP214), segment.3mf and <part>.stl; the folder appears whole or not at all."""
    with whole_folder(folder) as scratch:
        write_step(parts, scratch / "segment.step")
        write_3mf(parts, scratch / "segment.3mf")
        for part in parts:
            write_stl(part, scratch / f"{part.label}.stl")


def write_step(parts: Sequence[Part], path: Path) -> None:
    """Write one assembly, labelled as the file is named, as STEP AP214."""
    from build123d import Compound, export_step

    # copies, because an assembly takes its children from other assemblies
    export_step(Compound(label=path.stem, children=[copy(part.solid) for part in parts]), str(path))


def write_3mf(parts: Sequence[Part], path: Path, angular_deflection: float = ANGULAR_DEFLECTION) -> None:
    """Write the parts as triangles with names, colours and millimetres, 3MF core specification."""
    from build123d import Mesher

    mesher = Mesher()
    for part in parts:
        mesher.add_shape(_clear_facets(part.solid), RELATIVE_DEFLECTION, angular_deflection, part_number=part.label)
    mesher.write(str(path))


def write_stl(
    part: Part, path: Path, deflection_mm: float | None = None, angular_deflection: float = ANGULAR_DEFLECTION
) -> None:
    """Write a binary STL with merged vertices and without flat facets. RuntimeError for an open surface.

    deflection_mm : largest distance of a facet from the true surface, if other than RELATIVE_DEFLECTION says.
    """
    import trimesh

    solid = _clear_facets(part.solid)
    deflection = RELATIVE_DEFLECTION * _longest_side(part) if deflection_mm is None else deflection_mm
    surface = trimesh.Trimesh(*triangulated(solid, deflection, angular_deflection), process=True)
    surface.update_faces(surface.nondegenerate_faces(height=1e-9))
    if not surface.is_volume:
        raise RuntimeError(f"the surface of part '{part.label}' is not closed")
    path.write_bytes(trimesh.exchange.stl.export_stl(surface))


def _longest_side(part: Part) -> float:
    return float(max(part.solid.bounding_box().size))


def _clear_facets(solid: Any) -> Any:
    """The solid without facets that an earlier, perhaps finer, triangulation left on it."""
    from OCP.BRepTools import BRepTools  # type: ignore[import-untyped]

    BRepTools.Clean_s(solid.wrapped)
    return solid


def write_array_cad(layout: ArrayLayout, parts: Sequence[Part], folder: Path) -> None:
    """Write array.step (AP214) and array.3mf; the folder appears whole or not at all.

    Electrodes are faces without thickness, which STEP holds and 3MF does not.
    """
    with whole_folder(folder) as scratch:
        _write_array_step(layout, parts, scratch / "array.step")
        write_3mf(parts, scratch / "array.3mf")


def _write_array_step(layout: ArrayLayout, parts: Sequence[Part], path: Path) -> None:
    from build123d import Compound, export_step

    segments = []
    for place in layout.places:
        own = [copy(part.solid) for part in parts if part.label.startswith(f"{place.label}-")]
        segments.append(Compound(label=place.label, children=[*own, electrode_face(layout, place)]))
    common = [copy(part.solid) for part in parts if not part.label.startswith("segment-")]
    export_step(Compound(label=path.stem, children=[*segments, *common]), str(path))
