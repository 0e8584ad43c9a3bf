"""What a plane-strain slice, a half or a quarter stands for."""

import numpy as np

from foundation.arrays import Floats
from geometry.parameters import Segment
from mesh.types import TetMesh
from solve.symmetry import electrode_rectangles, images


def meshed_share(segment: Segment, tet_mesh: TetMesh) -> float:
    """What is meshed, as a share of the whole segment: a slice, and what mirror planes leave."""
    share = 0.5 ** len(tet_mesh.planes)
    return share if segment.section == "solid" else share * tet_mesh.thickness_mm / segment.width_mm


def whole_charge(segment: Segment, tet_mesh: TetMesh) -> Floats:
    """Matrix (e, e) from what each electrode collects where it is meshed to what each collects in the whole segment."""
    total = images(electrode_rectangles(segment), tet_mesh.planes)
    if segment.section == "solid":
        return total
    widths = np.array([e.size_mm[1] for e in segment.film.electrodes] or [segment.width_mm])
    return np.asarray(np.minimum(widths, segment.width_mm)[:, None] / tet_mesh.thickness_mm * total)
