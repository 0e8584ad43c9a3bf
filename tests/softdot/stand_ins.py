"""Results that no solver made, and a second process that is this one."""

from collections.abc import Callable
from concurrent.futures import Future
from contextlib import nullcontext

import numpy as np

from geometry.dot import DotShape
from mesh.types import TetMesh
from solve.fem.shape_functions import TET_EDGES
from solve.result import Fields, FilmPeak, PressResult, Step, Trace


def one_tetrahedron() -> TetMesh:
    """A mesh of one element, called film."""
    points = np.zeros((10, 3))
    points[1, 0] = points[2, 1] = points[3, 2] = 1.0
    points[4:] = [points[list(edge)].mean(axis=0) for edge in TET_EDGES]
    return TetMesh(points, np.arange(10)[None], np.zeros(1, int), ("film",), {}, np.arange(10), 1.0)


def cap_of_height(height_mm: float) -> DotShape:
    """A spherical cap at rest over the origin."""
    return DotShape("cap", 0.8, height_mm, np.zeros((1, 3)), np.zeros(3), np.eye(3))


def step_at(depth_mm: float, stretch: float = 1.0) -> Step:
    """A converged step: 10 N, 20 pC and 2 V per mm on one electrode, the one element stretched as said."""
    return Step(
        time_s=depth_mm,
        dot_force_N=np.array([0.0, 0.0, 10.0 * depth_mm]),
        indentation_m=1e-3 * depth_mm,
        reaction_force_N=10.0 * depth_mm,
        film_charge_C=np.array([20e-12 * depth_mm]),
        open_circuit_voltage_V=np.array([2.0 * depth_mm]),
        newton_iterations=4,
        relative_residual=1e-12,
        dot_position_m=np.zeros(3),
        fields=fields_with_stretch(stretch),
    )


def fields_with_stretch(stretch: float) -> Fields:
    """Fields of the one element, empty but for the stretch."""
    nothing = {name: np.zeros(0) for name in Fields.__dataclass_fields__}
    return Fields(**{**nothing, "max_stretch": np.array([stretch]), "displacement_m": np.zeros((10, 3))})


def result_of(depths_mm: list[float], failure: str | None = None, stress_MPa: float = 10.0) -> PressResult:
    """A press that reached these depths and then, with a failure, stopped."""
    depths = np.array(depths_mm)
    trace = Trace(
        time_s=depths,
        indentation_m=1e-3 * depths,
        dot_path_m=1e-3 * depths,
        reaction_force_N=10.0 * depths,
        contact_force_N=10.0 * depths[:, None] * [0, 0, 1],
        film_charge_C=20e-12 * depths[:, None],
        contact_area_m2=1e-6 * depths,
    )
    return PressResult(
        steps=tuple(step_at(depth) for depth in depths_mm),
        trace=trace,
        follows_time=False,
        tet_mesh=one_tetrahedron(),
        converged=failure is None,
        failure=failure,
        electrode_names=("film",),
        capacitance_F=np.array([10e-12]),
        unknowns=30,
        linear_solver="stand-in",
        max_relative_residual=1e-12,
        progress=depths / max(depths.max(), 1e-9),
        film_peak=FilmPeak(0.01, 1e6 * stress_MPa, (0.0, 1e-5), 1.4e-4, 0.03, 3e6 * stress_MPa),
    )


class AtOnce(nullcontext["AtOnce"]):
    """In place of the second process of a run: calls are done here and at once."""

    def __init__(self) -> None:
        self.kernels = self(lambda: None)

    def __enter__(self) -> "AtOnce":
        return self

    def __call__(self, function: Callable[..., object], *arguments: object) -> Future[object]:
        future: Future[object] = Future()
        future.set_result(function(*arguments))
        return future
