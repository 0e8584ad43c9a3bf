"""Everything that the build sheet tells of."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, radians, sin
from typing import Any

from export.printability import Printability
from geometry.fabrication.frame_layout import FrameLayout, frame_layout
from geometry.fabrication.kit import SolidKit
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import FabricationPart
from geometry.flat.patterns import FlatKit
from geometry.parameters import Segment
from geometry.stack import Layer, layers

NAMES = {"medium1": "medium 1", "medium2": "medium 2"}
RESIN_G_CM3 = 1.15
"""Density of a printed part, about: resins 1.1 to 1.2, PLA 1.24."""


@dataclass(frozen=True)
class Contents:
    """densities_g_cm3 : by layer. permittivity : relative, of the film. printability : one for each printed part.

    budget : the tolerance budget as it stands in kit.json, None where there is none, and budget_note says why;
    press : what is pressed, in words.
    """

    segment: Segment
    fabrication: Fabrication
    solid: SolidKit
    flat: FlatKit
    densities_g_cm3: Mapping[str, float]
    permittivity: float
    printability: tuple[Printability, ...]
    budget: Mapping[str, Any] | None
    budget_note: str
    press: str
    warnings: tuple[str, ...]

    @property
    def copies(self) -> int:
        """Segments of one array."""
        return self.fabrication.array[0] * self.fabrication.array[1]

    @property
    def frame(self) -> FrameLayout:
        """Sizes of the clamp frame."""
        return frame_layout(self.segment, self.fabrication)

    @property
    def layers(self) -> tuple[Layer, ...]:
        """From the base upwards."""
        return layers(self.segment)

    @property
    def centers(self) -> list[tuple[float, float]]:
        """Places of the segments of the array, x and y."""
        turn = radians(self.frame.frame.turn_deg)
        return [(u * cos(turn) - v * sin(turn), u * sin(turn) + v * cos(turn)) for u, v in self.frame.centers]

    def part(self, label: str) -> FabricationPart | None:
        """A printed part by its label."""
        return next((part for part in self.solid.parts if part.label == label), None)


def spoken(name: str) -> str:
    """A layer as people say it, in a table."""
    return NAMES.get(name, name)


def in_words(name: str) -> str:
    """A layer as people say it, in a sentence."""
    return NAMES.get(name, f"the {name}")
