"""Whether a user's own mesh is one of the configured segment; every refusal is one sentence that names mesh.file."""

import numpy as np

from geometry.arrays import Floats, Ints
from geometry.base import InputError
from mesh.outline import StackOutline, curved_surface
from mesh.quadratic import TOLERANCE_MM
from mesh.quality import jacobians, volumes
from mesh.types import TET_FACES, face_neighbours, signed_volumes

FLAT_PARTS, ROUND = 1e-4, 0.05
"""Relative error allowed of the volume of a part with plane faces, and of volume and size of a round effector."""
AXES = "xyz"


def refuse_inverted_elements(points: Floats, tets: Ints, where: str) -> None:
    """InputError where an element, of four nodes or ten, has no positive volume at each of its sample points."""
    if tets.shape[1] == 4:
        bad = signed_volumes(points, tets) <= 0
    else:
        bad = (np.linalg.det(jacobians(points[tets])) <= 0).any(axis=1)
    if bad.any():
        raise InputError(
            f"{where}: {bad.sum()} of {len(tets)} elements are inverted or flat; every element must have a positive "
            "volume in the order of its nodes"
        )


def refuse_other_outline(
    points: Floats, tets: Ints, region: Ints, names: tuple[str, ...], stack: StackOutline, where: str
) -> None:
    """InputError where a part is not where the configured segment has it, or not of its volume.

    points (n, 3) in mm, tets (m, 10), region (m,) index into names.
    """
    exact, found = stack.volumes(), np.bincount(region, volumes(points[tets]), len(names))
    for number, name in enumerate(names):
        corners = points[np.unique(tets[region == number, :4])]
        is_round = name == "effector" and curved_surface(stack) is not None
        for axis, (low, high) in enumerate(_box(name, stack)):
            allowed = ROUND * (high - low) if is_round else TOLERANCE_MM
            is_low, is_high = corners[:, axis].min(), corners[:, axis].max()
            if not (-TOLERANCE_MM <= is_low - low <= allowed and -TOLERANCE_MM <= high - is_high <= allowed):
                raise InputError(
                    f"{where}: {name} reaches from {is_low:.6g} to {is_high:.6g} mm in {AXES[axis]}, it must as in the "
                    f"configuration reach from {low:.6g} to {high:.6g} mm"
                )
        if abs(found[number] / exact[name] - 1.0) > (ROUND if is_round else FLAT_PARTS):
            raise InputError(
                f"{where}: {name} has a volume of {found[number]:.6g} mm³, it must as in the configuration have "
                f"{exact[name]:.6g} mm³"
            )
    _refuse_beyond_skin(points, tets, stack, where)


def _box(name: str, stack: StackOutline) -> list[tuple[float, float]]:
    """Lowest and highest x, y and z of a part."""
    heights = {
        "medium2": (0.0, stack.film_bottom),
        "film": (stack.film_bottom, stack.film_top),
        "medium1": (stack.film_top, stack.medium1_top),
        "effector": (stack.medium1_top, stack.top),
    }
    x, y = (stack.effector_half_x, stack.effector_half_y) if name == "effector" else (stack.half_x, stack.half_y)
    return [(-x, x), (-y, y), heights[name]]


def _refuse_beyond_skin(points: Floats, tets: Ints, stack: StackOutline, where: str) -> None:
    """A round effector must not bulge; its corners may lie inside the round skin, as those of flat facets do."""
    surface = curved_surface(stack)
    if surface is None:
        return
    corners = points[np.unique(tets[:, :4])]
    beyond = surface.distance(corners[corners[:, 2] > stack.medium1_top + TOLERANCE_MM])
    if len(beyond) and beyond.max() > TOLERANCE_MM:
        raise InputError(
            f"{where}: a node of effector lies {beyond.max():.3g} mm outside the round skin of the configuration; "
            "it must lie on it or inside"
        )


def refuse_open_interfaces(
    points: Floats, tets: Ints, region: Ints, names: tuple[str, ...], stack: StackOutline, where: str
) -> None:
    """InputError where elements do not share their nodes: an outer face that is neither base, side, cut nor skin.

    MeshingError where more than two elements share a face.
    """
    owner, face = np.nonzero(face_neighbours(tets[:, :4]) < 0)
    corner = points[tets[owner[:, None], TET_FACES[face, :3]]]
    z = corner[..., 2]
    ends = np.array([stack.half_x, stack.half_y])
    on_sides = (np.abs(np.abs(corner[..., :2]) - ends) < TOLERANCE_MM).all(axis=1).any(axis=1)
    is_skin = z.min(axis=1) > stack.medium1_top - TOLERANCE_MM
    if "effector" in names:
        is_skin &= (region[owner] != names.index("effector")) | (z.max(axis=1) > stack.medium1_top + TOLERANCE_MM)
    inside = ~(on_sides | is_skin | (np.abs(z) < TOLERANCE_MM).all(axis=1))
    if inside.any():
        first = np.flatnonzero(inside)[0]
        raise InputError(
            f"{where}: {inside.sum()} faces inside the segment, such as one of {names[region[owner[first]]]} at "
            f"z = {z[first].mean():.6g} mm, belong to one element only; neighbouring parts must share the nodes of "
            "their interface"
        )


def refuse_other_slice(points: Floats, tets: Ints, stack: StackOutline, where: str) -> None:
    """InputError unless a plane-strain slice is one layer of elements with the same x and z on both of its faces."""
    corners = points[np.unique(tets[:, :4])]
    low, high = (np.abs(corners[:, 1] - y) < TOLERANCE_MM for y in (-stack.half_y, stack.half_y))
    one, other = (np.unique(np.round(corners[on][:, [0, 2]] / TOLERANCE_MM), axis=0) for on in (low, high))
    if not (low | high).all() or not np.array_equal(one, other):
        raise InputError(
            f"{where}: segment.section = 'plane-strain' needs one layer of elements in y, centred at y = 0, with "
            "corners of the same x and z on both of its faces"
        )
