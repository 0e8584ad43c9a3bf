"""STEP and 3MF of an array. In STEP what belongs to a segment is an assembly of its own, labelled segment-r1c2."""

from collections.abc import Sequence
from copy import copy
from pathlib import Path

from export.cad import write_3mf
from geometry.array.layout import ArrayLayout
from geometry.array.parts import electrode_face
from geometry.files import whole_folder
from geometry.solids import Part


def write_array_cad(layout: ArrayLayout, parts: Sequence[Part], folder: Path) -> None:
    """Write array.step (AP214) and array.3mf; the folder appears whole or not at all.

    Electrodes are faces without thickness, which STEP holds and 3MF does not.
    """
    with whole_folder(folder) as scratch:
        _write_step(layout, parts, scratch / "array.step")
        write_3mf(parts, scratch / "array.3mf")


def _write_step(layout: ArrayLayout, parts: Sequence[Part], path: Path) -> None:
    from build123d import Compound, export_step

    segments = []
    for place in layout.places:
        own = [copy(part.solid) for part in parts if part.label.startswith(f"{place.label}-")]
        segments.append(Compound(label=place.label, children=[*own, electrode_face(layout, place)]))
    common = [copy(part.solid) for part in parts if not part.label.startswith("segment-")]
    export_step(Compound(label=path.stem, children=[*segments, *common]), str(path))
