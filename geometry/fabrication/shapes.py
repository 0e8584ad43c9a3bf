"""Boxes, pins and cuts that all parts of the kit are made of. Lengths in millimetres."""

from collections.abc import Iterable
from typing import Any

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
