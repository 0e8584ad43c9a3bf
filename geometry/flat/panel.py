"""The panel of sheet around a film, with the holes by which sheets are pinned on one another."""

from dataclasses import dataclass

from geometry.fabrication.parameters import Fabrication
from geometry.flat.film import FilmLayout
from geometry.flat.pattern import Circle, Dimension, Label, Outline, rectangle
from geometry.polygons import Point

PANEL_RIM_MM, PANEL_INNER_RIM_MM = 2.0, 4.0
"""Panel around a registration hole and beside the film, and between both: room for a size on the drawing."""


@dataclass(frozen=True)
class Panel:
    """A panel of sheet around a film, in mm. u : its ends, towards the cable. half_v : half its size across.

    holes : middles of the registration holes; hole_mm : their diameter.
    They lie on the axis of the tab, so that the panel can be turned over about it.
    """

    u: tuple[float, float]
    half_v: float
    holes: tuple[Point, Point]
    hole_mm: float

    @property
    def cuts(self) -> tuple[Outline | Circle, ...]:
        """Edge and registration holes of the panel."""
        edge = rectangle("CUT", self.u, (-self.half_v, self.half_v))
        return (edge, *(Circle("CUT", place, self.hole_mm / 2) for place in self.holes))

    @property
    def dimensions(self) -> tuple[Dimension, ...]:
        """Dimensions of the edge, and from hole to hole."""
        low, first, second = -self.half_v, *self.holes
        return (
            Dimension((self.u[0], low), (self.u[1], low), "x", -4.5),
            Dimension(first, second, "x", -self.half_v - 2.5),
            Dimension((self.u[0], low), (self.u[0], self.half_v), "y", -4.5),
            Dimension((first[0], -self.hole_mm / 2), (first[0], self.hole_mm / 2), "y", -4.5),
        )

    def edge_label(self, text: str) -> Label:
        """A line of text along the upper edge, which shows which face is up and which way round."""
        return Label("ENGRAVE", ((self.u[0] + self.u[1]) / 2, self.half_v - 0.9), text)


def panel_of(layout: FilmLayout, fabrication: Fabrication) -> Panel:
    """The panel around a film."""
    hole = fabrication.pin_diameter_mm + 2 * fabrication.pin_clearance_mm
    zone = hole / 2 + PANEL_RIM_MM
    first = -layout.back_end - PANEL_INNER_RIM_MM - hole / 2
    last = layout.tab_end + layout.head_length + PANEL_INNER_RIM_MM + hole / 2
    half_v = max(layout.half_body, layout.half_head) + 2 * PANEL_RIM_MM
    return Panel((first - zone, last + zone), half_v, ((first, 0.0), (last, 0.0)), hole)
