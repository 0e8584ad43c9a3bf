"""Contents of the build sheet: the kit, its bill of materials, where and how a layer is measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from export.printability import Printability
from geometry.fabrication.device import Device, rim_gap_mm
from geometry.fabrication.frame_layout import FrameLayout, frame_layout
from geometry.fabrication.kit import SolidKit, jig_device, stacked_tops
from geometry.fabrication.parameters import Fabrication, release_note
from geometry.fabrication.part import FabricationPart
from geometry.flat.flat_kit import FlatKit
from geometry.flat.spacers import spaced_layers
from geometry.parameters import Segment
from geometry.stack import Box, Disc, Dome, Layer, bodies, layers
from solve.model import Readout

MEDIUM_NAMES = {"medium1": "medium 1", "medium2": "medium 2"}
RESIN_G_CM3 = 1.15
"""Approximate density of a printed part: resins 1.1 to 1.2, PLA 1.24."""


@dataclass(frozen=True)
class Contents:
    """All that the build sheet shows. device : what is made. densities_g_cm3 : by layer.

    permittivity : relative, of the film. printability : one for each printed part.
    budget : the tolerance budget as it stands in kit.json, None where there is none, and budget_note says why.
    crosstalk : the budget of an array's crosstalk as it stands in kit.json, None where there is none.
    readout : the stated amplifier. press : what is pressed, in words. pressed : what the budget is of, in words.
    """

    device: Device
    fabrication: Fabrication
    solid: SolidKit
    flat: FlatKit
    densities_g_cm3: Mapping[str, float]
    permittivity: float
    printability: tuple[Printability, ...]
    budget: Mapping[str, Any] | None
    crosstalk: Mapping[str, Any] | None
    budget_note: str
    press: str
    pressed: str
    warnings: tuple[str, ...]
    readout: Readout | None = None

    @property
    def segment(self) -> Segment:
        """One of the segments of the device."""
        return self.device.segment

    @property
    def copies(self) -> int:
        """Number of devices in one clamp frame."""
        return self.fabrication.array[0] * self.fabrication.array[1]

    @property
    def frame(self) -> FrameLayout:
        """Layout of the clamp frame."""
        return frame_layout(self.device, self.fabrication)

    @property
    def rim_gap_mm(self) -> float:
        """Glue line beside the layers that are held."""
        return rim_gap_mm(self.device.stack, self.fabrication)

    @property
    def has_silicone(self) -> bool:
        """Whether a part is cast of silicone, on which acrylic adhesive does not hold."""
        return any(pour.release == release_note("silicone") for pour in self.solid.pours)

    @property
    def side_glue(self) -> str:
        """Glue for the sides of held layers."""
        return "silicone adhesive (such as Sil-Poxy)" if self.has_silicone else "flexible adhesive"

    @property
    def layers(self) -> tuple[Layer, ...]:
        """Layers of a segment from the base upwards."""
        return layers(self.segment)

    @property
    def centers(self) -> list[tuple[float, float]]:
        """Centres (x, y) of the devices of one frame, in mm."""
        return [self.frame.frame.point_in_device(place) for place in self.frame.centers]

    @property
    def stacked_tops_mm(self) -> dict[str, float]:
        """Name -> height in mm over the floor of the jig of the layers that are stacked in it."""
        return stacked_tops(self.device, self.fabrication)

    @property
    def jig_device(self) -> Device:
        """The device that is stacked in the jig at once."""
        return jig_device(self.device, self.fabrication)

    @property
    def spaced_layers(self) -> list[str]:
        """Names of the layers of islands that strips keep apart while they are bonded."""
        return spaced_layers(self.device)

    @property
    def what(self) -> str:
        """The word for the device, "array" or "segment"."""
        return "array" if self.device.is_array else "segment"

    def part(self, label: str) -> FabricationPart | None:
        """The printed part of a label, or None."""
        return next((part for part in self.solid.parts if part.label == label), None)


def layer_title(name: str) -> str:
    """Name of a layer in a table."""
    return MEDIUM_NAMES.get(name, name)


def layer_in_sentence(name: str) -> str:
    """Name of a layer in a sentence."""
    return MEDIUM_NAMES.get(name, f"the {name}")


@dataclass(frozen=True)
class Component:
    """A layer of the finished device: sizes, volume and mass of one piece, and how many pieces there are."""

    name: str
    pieces: int
    material: str
    made: str
    size: str
    volume_mm3: float
    mass_mg: float


def components(contents: Contents) -> list[Component]:
    """The layers of the finished device, from the top down."""
    cast = {pour.component: pour for pour in contents.solid.pours}
    found = []
    for layer in reversed(contents.layers):
        solid = contents.device.piece(layer.name)
        size, volume = solid.bounding_box().size, float(solid.volume)
        thick = f"{1e3 * size.Z:.3g} µm" if layer.name == "film" else f"{size.Z:.4g} mm"
        made, density = "cut from sheet", contents.densities_g_cm3[layer.name]
        if layer.name in cast:
            pour = cast[layer.name]
            made, density = f"cast from {pour.recipe}", 1e3 * pour.poured_mass_g / pour.poured_volume_mm3
        made = "cut from film" if layer.name == "film" else made
        effector = contents.segment.effector
        around = layer.name == "effector" and effector is not None and effector.shape in ("cylinder", "dome")
        wide = f"{size.X:.4g} mm across" if around else f"{size.X:.4g} × {size.Y:.4g} mm"
        size_text = f"{wide}, {thick}{' high' if around else ''}{_grooves_text(contents, layer.name)}"
        pieces = contents.device.piece_count(layer.name)
        found.append(
            Component(layer_title(layer.name), pieces, layer.material, made, size_text, volume, density * volume)
        )
    return found


def _grooves_text(contents: Contents, name: str) -> str:
    """Words on the grooves of a layer, to follow its size."""
    grooves = contents.device.layout.grooves(name)
    return "".join(f", grooves {one.width_mm:g} mm wide and {one.depth_mm:g} mm deep" for one in grooves)


GAUGE_ADVICE = (
    "Use a thickness gauge that barely presses, or a microscope with a scale: a calliper squeezes soft rubber."
)


@dataclass(frozen=True)
class Gauging:
    """Where and how the thickness of a layer is measured.

    shape : "box", "cylinder" or "dome". quantity : "thickness" or "height", of size_mm. where : the points.
    foot : what to measure across and its sizes as text, None for a layer as wide as the segment. grip : where to hold
    it. keep : which of the cast parts are good, to follow "Keep the parts".
    """

    shape: str
    quantity: str
    size_mm: float
    where: str
    foot: tuple[str, str] | None
    grip: str
    keep: str


def gauging(contents: Contents, name: str) -> Gauging:
    """How a layer other than the film is measured."""
    layer = next(one for one in contents.layers if one.name == name)
    source, size = contents.device.stated_segment(name), layer.thickness_mm
    body = bodies(source)[-1]
    if name == "effector" and isinstance(body, Disc | Dome):
        across = 2 * float(body.reach(np.array([1.0, 0.0, 0.0])))
        foot = ("diameter of its foot", f"{across:.4g} mm")
        if isinstance(body, Dome):
            keep = f"whose crown is {size:.4g} mm above their base and whose foot is {across:.4g} mm across"
            return Gauging("dome", "height", size, "from its base to its crown", foot, "at the edge", keep)
        keep = f"that are {size:.4g} mm high in the middle and all around the rim, and {across:.4g} mm across"
        return Gauging("cylinder", "height", size, "in the middle and all around its rim", foot, "at the rim", keep)
    keep, sides = f"that are {size:.4g} mm thick at all four corners", None
    if name == "effector" and isinstance(body, Box):
        length, width = 2 * body.half_x, 2 * body.half_y
        if (length, width) != (source.length_mm, source.width_mm):
            sides = ("length (x) and width (y) of its foot", f"{length:.4g} × {width:.4g} mm")
            keep += f", and {length:.4g} × {width:.4g} mm wide"
    return Gauging("box", "thickness", size, "at its four corners", sides, "at a corner", keep)
