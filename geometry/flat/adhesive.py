"""Sheets of adhesive: a pad for each bonded face, and two rings on the panel of a film with a flange."""

import numpy as np

from geometry.fabrication.device import Device
from geometry.fabrication.frame_layout import WallRun, frame_layout
from geometry.fabrication.parameters import Fabrication
from geometry.flat.film import FilmLayout
from geometry.flat.film_sheet import device_count
from geometry.flat.panel import Panel
from geometry.flat.pattern import Circle, Dimension, FlatPattern, Outline, rectangle
from geometry.stack import Box, bodies, layers

LAYER_NAMES = {"effector": "effector", "medium1": "medium 1", "medium2": "medium 2"}
PAD_INSTRUCTION = "Bonds {where}: rub it onto the lower one, peel off the liner."
RING_INSTRUCTION = "Rub it onto the flange of the film, {where}; the {left} free."
JOINTS = (
    ("base", "medium2", "the frame and medium 2"),
    ("medium2", "film", "medium 2 and the film"),
    ("film", "medium1", "the film and medium 1"),
    ("medium1", "effector", "medium 1 and the effector"),
)


def adhesive_patterns(device: Device, fabrication: Fabrication, layout: FilmLayout, panel: Panel) -> list[FlatPattern]:
    """One pattern for each bonded face from the base up, and for a film with a flange two rings on its panel.

    A face between a layer that runs through and islands is bonded at the islands.
    """
    present = {layer.name for layer in layers(device.segment)}
    found = []
    for low, high, where in JOINTS:
        if high in present:
            own = high if device.piece_count(high) >= device.piece_count(low if low != "base" else high) else low
            cut, count = body_outline(own, device, layout), device_count(fabrication) * device.piece_count(own)
            title = f"Adhesive: {LAYER_NAMES.get(low, low)} to {LAYER_NAMES.get(high, high)}"
            found.append(_pad_pattern(f"{low}-{high}", title, cut, where, count, fabrication))
    return found + (_ring_patterns(device, fabrication, layout, panel) if layout.flange > 0.0 else [])


def body_outline(name: str, device: Device, layout: FilmLayout) -> Outline | Circle:
    """The outline of one piece of a layer on the layer CUT, seen from the cable."""
    source = device.stated_segment(name)
    body, halves = bodies(source)[-1], (source.length_mm / 2, source.width_mm / 2)
    if name == "effector":
        if not isinstance(body, Box):
            return Circle("CUT", (0.0, 0.0), float(body.reach(np.array([1.0, 0.0, 0.0]))), hole=False)
        halves = (body.half_x, body.half_y)
    u0, u1, v0, v1 = layout.frame.rectangle_in_frame((-halves[0], halves[0], -halves[1], halves[1]))
    return rectangle("CUT", (u0, u1), (v0, v1))


def body_dimensions(cut: Outline | Circle) -> tuple[Dimension, ...]:
    """The dimensions of an outline: both sides of a rectangle, or the diameter of a circle."""
    if isinstance(cut, Circle):
        return (Dimension((-cut.radius, 0.0), (cut.radius, 0.0), "x", -cut.radius - 1.5),)
    (u0, v0), _, (u1, v1), _ = cut.points
    return (Dimension((u0, v0), (u1, v0), "x", -1.5), Dimension((u0, v0), (u0, v1), "y", -1.5))


def _pad_pattern(
    name: str, title: str, cut: Outline | Circle, where: str, count: int, fabrication: Fabrication
) -> FlatPattern:
    """The pattern of an adhesive, to be cut `count` times; where : words for the place at which it is laid."""
    return FlatPattern(
        name=f"adhesive-{name}",
        title=title,
        material="double-sided adhesive sheet",
        thickness_mm=fabrication.adhesive_thickness_mm,
        count=count,
        instruction=PAD_INSTRUCTION.format(where=where),
        cuts=(cut,),
        dimensions=body_dimensions(cut),
        kerf_mm=fabrication.kerf_mm,
    )


def _ring_patterns(device: Device, fabrication: Fabrication, layout: FilmLayout, panel: Panel) -> list[FlatPattern]:
    case = frame_layout(device, fabrication)
    faces: list[tuple[str, WallRun, str]] = []
    if case.body is not None:
        faces.append(("lower", case.body, "on the face towards the body of the frame"))
    if case.ring:
        faces.append(("upper", case.ring[0], "on the face towards the ring of the frame"))
    return [
        _ring_pattern(name, run, where, fabrication, layout, panel)
        for name, run, where in faces
        if run.gap < layout.flange
    ]


def _ring_pattern(
    name: str, run: WallRun, where: str, fabrication: Fabrication, layout: FilmLayout, panel: Panel
) -> FlatPattern:
    """A ring as wide as the film, with the openings of the frame as windows.

    Its webs between several windows bond the film to a grid.
    """
    end, half, back = layout.body_end, layout.half_body, layout.back_end
    gap = run.gap
    windows = [((u0 - gap, u1 + gap), (v0 - gap, v1 + gap)) for u0, u1, v0, v1 in run.feet]
    (inner_u, inner_v), several = windows[0], len(windows) > 1
    rub = RING_INSTRUCTION.format(
        where=where, left="windows leave the pressed parts" if several else "window leaves the pressed part"
    )
    return FlatPattern(
        name=f"adhesive-flange-{name}",
        title=f"Adhesive: {name} ring on the film's flange",
        material="double-sided adhesive sheet",
        thickness_mm=fabrication.adhesive_thickness_mm,
        count=device_count(fabrication),
        instruction=f"Pin its panel onto that of the film before the film is cut out. {rub}",
        cuts=(
            *panel.cuts,
            rectangle("CUT", (-back, end), (-half, half)),
            *(rectangle("CUT", u, v, hole=True) for u, v in windows),
        ),
        marks=(panel.edge_label(f"RING, {name}"),),
        dimensions=(
            *panel.dimensions,
            Dimension((-back, half), (end, half), "x", 1.2),
            Dimension((-back, -half), (-back, half), "y", -1.4),
            Dimension((inner_u[0], inner_v[0]), (inner_u[1], inner_v[0]), "x", -2.2),
            Dimension((inner_u[1], inner_v[0]), (inner_u[1], inner_v[1]), "y", 2.2),
        ),
        kerf_mm=fabrication.kerf_mm,
    )
