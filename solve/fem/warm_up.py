"""Compile what every press of rubber and film calls, on one element of one point, so that two processes share it."""

from pathlib import Path

import numpy as np

from solve.fem.assembly import scatter
from solve.fem.film_solid import film_solid
from solve.fem.kinematics import cauchy_green, deformation_gradient, green_lagrange, smallest_jacobian
from solve.fem.mixed_solid import mixed_solid
from solve.fem.pattern import build_pattern
from solve.materials.invariants import isochoric_stress

ONE = np.ones((1, 1))
GRADIENT, STILL, F = np.zeros((1, 1, 10, 3)), np.zeros((1, 10, 3)), np.eye(3)[None, None]
STRESS, TANGENT = np.zeros((1, 1, 6)), np.zeros((1, 1, 6, 6))
DOFS, PRESSURE = np.arange(34)[None], np.zeros((1, 4))


def compile_element_kernels() -> None:
    """Compile the kernels of elements, two thirds of the whole time; numba keeps them for other processes."""
    ke, re = np.zeros((1, 31, 31)), np.zeros((1, 31))
    film_solid(GRADIENT, ONE, F, STRESS, TANGENT, ONE, np.zeros(6), 1.0, 1.0, ke, re)
    ke, re = np.zeros((1, 34, 34)), np.zeros((1, 34))
    # the last one: solve.fem.warm_up.is_compiled asks for it
    mixed_solid(GRADIENT, ONE, PRESSURE, F, PRESSURE, 1.0, STRESS, TANGENT, ke, re)


def compile_other_kernels() -> None:
    """Compile the other kernels, as a process can that waits for those of the elements."""
    deformation_gradient(GRADIENT, STILL)
    smallest_jacobian(F)
    green_lagrange(GRADIENT, STILL)
    isochoric_stress(cauchy_green(F), np.zeros(4))
    pattern = build_pattern([DOFS], 34)
    data, residual = np.zeros(len(pattern.indices)), np.zeros(34)
    scatter(np.zeros((1, 34, 34)), np.zeros((1, 34)), DOFS, pattern.slots[0], data, residual)


def is_compiled() -> bool:
    """Whether numba has the kernels on disk; else the first press compiles them."""
    return any(Path(mixed_solid.kernel.stats.cache_path or "").glob("*.mixed_solid-*.nbc"))
