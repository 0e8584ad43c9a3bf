"""The mould against the part that is to come out of it."""

from dataclasses import dataclass
from typing import Any

from geometry.fabrication.mould import LID_MM, Mould
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.shapes import box, scaled, volume, without


@dataclass(frozen=True)
class CavityCheck:
    """The void of the closed mould, shrunk, against the designed part.

    component : "effector", "medium1" or "medium2".
    style : "open" or "split".
    designed_volume_mm3, cast_volume_mm3 : of the part and of the shrunk void of one cavity.
    difference_mm3 : volume of the symmetric difference of both.
    deviation_mm : largest distance between their surfaces.
    tolerance_mm : what is allowed.
    """

    component: str
    style: str
    designed_volume_mm3: float
    cast_volume_mm3: float
    difference_mm3: float
    deviation_mm: float
    tolerance_mm: float


def check_cavity(mould: Mould, fabrication: Fabrication) -> CavityCheck:
    """Measure the void of the closed mould by cuts with its printed parts, not with what it was made from.

    What stands in the vents is trimmed off the cast part and does not count.
    """
    designed, shrink = mould.cavity.designed, 1.0 - mould.cavity.shrinkage
    void, vents = scaled(_void(mould, fabrication), shrink), [scaled(notch, shrink) for notch in _vents_at_axis(mould)]
    beyond = _volume_outside(vents, void.cut(designed))
    lacking = volume(designed.cut(void))
    return CavityCheck(
        component=mould.component,
        style=mould.style,
        designed_volume_mm3=float(designed.volume),
        cast_volume_mm3=float(designed.volume) + beyond - lacking,
        difference_mm3=beyond + lacking,
        deviation_mm=max(_farthest(void, designed, vents), _farthest(designed, void, vents)),
        tolerance_mm=fabrication.tolerance_mm,
    )


def _void(mould: Mould, fabrication: Fabrication) -> Any:
    """What the closed mould leaves hollow around its first cavity, moved to the axis.

    The probe reaches half-way into the land and the walls, not as far as the overflow.
    """
    from build123d import Pos

    cavity, (x, y) = mould.cavity, mould.gang.centers[0]
    reach = min(fabrication.land_mm, fabrication.mould_wall_mm, LID_MM) / 2
    probe = box(
        (x - cavity.size_x / 2 - reach, x + cavity.size_x / 2 + reach),
        (y - cavity.size_y / 2 - reach, y + cavity.size_y / 2 + reach),
        (-reach, cavity.height + reach),
    )
    return Pos(-x, -y, 0) * without(probe, mould.solids.values())


def _vents_at_axis(mould: Mould) -> list[Any]:
    """The vents of the first cavity, moved with it."""
    from build123d import Pos

    x, y = mould.gang.centers[0]
    return [Pos(-x, -y, 0) * notch for notch in mould.vents[:2]]


def _volume_outside(vents: list[Any], excess: Any) -> float:
    """Volume in mm^3 of what lies beyond the part, without what stands in the vents."""
    pieces = [] if excess is None else excess.solids()
    return sum(volume(piece.cut(*vents)) for piece in pieces)


def _farthest(solid: Any, other: Any, vents: list[Any]) -> float:
    """Largest distance in mm of points on one surface, outside the vents, from the other surface."""
    from build123d import Vertex

    points, _ = solid.tessellate(0.02, 0.5)
    surface, boxes = other.shell(), [notch.bounding_box() for notch in vents]
    kept = [point for point in points if not any(_within(one, point) for one in boxes)]
    return max(float(surface.distance_to(Vertex(*point))) for point in kept)


def _within(one: Any, point: Any) -> bool:
    """Whether a point lies in a box or on it."""
    low, high, edge = tuple(one.min), tuple(one.max), 1e-6
    return all(a - edge <= x <= b + edge for a, x, b in zip(low, point, high, strict=True))
