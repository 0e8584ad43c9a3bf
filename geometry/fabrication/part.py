"""A printable part of the fabrication kit."""

from dataclasses import dataclass
from typing import Any, Literal

from geometry.fabrication.parameters import Printer
from geometry.part import Part

Process = Literal["SLA", "FDM", "either"]

KIT_COLOURS: dict[str, str] = {
    "mould": "#d9c27e",
    "lid": "#a9c4d6",
    "frame": "#d3d6da",
    "jig": "#b9a8cf",
    "plate": "#8c929b",
}
"""Kind of part -> hex colour."""


@dataclass(frozen=True)
class FabricationPart(Part):
    """One printable solid, where it lies in its own assembly, with what the build sheet says of it.

    label : unique in a kit; names the file.
    material : what it is printed from, such as "SLA resin".
    process : what can print it.
    purpose : one sentence.
    copies : how many to print.
    """

    process: Process
    purpose: str
    copies: int

    @property
    def size_mm(self) -> tuple[float, float, float]:
        """Sides of the bounding box, x, y and z."""
        size = self.solid.bounding_box().size
        return (float(size.X), float(size.Y), float(size.Z))


PROCESSES: dict[Printer, Process] = {"sla": "SLA", "fdm": "FDM"}
PRINTED_FROM: dict[Process, str] = {"SLA": "SLA resin", "FDM": "FDM plastic", "either": "SLA resin or FDM plastic"}


def fabrication_part(
    label: str, solid: Any, kind: str, purpose: str, process: Process, copies: int = 1
) -> FabricationPart:
    """A part from a build123d Solid; its kind, a key of KIT_COLOURS, gives the colour."""
    from build123d import Color

    code = KIT_COLOURS[kind].lstrip("#")
    red, green, blue = (int(code[k : k + 2], 16) / 255 for k in (0, 2, 4))
    solid.label, solid.color = label, Color(red, green, blue)
    return FabricationPart(
        label=label,
        solid=solid,
        colour=(red, green, blue),
        material=PRINTED_FROM[process],
        rigid=True,
        printable=True,
        volume_mm3=float(solid.volume),
        process=process,
        purpose=purpose,
        copies=copies,
    )
