"""Where the electrodes lie, and what a plane-strain slice stands for."""

import numpy as np

from geometry.errors import InputError
from geometry.parameters import Segment
from mesh.types import Floats, TetMesh


def electrode_rectangles(segment: Segment) -> Floats:
    """Electrodes as (e, 4) x0, x1, y0, y1 in mm; without any, one over everything.

    In a plane-strain slice nothing varies over y: the electrodes then reach over the whole slice, and their
    share of the width is applied with the width (see scale_of_section).
    """
    if not segment.film.electrodes:
        return np.array([[-np.inf, np.inf, -np.inf, np.inf]])
    centre = np.array([e.center_mm for e in segment.film.electrodes])
    half = 0.5 * np.array([e.size_mm for e in segment.film.electrodes])
    rectangles = np.column_stack([centre - half, centre + half])[:, [0, 2, 1, 3]]
    if segment.section == "plane-strain":
        rectangles[:, 2:] = -np.inf, np.inf
    return rectangles


def scale_of_section(segment: Segment, tet_mesh: TetMesh) -> tuple[float, Floats]:
    """Factors from what is meshed to the whole segment: for the force, and for each electrode's charge (e,)."""
    count = max(1, len(segment.film.electrodes))
    if segment.section == "solid":
        return 1.0, np.ones(count)
    force = segment.width_mm / tet_mesh.thickness_mm
    if not segment.film.electrodes:
        return force, np.array([force])
    widths = np.array([e.size_mm[1] for e in segment.film.electrodes])
    return force, np.minimum(widths, segment.width_mm) / tet_mesh.thickness_mm


def refuse_unresolved(segment: Segment, area: Floats) -> None:
    """InputError for an electrode that covers no quadrature point of the film; area (e,)."""
    for electrode, covered in zip(segment.film.electrodes, area, strict=False):
        if covered == 0.0:
            raise InputError(
                f"segment.film.electrodes: '{electrode.name}' with size_mm = {list(electrode.size_mm)} is smaller than "
                "the elements of the film; reduce mesh.film_element_size_mm"
            )
