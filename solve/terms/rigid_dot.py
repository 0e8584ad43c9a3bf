"""Signed distance to the rigid dot, with its gradient and Hessian, exact for every primitive.

The dot is the union of balls (or cylinders along y, or a profile), their cylindrical feet and the half-space of the
plate; outside it the distance to a union is the smallest distance to a member.
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from geometry.dot import DotShape
from solve.terms.profile_distance import profile_distance


@dataclass(frozen=True)
class RigidDot:
    """A dot in the solver's unit of length, at rest."""

    shape: DotShape
    unit_mm: float

    def distance(self, points: Floats, move: Floats) -> tuple[Floats, Floats, Floats]:
        """Gap (n,), gradient (n, 3) and Hessian (n, 3, 3) at points (n, 3), the dot displaced by move (3,)."""
        rotation = self.shape.rotation
        local = (points - self.shape.origin_mm / self.unit_mm - move) @ rotation
        gap, normal, hessian = self._plate(local)
        if self.shape.kind != "plate":
            for tip in self.shape.tips_mm / self.unit_mm:
                other = self._bump(local, tip)
                nearer = other[0] < gap
                gap = np.where(nearer, other[0], gap)
                normal = np.where(nearer[:, None], other[1], normal)
                hessian = np.where(nearer[:, None, None], other[2], hessian)
        return gap, normal @ rotation.T, rotation @ hessian @ rotation.T

    def _plate(self, local: Floats) -> tuple[Floats, Floats, Floats]:
        gap = self.shape.height_mm / self.unit_mm - local[:, 2]
        return gap, np.tile([0.0, 0.0, -1.0], (len(local), 1)), np.zeros((len(local), 3, 3))

    def _bump(self, local: Floats, tip: Floats) -> tuple[Floats, Floats, Floats]:
        """One ball, or one cylinder along y, with its foot: the distance to its axis minus the radius; or a profile."""
        if self.shape.profile is not None:
            gap, normal, hessian = profile_distance(self.shape.profile, local * self.unit_mm)
            return gap / self.unit_mm, normal, hessian * self.unit_mm
        radius = self.shape.radius_mm / self.unit_mm
        free = np.ones((len(local), 3))  # directions in which the distance to the axis varies
        middle = np.add(tip, [0.0, 0.0, radius])
        if self.shape.kind == "ridge":
            free[:, 1] = 0.0
        if self.shape.height_mm / self.unit_mm > middle[2]:  # a cylindrical foot from the equator to the plate
            free[local[:, 2] > middle[2], 2] = 0.0
        arm = (local - middle) * free
        length = np.maximum(np.linalg.norm(arm, axis=1), 1e-12 * radius)
        normal = arm / length[:, None]
        projector = free[:, :, None] * np.eye(3) - normal[:, :, None] * normal[:, None, :]
        return length - radius, normal, projector / length[:, None, None]
