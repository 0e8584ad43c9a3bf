"""A printable part of the fabrication kit, the solids it is built from, and the limits of printers. Millimetres."""

import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, Literal, get_args

from foundation.errors import InputError
from foundation.nearest_name import nearest_name_hint
from geometry.fabrication.parameters import Fabrication, Printer
from geometry.solids import Part

Confidence = Literal["high", "medium", "low"]
LimitName = Literal[
    "build_x_mm",
    "build_y_mm",
    "build_z_mm",
    "layer_mm",
    "wall_mm",
    "supported_wall_mm",
    "feature_mm",
    "relief_mm",
    "gap_mm",
    "groove_mm",
    "hole_mm",
    "overhang_deg",
    "overhang_area_mm2",
    "deviation_mm",
]


@dataclass(frozen=True)
class Limit:
    """One number of a printer profile, its source, and the confidence in it."""

    value: float
    source: str
    confidence: Confidence


@dataclass(frozen=True)
class PrinterProfile:
    """The limits of one printer by name; profile["wall_mm"] is the number alone.

    build_x_mm, build_y_mm, build_z_mm : build volume. layer_mm : height of a layer.
    wall_mm : thinnest wall that stands free; supported_wall_mm : thinnest wall held on two sides or more.
    feature_mm : narrowest pin, rib, bump or dent; relief_mm : lowest bump and shallowest dent.
    gap_mm : narrowest slot that stays open; groove_mm : narrowest and shallowest channel in a face; hole_mm :
    narrowest hole.
    overhang_deg : slope from the horizontal below which the underside needs a support.
    overhang_area_mm2 : smaller undersides hold by themselves.
    deviation_mm : how far a size may come out from the drawing.
    """

    name: str
    title: str
    process: Literal["fdm", "sla"]
    limits: dict[LimitName, Limit]

    def __getitem__(self, name: LimitName) -> float:
        """The value of the limit of that name."""
        return self.limits[name].value


def printer_names() -> tuple[str, ...]:
    """Names of all printer profiles in the order of the table."""
    return tuple(_printer_table()["printers"])


@cache
def printer_profile(name: str) -> PrinterProfile:
    """A printer profile by its name. InputError, which names the nearest one, for an unknown one."""
    rows = _printer_table()["printers"]
    if name not in rows:
        raise InputError(f"--printer = '{name}': no such printer profile; {nearest_name_hint(name.lower(), rows)}")
    row, sources = rows[name], _printer_table()["sources"]
    limits = {
        key: Limit(value, sources[source], confidence)
        for key in get_args(LimitName)
        for value, source, confidence in [row[key]]
    }
    return PrinterProfile(name, row["title"], row["process"], limits)


@cache
def _printer_table() -> dict[str, Any]:
    return tomllib.loads(files(__package__).joinpath("printers.toml").read_text("utf-8"))


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
    """A printable solid where it lies in its own assembly, with what the build sheet says of it.

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
        """Sides of the bounding box in mm: x, y and z."""
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
    """A box from its intervals in x, y and z, in mm."""
    from build123d import Pos, Solid

    return Pos(x[0], y[0], z[0]) * Solid.make_box(x[1] - x[0], y[1] - y[0], z[1] - z[0])


def post(x: float, y: float, z: Interval, diameter: float) -> Any:
    """An upright cylinder at x, y, in mm: a pin, or what a hole takes away."""
    from build123d import Pos, Solid

    return Pos(x, y, z[0]) * Solid.make_cylinder(diameter / 2, z[1] - z[0])


def pin(x: float, y: float, z: Interval, diameter: float) -> Any:
    """A pin at x, y, in mm, whose tip is a cone that finds its hole: a sixth of the diameter smaller on each side."""
    from build123d import Pos, Solid

    lead = min(diameter / 4, (z[1] - z[0]) / 2)
    tip = Pos(x, y, z[1] - lead) * Solid.make_cone(diameter / 2, diameter / 3, lead)
    return fuse_solids(post(x, y, (z[0], z[1] - lead), diameter), [tip])


def fuse_solids(solid: Any, others: Iterable[Any]) -> Any:
    """Fuse solids that touch into one. RuntimeError where they do not hang together."""
    return _single_solid(solid.fuse(*others))


def subtract_solids(solid: Any, others: Iterable[Any]) -> Any:
    """Cut other solids away from one. RuntimeError where it falls to pieces."""
    tools = list(others)
    return _single_solid(solid.cut(*tools)) if tools else solid


def scale_solid(solid: Any, factor: float) -> Any:
    """Scale a solid about the origin."""
    from build123d import Solid
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform  # type: ignore[import-untyped]
    from OCP.gp import gp_Pnt, gp_Trsf  # type: ignore[import-untyped]

    change = gp_Trsf()
    change.SetScale(gp_Pnt(0.0, 0.0, 0.0), factor)
    return Solid(BRepBuilderAPI_Transform(solid.wrapped, change, True).Shape())


def shape_volume_mm3(shape: Any) -> float:
    """Volume in mm^3 of what a cut or an intersection returned; 0 for nothing."""
    if shape is None:
        return 0.0
    if isinstance(shape, list):
        return float(sum(one.volume for one in shape))
    return float(shape.volume)


def _single_solid(shape: Any) -> Any:
    solids = shape.solids()
    if len(solids) != 1:
        raise RuntimeError(f"a part of the kit falls into {len(solids)} pieces")
    return solids[0]


ROUNDING_MM = 1e-9


def refuse_thin(what: str, size_mm: float, least_mm: float, limit: str, advice: str) -> None:
    """Raise InputError for a size in mm below the limit.

    what : the key with its value, and what follows from it; limit : the name of the limit; advice : how to mend it.
    """
    if size_mm < least_mm - ROUNDING_MM:
        raise InputError(f"{what} of {max(size_mm, 0.0):.3g} mm, below {limit} of {least_mm:g} mm; {advice}")


def refuse_small_keys(
    fabrication: Fabrication, printer: PrinterProfile, checks: Iterable[tuple[str, str, float, str]]
) -> None:
    """Raise InputError for a size of the table [fabrication] that the printer cannot make.

    checks : key, what it is the size of, least in mm, name of the limit.
    """
    advice = "make it larger" if printer.process == "sla" else "make it larger or print with printer = 'sla'"
    for key, what, least_mm, limit in checks:
        value = getattr(fabrication, key)
        named = f"the {printer.process.upper()} limit for the {limit}"
        refuse_thin(f"fabrication.{key} = {value:g}: {what}", value, least_mm, named, advice)
