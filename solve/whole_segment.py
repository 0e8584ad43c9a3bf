"""What a plane-strain slice, a half or a quarter stands for."""

import numpy as np

from foundation.arrays import Floats
from geometry.electrode_outlines import electrode_outlines
from geometry.parameters import Segment
from mesh.types import TetMesh
from solve.symmetry import electrode_image_sum


def meshed_share(segment: Segment, tet_mesh: TetMesh) -> float:
    """Share of the whole segment that is meshed: of a slice its share of the width, and half for each mirror plane."""
    share = 0.5 ** len(tet_mesh.planes)
    return share if segment.section == "solid" else share * tet_mesh.thickness_mm / segment.width_mm


def whole_charge(segment: Segment, tet_mesh: TetMesh) -> Floats:
    """Matrix (e, e) from what each electrode collects where it is meshed to what each collects in the whole segment."""
    total = electrode_image_sum(electrode_outlines(segment), tet_mesh.planes)
    if segment.section == "solid":
        return total
    widths = np.array([e.size_mm[1] for e in segment.film.electrodes if e.size_mm] or [segment.width_mm])
    return np.asarray(np.minimum(widths, segment.width_mm)[:, None] / tet_mesh.thickness_mm * total)
