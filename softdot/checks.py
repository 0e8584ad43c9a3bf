"""Checks before any work, the expected cost of a run, and warnings about a design or a result.

Measured on two cores of an EPYC without other work (docs/speed.md): 0.29 s a Newton iteration at 14,800 unknowns, 2.9 s
at 68,400, about seven iterations a load step where the path does not ask for more.
"""

from dataclasses import dataclass

import numpy as np

from diagnose.figures import figure
from foundation.arrays import Floats
from foundation.cache import check_cache_folder
from foundation.errors import InputError
from geometry.array.checks import check_array
from geometry.array.layout import ArrayLayout
from geometry.checks import (
    check_press_depth,
    check_pushed_dot,
    check_segment,
    check_slide,
    dots_along_slide,
    press_warnings,
)
from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Segment
from geometry.part_checks import covers_footprint
from geometry.stack import layers
from mesh.array.sizing import array_sizing, expected_elements
from mesh.build import build
from mesh.options import MeshOptions
from mesh.outline import stack_outline
from mesh.sizing import sizing_field
from mesh.types import Planes
from softdot.config.schema import Config
from softdot.memory import needed_GB, refuse_too_little_memory
from softdot.sensitivity import press_noise
from solve.materials.film_yield import Yield
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.model import Model
from solve.physics import declared_bonds, laws_of
from solve.readout.course import PressCourse
from solve.result import PressResult
from solve.solution.schedule import duration_s, largest_fraction
from solve.symmetry import meshed_planes
from solve.terms.rigid_dot import RigidDot
from solve.validity import validity_warnings
from solve.waveform import Waveform

MOST_ELEMENTS = 1_000_000
"""Largest mesh that is allowed, in tetrahedra."""
SIZE_SAMPLES = 100_000
"""Random points of the stack at which the element size is looked up."""
TETRAHEDRA_PER_CUBE = 6.0 * np.sqrt(2.0)
"""Tetrahedra of edge h in a volume h^3: a regular one has the volume h^3 / (6 sqrt 2)."""
TETRAHEDRA_PER_SQUARE = 12.0 / np.sqrt(3.0)
"""Tetrahedra of a slice on an area h^2: three for each triangle of area sqrt 3 / 4 h^2."""


def refuse_huge_mesh(
    segment: Segment, dot_shape: DotShape, options: MeshOptions, planes: Planes = (), layout: ArrayLayout | None = None
) -> None:
    """InputError when the wished edge lengths mean more than MOST_ELEMENTS elements, or more than fit into memory.

    planes : mirror planes at which the mesh ends. layout : of an array. Of mesh.file the elements are counted;
    InputError too when it is no mesh of the segment.
    """
    count = expected_tetrahedra(segment, dot_shape, options, planes, layout)
    if options.file is not None:
        if count > MOST_ELEMENTS:
            raise InputError(
                f"mesh.file = '{options.file}': has {count:.0f} elements, at most {MOST_ELEMENTS} are allowed"
            )
        refuse_too_little_memory(count, segment.section == "plane-strain", "file", options.file)
        return
    refuse_many_elements(count, options, segment.section == "plane-strain")


def refuse_many_elements(count: float, options: MeshOptions, is_slice: bool) -> None:
    """InputError, naming the smallest size, when count elements are not allowed or do not fit into memory."""
    sizes = options.sizes_mm
    name = min(sizes, key=lambda one: sizes[one])
    if count > MOST_ELEMENTS:
        raise InputError(
            f"mesh.{name} = {sizes[name]:g}: means about {count:.1g} elements, "
            f"at most {MOST_ELEMENTS:.0g} are allowed; use a larger size"
        )
    refuse_too_little_memory(count, is_slice, name, sizes[name])


def expected_tetrahedra(
    segment: Segment, dot_shape: DotShape, options: MeshOptions, planes: Planes = (), layout: ArrayLayout | None = None
) -> float:
    """Rough number of elements of the soft layers: the mean of 6 sqrt 2 / h^3 over points in the stack.

    A slice is one layer of triangles of area sqrt 3 / 4 h^2, each of three tetrahedra. Of mesh.file their number is
    counted. layout : of an array, of which, unless it is of slices, the mesher gives the number.
    """
    if layout is not None and not layout.is_slice:
        return expected_elements(layout, dot_shape, options, planes)
    if options.file is not None:
        return float(len(build(segment, dot_shape, options).tets))
    sliced = segment.section == "plane-strain"
    shape = stack_outline(segment, slice_mm=options.contact_element_size_mm) if sliced else stack_outline(segment)
    field = sizing_field(shape, dot_shape, options) if layout is None else array_sizing(layout, dot_shape, options)
    high = np.array([shape.half_x, shape.half_y, shape.top])
    low = np.array([-shape.half_x, -shape.half_y, 0.0])
    low[list(planes)] = 0.0
    points = np.random.default_rng(0).uniform(low, high, (SIZE_SAMPLES, 3))
    if sliced:
        return float((high - low)[0] * (high - low)[2] * np.mean(TETRAHEDRA_PER_SQUARE / field.at(points) ** 2))
    return float(np.prod(high - low) * np.mean(TETRAHEDRA_PER_CUBE / field.at(points) ** 3))


UNKNOWNS_PER_TETRAHEDRON = {"solid": 4.4, "plane-strain": 1.6}
ITERATIONS_PER_STEP = 5
"""Newton iterations of a load step in the expected cost."""
ITERATION_REFERENCE_S, REFERENCE_UNKNOWNS, TIME_EXPONENT = 1.5, 68_400, 1.5
"""Time of a Newton iteration at REFERENCE_UNKNOWNS unknowns; it grows with the power TIME_EXPONENT of their number."""
SOLIDS_AND_PICTURES_S, MESH_S_PER_TETRAHEDRON = 9.0, 3e-4
COMPILE_S = 15.0
"""Time to compile the element kernels, once on a machine."""


@dataclass(frozen=True)
class Cost:
    """Expected size of a run. first_run_s : additional time where the element kernels are not compiled yet."""

    tetrahedra: int
    unknowns: int
    time_s: float
    first_run_s: float
    memory_GB: float


def cost_of(tetrahedra: float, config: Config, presses: int = 1) -> Cost:
    """Expected cost of a number of presses, each on a mesh of that many tetrahedra, with all files of a run.

    Waveforms that are followed in time, slides and mechanisms may take several times as long.
    """
    unknowns = UNKNOWNS_PER_TETRAHEDRON[config.segment.section] * tetrahedra
    solve_s = (
        ITERATIONS_PER_STEP
        * config.press.load_steps
        * ITERATION_REFERENCE_S
        * (unknowns / REFERENCE_UNKNOWNS) ** TIME_EXPONENT
    )
    time_s = SOLIDS_AND_PICTURES_S + presses * (MESH_S_PER_TETRAHEDRON * tetrahedra + solve_s)
    return Cost(
        tetrahedra=_two_digits(tetrahedra),
        unknowns=_two_digits(unknowns),
        time_s=float(_two_digits(time_s)),
        first_run_s=COMPILE_S,
        memory_GB=round(needed_GB(tetrahedra, config.segment.section == "plane-strain"), 1),
    )


def _two_digits(value: float) -> int:
    """A number rounded to two digits: more would claim too much."""
    return int(float(f"{value:.2g}"))


NEARLY_INCOMPRESSIBLE_POISSON_RATIO = 0.49
"""Poisson's ratio above which a closed cavity blocks the film."""


def result_warnings(model: Model, dot_shape: DotShape, result: PressResult) -> list[str]:
    """Warnings from a solution: of the solver, of yield where it is not modelled, of strain beyond the data."""
    yields = bool(laws_of(model.physics.inelastic, Yield))
    warnings = [
        *result.warnings,
        *([] if yields else _yield_warnings(model, result)),
        *validity_warnings(model, result),
    ]
    for layer, material in model.materials.items():
        warnings += _fit_range_warnings(layer, material, result)
    if model.press.indentation_mm is None:
        deepest_mm = 1e3 * max(step.indentation_m for step in result.steps)
        warnings += press_warnings(dot_shape, model.segment, deepest_mm, model.press.path_xy_mm)
    return warnings


SAME_VOLTAGE = 1e-3
"""Relative distance from the end of its range at which a voltage counts as cut."""
READOUT_ERROR_PERCENT = 5.0
"""Error of the read-out from which a run warns; the summary states it in any case."""


def course_warnings(model: Model, result: PressResult, along: PressCourse) -> list[str]:
    """Warnings where too few states were solved to know the voltage of an amplifier, and of what it adds itself."""
    error, added = along.readout_error_percent, _amplifier_warnings(model, result, along)
    if along.together_V is None or error <= READOUT_ERROR_PERCENT or not result.converged:
        return added
    return [
        *added,
        f"the read-out may be off by {figure(error)} % of its largest value, as the charge between {len(result.steps)} "
        f"solved states is interpolated: press.load_steps = {model.press.load_steps} is too few, or state "
        "mesh.accuracy_percent",
    ]


def _amplifier_warnings(model: Model, result: PressResult, along: PressCourse) -> list[str]:
    """Warnings where a stated amplifier cuts the signal, alone or with its bias current, and where noise folds."""
    budget, readout = press_noise(model, result, along), model.readout
    if budget is None or readout is None or along.together_V is None:
        return []
    told, folded = [], budget.above_half_rate_V
    most, end = float(np.abs(along.together_V).max()), readout.largest_V
    if end is not None and most >= (1.0 - SAME_VOLTAGE) * end:
        told.append(f"readout: the voltage is cut at {end:g} V, where amplifier or converter end; use less gain")
    elif end is not None and most + budget.offset_V > end:
        told.append(
            f"readout.amplifier.bias_current_pA: it shifts the voltage by up to {budget.offset_V:.3g} V, which does "
            f"not fit beside the signal into {end:g} V; the course leaves that shift out"
        )
    if folded is not None and folded > 0.5 * budget.rms_V:
        told.append(
            f"readout.amplifier.sample_rate_Hz: {1e3 * folded:.3g} of {1e3 * budget.rms_V:.3g} mV of noise are above "
            "half of it and fold into the samples; state readout.low_pass_Hz"
        )
    return told


def design_warnings(model: Model) -> list[str]:
    """Warnings that need no solution: of stated values that are not used, and of a cavity that held sides close."""
    return [*_unused_bond_warnings(model), *_cavity_warnings(model)]


def _unused_bond_warnings(model: Model) -> list[str]:
    used = model.physics.bonds
    replaced = [name for name, stated in declared_bonds(model.segment).items() if used[name] != stated]
    return [
        f"segment.bonds: the stiffness stated for '{name}' is not used, a mechanism states another one"
        for name in replaced
    ]


def _cavity_warnings(model: Model) -> list[str]:
    segment = model.segment
    material = model.materials["medium2"]
    held = segment.boundary == "clamped" and "medium2" in segment.held_layers
    nu = getattr(material, "poisson_ratio", 0.0)
    if not held or isinstance(nu, tuple) or nu < NEARLY_INCOMPRESSIBLE_POISSON_RATIO:
        return []
    return [
        f"the held sides of medium2 enclose a nearly incompressible material (poisson_ratio "
        f"= {nu:g}): it blocks the film, and small changes of poisson_ratio change the result a lot"
    ]


def _yield_warnings(model: Model, result: PressResult) -> list[str]:
    film = model.materials["film"]
    peak = result.film_peak
    stress = 1e-6 * max(peak.stress_Pa, peak.compression_Pa)
    if not isinstance(film, PiezoelectricFilm) or film.yield_stress_MPa is None or stress <= film.yield_stress_MPa:
        return []
    if peak.stress_Pa >= peak.compression_Pa:
        what, follows = "largest principal stress", "a real film would remain stretched"
    else:
        what, follows = "largest compressive stress", "a real film would yield or fold"
    return [
        f"the film's {what} of {stress:.3g} MPa exceeds its yield stress of {film.yield_stress_MPa:g} MPa: {follows}"
    ]


def _fit_range_warnings(layer: str, material: Material, result: PressResult) -> list[str]:
    """A warning where the largest principal stretch of a layer, over all steps, is beyond the range of its data."""
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


RIM_SAMPLES = 201
"""Points along each edge of the held rim."""


def refuse_held_rim(segment: Segment, dot_shape: DotShape, indentation_mm: float) -> None:
    """InputError where the dot, of any shape and tilt, reaches the held rim before the final depth in mm."""
    free_mm = travel_to_rim_mm(segment, dot_shape, indentation_mm)
    if free_mm < indentation_mm:
        raise InputError(
            f"press.indentation_mm = {indentation_mm:g}: the dot meets the held rim of the segment at {free_mm:.3g} "
            "mm, and neither can deform; press less deep, move the dot (dot.offset_mm), enlarge the segment or hold "
            "fewer layers (segment.held_layers)"
        )


def travel_to_rim_mm(segment: Segment, dot_shape: DotShape, indentation_mm: float) -> float:
    """Indentation, mm, at which the dot touches the held rim of the top face; infinite where it stays clear of it."""
    stack = layers(segment)
    if segment.boundary != "clamped" or stack[-1].name not in segment.held_layers or not covers_footprint(segment):
        return np.inf
    rim, dot = _rim_points(segment, stack[-1].top_mm), RigidDot(dot_shape, 1.0)

    def clear(travel_mm: float) -> bool:
        return bool(dot.distance(rim, np.array([0.0, 0.0, -travel_mm]))[0].min() > 0.0)

    if clear(indentation_mm):
        return np.inf
    low, high = 0.0, indentation_mm  # what the dot has reached it does not leave on its way down
    while high - low > 1e-6 * indentation_mm:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if clear(middle) else (low, middle)
    return low


def _rim_points(segment: Segment, top_mm: float) -> Floats:
    """Points (n, 3) on the outline of the top face; of a slice its two ends."""
    x, y = segment.length_mm / 2.0, segment.width_mm / 2.0
    if segment.section == "plane-strain":
        return np.array([[-x, 0.0, top_mm], [x, 0.0, top_mm]])
    share = np.linspace(-1.0, 1.0, RIM_SAMPLES)
    sides = [np.column_stack([sign * x * np.ones(RIM_SAMPLES), y * share]) for sign in (-1.0, 1.0)]
    sides += [np.column_stack([x * share, sign * y * np.ones(RIM_SAMPLES)]) for sign in (-1.0, 1.0)]
    return np.column_stack([np.concatenate(sides), np.full(4 * RIM_SAMPLES, top_mm)])


def _shallow_waveform(waveform: Waveform | None) -> list[str]:
    """A warning for a file that never reaches the whole depth or force, as one of millimetres does not."""
    if waveform is None or waveform.shape != "file":
        return []
    largest = largest_fraction(waveform)
    if largest >= 1.0:
        return []
    return [
        f"press.waveform.file = '{waveform.file}': the largest fraction is {largest:.3g}, so the press goes to "
        f"{100.0 * largest:.3g} % of what [press] states"
    ]


def check_case(model: Model, options: MeshOptions, layout: ArrayLayout | None = None) -> tuple[DotShape, list[str]]:
    """The dot at rest and warnings about the design. layout : of an array. InputError."""
    check_cache_folder()
    segment, press = model.segment, model.press
    if press.waveform is not None:
        duration_s(press.waveform)  # reads the file of shape = "file"
    warnings = check_segment(segment) if layout is None else [*check_segment(layout.segment), *check_array(layout)]
    warnings += _shallow_waveform(press.waveform)
    warnings += check_slide(model.dot, segment, press.path_xy_mm)
    depth = press.indentation_mm
    if depth is not None:
        check_press_depth(segment, depth)
    else:
        check_pushed_dot(model.dot, segment, press.path_xy_mm)
    dot_shape = resolve_dot(model.dot, segment)
    refuse_huge_mesh(segment, dot_shape, options, meshed_planes(model, dot_shape, options), layout)
    if depth is not None:
        warnings += press_warnings(dot_shape, segment, depth, press.path_xy_mm)
        for one in dots_along_slide(dot_shape, press.path_xy_mm):
            refuse_held_rim(segment, one, depth)
    return dot_shape, warnings
