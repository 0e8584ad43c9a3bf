"""What a run will cost: elements, unknowns, time and memory, from measured runs; what no computer holds is refused.

Measured on two cores of an EPYC without other work (docs/speed.md): 0.29 s a Newton iteration at 14,800 unknowns,
2.9 s at 68,400, about seven iterations a load step where the path does not ask for more.
"""

from dataclasses import dataclass

import numpy as np

from geometry.base import InputError
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.build import MeshOptions, build
from mesh.outline import outline
from mesh.sizing import sizing
from softdot.config import Config
from softdot.machine import needed_GB, refuse_too_little_memory

TOO_MANY = 1_000_000
POINTS = 100_000
FILL = 6.0 * np.sqrt(2.0)
"""A regular tetrahedron of edge h has the volume h^3 / (6 sqrt 2)."""
PRISMS = 12.0 / np.sqrt(3.0)


def refuse_huge_mesh(segment: Segment, dot_shape: DotShape, options: MeshOptions) -> None:
    """InputError when the wished edge lengths mean more than a million elements, or more than fit into memory.

    Of mesh.file the elements are counted; InputError too when it is no mesh of the segment.
    """
    count = expected_tetrahedra(segment, dot_shape, options)
    if options.file is not None:
        if count > TOO_MANY:
            raise InputError(f"mesh.file = '{options.file}': has {count:.0f} elements, at most {TOO_MANY} are allowed")
        refuse_too_little_memory(count, segment.section == "plane-strain", "file", options.file)
        return
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

    A slice is one layer of triangles of area sqrt 3 / 4 h^2, each of three tetrahedra. Of mesh.file their number.
    """
    if options.file is not None:
        return float(len(build(segment, dot_shape, options).tets))
    sliced = segment.section == "plane-strain"
    shape = outline(segment, slice_mm=options.contact_element_size_mm) if sliced else outline(segment)
    field = sizing(shape, dot_shape, options)
    high = np.array([shape.half_x, shape.half_y, shape.top])
    low = np.array([-shape.half_x, -shape.half_y, 0.0])
    points = np.random.default_rng(0).uniform(low, high, (POINTS, 3))
    if sliced:
        return float((high - low)[0] * (high - low)[2] * np.mean(PRISMS / field.at(points) ** 2))
    return float(np.prod(high - low) * np.mean(FILL / field.at(points) ** 3))


UNKNOWNS_PER_TETRAHEDRON = {"solid": 4.4, "plane-strain": 1.6}
ITERATIONS = 7
ITERATION_S, AT_UNKNOWNS, EXPONENT = 2.9, 68_400, 1.5
SOLIDS_AND_PICTURES_S, MESH_S_PER_TETRAHEDRON = 15.0, 3e-4
COMPILE_S = 60.0


@dataclass(frozen=True)
class Cost:
    """Expected size of a run; first_run_s : more on a machine that has not compiled the element kernels yet."""

    tetrahedra: int
    unknowns: int
    time_s: float
    first_run_s: float
    memory_GB: float


def expected_cost(config: Config, dot_shape: DotShape) -> Cost:
    """Cost of a run. Waveforms that are followed in time, slides and mechanisms may take several times as long."""
    count = expected_tetrahedra(config.segment, dot_shape, config.mesh)
    unknowns = UNKNOWNS_PER_TETRAHEDRON[config.segment.section] * count
    solve_s = ITERATIONS * config.press.load_steps * ITERATION_S * (unknowns / AT_UNKNOWNS) ** EXPONENT
    time_s = SOLIDS_AND_PICTURES_S + MESH_S_PER_TETRAHEDRON * count + solve_s
    return Cost(
        tetrahedra=_rounded(count),
        unknowns=_rounded(unknowns),
        time_s=float(_rounded(time_s)),
        first_run_s=COMPILE_S,
        memory_GB=round(needed_GB(count, config.segment.section == "plane-strain"), 1),
    )


def _rounded(value: float) -> int:
    """Two digits: more would claim too much."""
    return int(float(f"{value:.2g}"))
