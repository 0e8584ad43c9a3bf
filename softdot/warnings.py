"""What is refused before any work, and what a user should know about a design or a result that is otherwise good."""

import numpy as np

from geometry.arrays import Floats
from geometry.cache import check_folder
from geometry.checks import check_press_depth, check_pushed_dot, check_segment, press_warnings
from geometry.dot import DotShape, resolve_dot
from geometry.parameters import Segment
from geometry.part_checks import covers_footprint
from geometry.stack import layers
from mesh.build import MeshOptions
from softdot.cost import refuse_huge_mesh
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.model import Model
from solve.result import PressResult
from solve.solution.schedule import duration_s
from solve.terms.contact import RigidDot

NEARLY_INCOMPRESSIBLE = 0.49


def result_warnings(model: Model, dot_shape: DotShape, result: PressResult) -> list[str]:
    """Warnings that a solution gives: the solver's own, yield of the film where it is no part of it, strain beyond the
    data.
    """
    yields = model.physics.film_yield is not None
    warnings = [*result.warnings, *([] if yields else _yield(model, result))]
    for layer, material in model.materials.items():
        warnings += _beyond_fit(layer, material, result)
    if model.press.indentation_mm is None:
        deepest_mm = 1e3 * max(step.indentation_m for step in result.steps)
        warnings += press_warnings(dot_shape, model.segment, deepest_mm)
    return warnings


def design_warnings(model: Model) -> list[str]:
    """Warnings that need no solution: holding medium 2 closes a cavity."""
    segment = model.segment
    material = model.materials["medium2"]
    held = segment.boundary == "clamped" and "medium2" in segment.held_layers
    nu = getattr(material, "poisson_ratio", 0.0)
    if not held or isinstance(nu, tuple) or nu < NEARLY_INCOMPRESSIBLE:
        return []
    return [
        f"the held sides of medium2 enclose a nearly incompressible material (poisson_ratio "
        f"= {nu:g}): it blocks the film, and small changes of poisson_ratio change the result a lot"
    ]


def _yield(model: Model, result: PressResult) -> list[str]:
    film = model.materials["film"]
    stress = 1e-6 * result.film_peak.stress_Pa
    if not isinstance(film, PiezoelectricFilm) or film.yield_stress_MPa is None or stress <= film.yield_stress_MPa:
        return []
    return [
        f"the film's largest principal stress of {stress:.3g} MPa exceeds its yield stress of "
        f"{film.yield_stress_MPa:g} MPa: a real film would remain stretched"
    ]


def _beyond_fit(layer: str, material: Material, result: PressResult) -> list[str]:
    """Largest principal stretch of the layer over all steps against the range of the data."""
    limit, tet_mesh = material.max_fitted_strain, result.tet_mesh
    if limit is None or layer not in tet_mesh.region_names:
        return []
    tets = tet_mesh.region_tets(layer)
    strain = max(float(step.fields.max_stretch[tets].max()) for step in result.steps) - 1.0
    if strain <= limit:
        return []
    return [
        f"the strain of {100 * strain:.3g} % in {layer} is beyond the fitted range of its material "
        f"({100 * limit:.3g} %)"
    ]


SAMPLES = 201
"""Points along each edge of the rim."""


def held_rim_warnings(segment: Segment, dot_shape: DotShape, indentation_mm: float) -> list[str]:
    """A warning where the dot, of any shape and tilt, reaches the held rim before the final depth in mm."""
    free_mm = travel_to_rim_mm(segment, dot_shape, indentation_mm)
    if free_mm >= indentation_mm:
        return []
    return [
        f"a dot meets the held rim of the segment at an indentation of {free_mm:.3g} mm, and neither can deform: the "
        "computation will stop there or soon after; move the dot, enlarge the segment or hold fewer layers"
    ]


def travel_to_rim_mm(segment: Segment, dot_shape: DotShape, indentation_mm: float) -> float:
    """Indentation at which the dot touches the held rim of the top face, infinite where it stays clear of it."""
    stack = layers(segment)
    if segment.boundary != "clamped" or stack[-1].name not in segment.held_layers or not covers_footprint(segment):
        return np.inf
    rim, dot = _rim(segment, stack[-1].top_mm), RigidDot(dot_shape, 1.0)

    def clear(travel_mm: float) -> bool:
        return bool(dot.distance(rim, np.array([0.0, 0.0, -travel_mm]))[0].min() > 0.0)

    if clear(indentation_mm):
        return np.inf
    low, high = 0.0, indentation_mm  # what the dot has reached it does not leave on its way down
    while high - low > 1e-6 * indentation_mm:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if clear(middle) else (low, middle)
    return low


def _rim(segment: Segment, top_mm: float) -> Floats:
    """Points (n, 3) on the outline of the top face; of a slice its two ends."""
    x, y = segment.length_mm / 2.0, segment.width_mm / 2.0
    if segment.section == "plane-strain":
        return np.array([[-x, 0.0, top_mm], [x, 0.0, top_mm]])
    share = np.linspace(-1.0, 1.0, SAMPLES)
    sides = [np.column_stack([sign * x * np.ones(SAMPLES), y * share]) for sign in (-1.0, 1.0)]
    sides += [np.column_stack([x * share, sign * y * np.ones(SAMPLES)]) for sign in (-1.0, 1.0)]
    return np.column_stack([np.concatenate(sides), np.full(4 * SAMPLES, top_mm)])


def check_case(model: Model, options: MeshOptions) -> tuple[DotShape, list[str]]:
    """The dot at rest and what a user should know about this design. InputError."""
    check_folder()
    segment, press = model.segment, model.press
    if press.waveform is not None:
        duration_s(press.waveform)  # reads the file of shape = "file"
    warnings = check_segment(segment)
    depth = press.indentation_mm
    if depth is not None:
        check_press_depth(segment, depth)
    else:
        check_pushed_dot(model.dot, segment, press.path_xy_mm)
    dot_shape = resolve_dot(model.dot, segment)
    refuse_huge_mesh(segment, dot_shape, options)
    if depth is not None:
        warnings += press_warnings(dot_shape, segment, depth)
        warnings += held_rim_warnings(segment, dot_shape, depth)
    return dot_shape, warnings
