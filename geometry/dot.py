"""The exact shape of the rigid dot, shared by CAD and contact."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from geometry.dot_profile import DotProfile

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class DotShape:
    """A rigid dot (or a cell of dots) on its plate.

    Dot frame: origin at the tip of the pressed dot, z into the plate; the solid lies at z >= 0.

    kind : "cap", "ridge" (cylinder along y), "plate" or "profile" (a surface of revolution).
    radius_mm : of the sphere or cylinder, or of the tip of a profile (unused for a plate).
    height_mm : height of the plate's face over the tip of the pressed dot; 0 for a plate.
    tips_mm : (n, 3) tips of the dots in the dot frame; the pressed dot first, at 0; lower dots have z above 0. All are
        balls of the same radius, on a cylindrical foot where they rise from the plate by more than that.
    origin_mm : (3,) position of the dot frame's origin in the segment frame at rest, just touching.
    rotation : (3, 3) x_segment = origin + rotation @ x_dot.
    profile : of a dot of this kind.
    """

    kind: Literal["cap", "ridge", "plate", "profile"]
    radius_mm: float
    height_mm: float
    tips_mm: NDArray[np.float64]
    origin_mm: NDArray[np.float64]
    rotation: NDArray[np.float64]
    profile: DotProfile | None = None

    @property
    def heights_mm(self) -> Floats:
        """Height (n,) of each dot over the plate, in mm."""
        return np.asarray(self.height_mm - self.tips_mm[:, 2])

    @property
    def base_diameter_mm(self) -> float:
        """Diameter in mm of the widest cap, or of its foot, where it stands on the plate; 0 for a plate."""
        if self.profile is not None:
            return 2.0 * self.profile.radius_mm[-1]
        below = min(float(self.heights_mm.max()), self.radius_mm)
        return 2.0 * float(np.sqrt(below * (2.0 * self.radius_mm - below)))
