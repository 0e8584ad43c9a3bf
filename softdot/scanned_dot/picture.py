"""Picture of a scanned dot: its points and the fitted profile, and from above what the profile leaves."""

from pathlib import Path

import numpy as np

from diagnose.pictures.style import AFTER, RECORDED, new_figure, save
from geometry.dot_scan import ScannedDot

MOST_POINTS, BEYOND = 20_000, 1.3
"""Points that are drawn, out to so many radii of the base."""


def draw_scan(found: ScannedDot, path: Path) -> None:
    """Draw heights over the radius, and the deviations seen from above."""
    base = found.profile.radius_mm[-1]
    radius = np.hypot(*found.points_mm[:, :2].T)
    near = np.flatnonzero(radius < BEYOND * base)
    near = near[:: max(1, len(near) // MOST_POINTS)]
    figure, ((side, above),) = new_figure(1, 2, 3.6)
    side.plot(radius[near], found.points_mm[near, 2], ".", ms=1.5, color=RECORDED, alpha=0.3, label="scan")
    curve = found.profile.meridian_mm(200)
    side.plot(curve[:, 0], found.profile.height_mm - curve[:, 1], color=AFTER, lw=1.8, label="profile")
    side.set_xlabel("radius (mm)", fontsize=10)
    side.set_ylabel("height over the plate (mm)", fontsize=10)
    side.legend(frameon=False, fontsize=9)
    most = 1e3 * max(float(np.quantile(np.abs(found.deviation_mm[near]), 0.99)), 1e-6)
    shown = above.scatter(
        *found.points_mm[near, :2].T, c=1e3 * found.deviation_mm[near], s=2, cmap="RdBu_r", vmin=-most, vmax=most
    )
    above.set_aspect("equal")
    above.set_xlabel("x (mm)", fontsize=10)
    above.set_ylabel("y (mm)", fontsize=10)
    figure.colorbar(shown, ax=above, label="scan less profile (µm)")
    save(figure, path)
