"""The dot stands elsewhere: as far aside as half of its contact stays over the segment, and clear of a held rim."""

from collections.abc import Iterator, Sequence
from math import sqrt
from typing import Any

import numpy as np

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scene import Scene
from geometry.dot_size import dot_size
from geometry.electrode_outlines import electrode_outlines
from geometry.part_checks import covers_footprint
from geometry.stack import layers
from solve.mechanisms.boundaries.dot_offset import DOT_OFFSET
from solve.symmetry import electrode_images

NODES = 0.35, 0.7, 1.0  # of the way to the side
BY_HAND_MM = 0.15, 0.4  # 0.1 to 0.3 by hand
FREE_OF_RIM = 1.05  # of the half width of the dot at the deepest press
LEAST_REACH = 0.04  # of the segment, for a dot that stands at its side already


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any dot but a plate, which has no middle."""
    if scene.model.dot.shape != "plate":
        yield _offset(scene)


def _offset(scene: Scene) -> Candidate:
    """Along x, and of a solid along y; to one side only where the rig is the same on both."""
    axes = (0, 1) if scene.model.segment.section == "solid" else (0,)
    coordinates = tuple(_aside(scene, axis) for axis in axes)
    either = ("offset_mm",) if all(coordinate.low == 0.0 for coordinate in coordinates) else ()

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"offset_mm": (*values, 0.0)[:2]}

    return Candidate(DOT_OFFSET.name, "dot", coordinates, parameters, units={"offset_mm": "mm"}, either_sign=either)


def _aside(scene: Scene, axis: int) -> Coordinate:
    segment = scene.model.segment
    size = (segment.length_mm, segment.width_mm)[axis]
    reach = 0.5 * size - _clearance_mm(scene)
    at = [scene.model.dot.offset_mm[axis] + place[axis] for place in scene.places]
    low, high = min(-reach - min(at), -LEAST_REACH * size), max(reach - max(at), LEAST_REACH * size)
    name, starts = f"offset_{'xy'[axis]}_mm", [min(start, high) for start in BY_HAND_MM]
    if _is_symmetric(scene, axis):
        return Coordinate(name, 0.0, high, tuple(starts), tuple(share * high for share in NODES))
    nodes = *(share * low for share in NODES), *(share * high for share in NODES)
    return Coordinate(name, low, high, (starts[0], max(-BY_HAND_MM[0], low)), nodes)


def _clearance_mm(scene: Scene) -> float:
    """Least distance of the dot's middle from a side: of a held rim, which cannot give way, the dot stays clear.

    Elsewhere half of Hertz's radius of contact, sqrt(R d), stays over the segment.
    """
    segment, depth = scene.model.segment, scene.depth_mm
    radius = dot_size(scene.model.dot).radius_mm
    rim = segment.boundary == "clamped" and layers(segment)[-1].name in segment.held_layers
    if rim and covers_footprint(segment):
        return FREE_OF_RIM * sqrt(depth * (2.0 * radius - depth)) if depth < radius else FREE_OF_RIM * radius
    return 0.5 * sqrt(min(radius, segment.length_mm) * depth)


def _is_symmetric(scene: Scene, axis: int) -> bool:
    """Whether a dot that much to one side presses as one that much to the other, in every run."""
    film = scene.model.segment.film
    centred = [scene.model.dot.offset_mm[axis], *(place[axis] for place in scene.places)]
    centred += [patch.center_mm[axis] for patch in scene.model.physics.delaminations]
    upright = not any(scene.model.dot.tilt_deg) and scene.model.dot.cell is None
    images = electrode_images(electrode_outlines(scene.model.segment), axis)
    own = images is not None and bool((images == np.arange(len(images))).all())
    return not any(centred) and own and upright and film.draw_angle_deg % 90.0 == 0.0


register(Vocabulary(DOT_OFFSET, "{} is not where rig.toml places it", of_segment=of_segment))
