"""Adhesive sheets: pads between the layers, and rings that hold the flange of the film in its frame."""

import numpy as np

from geometry.bodies import Box, bodies
from geometry.fabrication.exit_frame import ExitFrame
from geometry.fabrication.frame_layout import frame_layout
from geometry.fabrication.parameters import Fabrication
from geometry.flat.layout import FilmLayout
from geometry.flat.panel import Panel
from geometry.flat.pattern import Circle, Dimension, FlatPattern, Outline, rectangle
from geometry.parameters import Segment

PAD = "Bonds {where}: rub it onto the lower one, peel off the liner."
RING = "Rub it onto the flange of the film, {where}; the window leaves the pressed part free."


def adhesive_patterns(
    segment: Segment, fabrication: Fabrication, layout: FilmLayout, panel: Panel
) -> list[FlatPattern]:
    """One pad for each bonded face from the base up, and for a film with a flange two rings on its panel."""
    frame = layout.frame
    whole = body_outline("medium2", segment, frame)
    foot = body_outline("effector", segment, frame)
    joints = [
        ("base-medium2", "Adhesive: base to medium 2", whole, "the frame and medium 2"),
        ("medium2-film", "Adhesive: medium 2 to film", whole, "medium 2 and the film"),
        ("film-medium1", "Adhesive: film to medium 1", whole, "the film and medium 1"),
    ]
    if segment.effector is not None:
        joints.append(("medium1-effector", "Adhesive: medium 1 to effector", foot, "medium 1 and the effector"))
    found = [_pad(name, title, cut, where, fabrication) for name, title, cut, where in joints]
    return found + (_rings(segment, fabrication, layout, panel) if layout.flange > 0.0 else [])


def body_outline(name: str, segment: Segment, frame: ExitFrame) -> Outline | Circle:
    """The outline of a layer on CUT, seen from its cable."""
    body = bodies(segment)[-1]
    halves = (segment.length_mm / 2, segment.width_mm / 2)
    if name == "effector" and segment.effector is not None:
        if not isinstance(body, Box):
            return Circle("CUT", (0.0, 0.0), float(body.reach(np.array([1.0, 0.0, 0.0]))), hole=False)
        halves = (body.half_x, body.half_y)
    along, across = halves if frame.turn_deg in (0.0, 180.0) else halves[::-1]
    return rectangle("CUT", (-along, along), (-across, across))


def body_dimensions(cut: Outline | Circle) -> tuple[Dimension, ...]:
    """Both sizes of a rectangle, or the diameter."""
    if isinstance(cut, Circle):
        return (Dimension((-cut.radius, 0.0), (cut.radius, 0.0), "x", -cut.radius - 1.5),)
    (u0, v0), _, (u1, v1), _ = cut.points
    return (Dimension((u0, v0), (u1, v0), "x", -1.5), Dimension((u0, v0), (u0, v1), "y", -1.5))


def _pad(name: str, title: str, cut: Outline | Circle, where: str, fabrication: Fabrication) -> FlatPattern:
    return FlatPattern(
        name=f"adhesive-{name}",
        title=title,
        material="double-sided adhesive sheet",
        thickness_mm=fabrication.adhesive_thickness_mm,
        count=fabrication.array[0] * fabrication.array[1],
        instruction=PAD.format(where=where),
        cuts=(cut,),
        dimensions=body_dimensions(cut),
        kerf_mm=fabrication.kerf_mm,
    )


def _rings(segment: Segment, fabrication: Fabrication, layout: FilmLayout, panel: Panel) -> list[FlatPattern]:
    case = frame_layout(segment, fabrication)
    faces = []
    if case.body is not None:
        faces.append(("lower", case.body.gap, "on the face towards the body of the frame"))
    if case.ring:
        faces.append(("upper", case.ring[0].gap, "on the face towards the ring of the frame"))
    return [_ring(name, gap, where, fabrication, layout, panel) for name, gap, where in faces if gap < layout.flange]


def _ring(name: str, gap: float, where: str, fabrication: Fabrication, layout: FilmLayout, panel: Panel) -> FlatPattern:
    end, half = layout.body_end, layout.half_body
    inner_u, inner_v = layout.frame.along / 2 + gap, layout.frame.across / 2 + gap
    return FlatPattern(
        name=f"adhesive-flange-{name}",
        title=f"Adhesive: {name} ring on the film's flange",
        material="double-sided adhesive sheet",
        thickness_mm=fabrication.adhesive_thickness_mm,
        count=fabrication.array[0] * fabrication.array[1],
        instruction=f"Pin its panel onto that of the film before the film is cut out. {RING.format(where=where)}",
        cuts=(
            *panel.cuts,
            rectangle("CUT", (-end, end), (-half, half)),
            rectangle("CUT", (-inner_u, inner_u), (-inner_v, inner_v), hole=True),
        ),
        marks=(panel.words(f"RING, {name}"),),
        dimensions=(
            *panel.dimensions,
            Dimension((-end, half), (end, half), "x", 1.2),
            Dimension((-end, -half), (-end, half), "y", -1.4),
            Dimension((-inner_u, -inner_v), (inner_u, -inner_v), "x", -2.2),
            Dimension((inner_u, -inner_v), (inner_u, inner_v), "y", 2.2),
        ),
        kerf_mm=fabrication.kerf_mm,
    )
