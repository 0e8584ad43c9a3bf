"""Refuse a mesh that no desktop computer can hold, before the mesher fills the memory."""

import numpy as np

from geometry.base import InputError
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.outline import outline
from mesh.parameters import MeshOptions
from mesh.sizing import sizing
from softdot.memory import refuse_too_little_memory

TOO_MANY = 1_000_000
POINTS = 100_000
FILL = 6.0 * np.sqrt(2.0)
"""A regular tetrahedron of edge h has the volume h^3 / (6 sqrt 2)."""
PRISMS = 12.0 / np.sqrt(3.0)


def refuse_huge_mesh(segment: Segment, dot_shape: DotShape, options: MeshOptions) -> None:
    """InputError when the wished edge lengths mean more than a million elements, or more than fit into memory."""
    count = expected_tetrahedra(segment, dot_shape, options)
    sizes = {name: value for name, value in options if name.endswith("size_mm") and value is not None}
    name = min(sizes, key=lambda one: float(sizes[one]))
    if count > TOO_MANY:
        raise InputError(
            f"mesh.{name} = {sizes[name]:g}: means about {count:.1g} elements, "
            f"at most {TOO_MANY:.0g} are allowed; use a larger size"
        )
    refuse_too_little_memory(count, segment.section == "plane-strain", name, float(sizes[name]))


def expected_tetrahedra(segment: Segment, dot_shape: DotShape, options: MeshOptions) -> float:
    """Rough number of elements of the soft layers: the mean of 6 sqrt 2 / h^3 over points in the stack.

    A slice is one layer of triangles of area sqrt 3 / 4 h^2, each of three tetrahedra.
    """
    sliced = segment.section == "plane-strain"
    shape = outline(segment, slice_mm=options.contact_element_size_mm) if sliced else outline(segment)
    field = sizing(shape, dot_shape, options)
    high = np.array([shape.half_x, shape.half_y, shape.top])
    low = np.array([-shape.half_x, -shape.half_y, 0.0])
    points = np.random.default_rng(0).uniform(low, high, (POINTS, 3))
    if sliced:
        return float((high - low)[0] * (high - low)[2] * np.mean(PRISMS / field.at(points) ** 2))
    return float(np.prod(high - low) * np.mean(FILL / field.at(points) ** 3))
