"""A printable part of the fabrication kit: the shapes it is made of, and the least sizes of a printer. Millimetres."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

from geometry.base import InputError
from geometry.fabrication.parameters import Fabrication, Printer
from geometry.fabrication.printers import PrinterProfile
from geometry.solids import Part

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


Interval = tuple[float, float]


def box(x: Interval, y: Interval, z: Interval) -> Any:
    """A box from its intervals."""
    from build123d import Pos, Solid

    return Pos(x[0], y[0], z[0]) * Solid.make_box(x[1] - x[0], y[1] - y[0], z[1] - z[0])


def post(x: float, y: float, z: Interval, diameter: float) -> Any:
    """An upright cylinder: a pin, or what a hole takes away."""
    from build123d import Pos, Solid

    return Pos(x, y, z[0]) * Solid.make_cylinder(diameter / 2, z[1] - z[0])


def pin(x: float, y: float, z: Interval, diameter: float) -> Any:
    """A pin whose tip is a cone that finds its hole: a sixth of the diameter smaller on each side."""
    from build123d import Pos, Solid

    lead = min(diameter / 4, (z[1] - z[0]) / 2)
    tip = Pos(x, y, z[1] - lead) * Solid.make_cone(diameter / 2, diameter / 3, lead)
    return joined(post(x, y, (z[0], z[1] - lead), diameter), [tip])


def joined(solid: Any, others: Iterable[Any]) -> Any:
    """One solid from several that touch. RuntimeError where they do not hang together."""
    return _single(solid.fuse(*others))


def without(solid: Any, others: Iterable[Any]) -> Any:
    """What is left of a solid. RuntimeError where it falls to pieces."""
    tools = list(others)
    return _single(solid.cut(*tools)) if tools else solid


def scaled(solid: Any, factor: float) -> Any:
    """A solid scaled about the origin."""
    from build123d import Solid
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform  # type: ignore[import-untyped]
    from OCP.gp import gp_Pnt, gp_Trsf  # type: ignore[import-untyped]

    change = gp_Trsf()
    change.SetScale(gp_Pnt(0.0, 0.0, 0.0), factor)
    return Solid(BRepBuilderAPI_Transform(solid.wrapped, change, True).Shape())


def volume(shape: Any) -> float:
    """Volume of whatever a cut or an intersection returned; 0 for nothing."""
    if shape is None:
        return 0.0
    if isinstance(shape, list):
        return float(sum(one.volume for one in shape))
    return float(shape.volume)


def _single(shape: Any) -> Any:
    solids = shape.solids()
    if len(solids) != 1:
        raise RuntimeError(f"a part of the kit falls into {len(solids)} pieces")
    return solids[0]


ROUNDING_MM = 1e-9


def refuse_thin(what: str, size_mm: float, least_mm: float, limit: str, advice: str) -> None:
    """InputError for a size in mm below the limit.

    what : the key with its value, and what follows from it; limit : the name of the limit; advice : how to mend it.
    """
    if size_mm < least_mm - ROUNDING_MM:
        raise InputError(f"{what} of {max(size_mm, 0.0):.3g} mm, below {limit} of {least_mm:g} mm; {advice}")


def refuse_small_keys(
    fabrication: Fabrication, printer: PrinterProfile, checks: Iterable[tuple[str, str, float, str]]
) -> None:
    """InputError for a size of the table [fabrication] that the printer cannot make.

    checks : key, what it is the size of, least in mm, name of the limit.
    """
    advice = "make it larger" if printer.process == "sla" else "make it larger or print with printer = 'sla'"
    for key, what, least_mm, limit in checks:
        value = getattr(fabrication, key)
        named = f"the {printer.process.upper()} limit for the {limit}"
        refuse_thin(f"fabrication.{key} = {value:g}: {what}", value, least_mm, named, advice)
