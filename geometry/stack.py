"""Heights of the layers of a segment."""

from dataclasses import dataclass

from geometry.parameters import Segment


@dataclass(frozen=True)
class Layer:
    """One layer: its name, its lower and upper height in mm and its material."""

    name: str
    bottom_mm: float
    top_mm: float
    material: str

    @property
    def thickness_mm(self) -> float:
        """Thickness in mm."""
        return self.top_mm - self.bottom_mm


def layers(segment: Segment) -> tuple[Layer, ...]:
    """Layers from the base upwards: medium2, film, medium1 and, where there is one, effector."""
    sizes = [
        ("medium2", segment.medium2.thickness_mm, segment.medium2.material),
        ("film", segment.film.thickness_um * 1e-3, segment.film.material),
        ("medium1", segment.medium1.thickness_mm, segment.medium1.material),
    ]
    if segment.effector is not None:
        sizes.append(("effector", segment.effector.height_mm, segment.effector.material))
    result, bottom = [], 0.0
    for name, thickness, material in sizes:
        result.append(Layer(name, bottom, bottom + thickness, material))
        bottom += thickness
    return tuple(result)
