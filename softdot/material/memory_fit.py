"""Relaxation from holds and softening from cycles: whole courses, by the material point of a coupon's diagnosis.

The constants of the law are fitted with them: they are those of the first instant and of the first loading, which are
stiffer than what a slower loading shows.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from pydantic import TypeAdapter
from scipy.optimize import least_squares

from diagnose.engines.coupon.kinematics import coupon_kinematics
from diagnose.engines.coupon.point import MaterialPoint
from diagnose.engines.coupon.relaxation import NO_SERIES
from diagnose.engines.coupon.relaxation_spectrum import LARGEST_MODULUS_RATIO, relaxation_times
from diagnose.signals.time_scales import TimeScales
from foundation.arrays import Floats
from softdot.material.course import LOADING, SpecimenCourse
from softdot.material.elastic_fit import FittedLaw
from softdot.material.stable_laws import Deformation
from solve.materials.mullins import Softening
from solve.materials.parameters import AnyMaterial, Material
from solve.materials.prony import Prony
from solve.solution.errors import NoEquilibriumError

LEAST_LOSS, LEAST_SHARE = 0.01, 1e-3  # of the stress: less is not told
FIRST_SHARE, LARGEST_SHARE = 0.01, 30.0  # of the stress, by one constant
LARGEST_LOSS, BETAS = 0.95, (0.05, 2.0)
BLOCKS = 8  # that are left out in turn, as of a law
MISSED = 10.0  # relative residual where a point has no equilibrium
MATERIAL: TypeAdapter[Material] = TypeAdapter(AnyMaterial)


@dataclass(frozen=True)
class FittedMaterial:
    """A law with its Poisson's ratio, and what relaxes and softens; series and softening are None without.

    without : fits to the courses without one of BLOCKS blocks each, where something relaxes or softens.
    """

    fitted: FittedLaw
    poisson_ratio: float
    series: Prony | None = None
    softening: Softening | None = None
    without: tuple["FittedMaterial", ...] = ()

    @property
    def table(self) -> dict[str, Any]:
        """The entry of [materials]."""
        table = self.fitted.law.table(self.fitted.constants, self.fitted.shape)
        if "youngs_modulus_MPa" in table:  # from 3 G to 2 G (1 + nu)
            table["youngs_modulus_MPa"] *= 2.0 * (1.0 + self.poisson_ratio) / 3.0
        return {**table, "poisson_ratio": self.poisson_ratio}

    def stress_MPa(self, course: SpecimenCourse, slack: float) -> Floats:
        """Nominal stress (s,) over a course. NoEquilibriumError."""
        material = MATERIAL.validate_python(self.table)
        kinematics = coupon_kinematics(course.test.kind, 1.0, 1.0)
        point = MaterialPoint(kinematics, material.law, self.poisson_ratio, self.softening, self.series or NO_SERIES)
        strain = np.maximum(course.strain - slack, 0.0)
        stress = point.answer(course.time_s, strain, "displacement_mm")
        return np.maximum(stress, 0.0) if course.test.kind == "tension" else stress  # a strip does not push


def fit_memory(
    fitted: FittedLaw, courses: Sequence[SpecimenCourse], strain_range: float, poisson_ratio: float
) -> FittedMaterial:
    """The law with relaxation where a course has holds, and softening where it has cycles, by least squares.

    Only samples within the range of strain count; those beyond are history.
    """
    times = _relaxation_times(courses, strain_range)
    softens = any(course.cycles > 1 for course in courses)
    law, units = fitted.law, _units(fitted, courses, strain_range)
    most = len(units), len(units) + len(fitted.shape), len(units) + len(fitted.shape) + len(times)
    bounds = [
        *[(0.0, LARGEST_SHARE)] * len(units),
        *_shape_bounds(fitted),
        *[(0.0, LARGEST_MODULUS_RATIO)] * len(times),
        *([(0.0, LARGEST_LOSS), BETAS] if softens else []),
    ]
    shares = np.maximum(np.array(fitted.constants) / units, FIRST_SHARE)
    start = np.array([*shares, *fitted.shape, *[0.1] * len(times), *([0.1, 0.3] if softens else [])])

    def material(values: Floats) -> FittedMaterial:
        constants, shape, ratios = (values[a:b] for a, b in pairwise((0, *most)))
        branches = tuple((ratios / (1.0 + ratios.sum())).tolist())
        return FittedMaterial(
            FittedLaw(law, tuple((constants * units).tolist()), tuple(shape.tolist()), fitted.slack),
            poisson_ratio,
            Prony(branches, times) if times else None,
            Softening(float(values[-2]), 0.0, float(values[-1])) if softens else None,
        )

    def missed(values: Floats) -> Floats:
        parts = []
        for course, slack in zip(courses, fitted.slack, strict=True):
            used = course.strain <= 1.02 * strain_range
            size = float(np.linalg.norm(course.stress_MPa[used]))
            try:
                wrong = material(values).stress_MPa(course, slack)[used] - course.stress_MPa[used]
            except NoEquilibriumError:
                wrong = np.full(int(used.sum()), MISSED * size)
            parts.append(wrong / size)
        return np.concatenate(parts)

    low, high = np.array(bounds).T
    found = least_squares(missed, np.clip(start, low, high), bounds=(low, high), x_scale=np.maximum(start, 0.1))
    sizes = [int((course.strain <= 1.02 * strain_range).sum()) for course in courses]
    without = tuple(material(np.clip(values, low, high)) for values in without_blocks(found, sizes))
    return replace(_without_nothing(material(found.x)), without=without)


def without_blocks(found: Any, sizes: Sequence[int]) -> list[Floats]:
    """The values of a least-squares fit without one block of neighbouring samples each, to first order.

    found : scipy's OptimizeResult; sizes : residuals of each course in turn. One Newton step from the whole fit, by its
    Jacobian (Cook and Weisberg, Residuals and influence in regression, 1982, section 5.4); values on a bound stay.
    """
    free = found.active_mask == 0
    jacobian, rest = found.jac[:, free], found.fun
    offsets = np.cumsum([0, *sizes])
    blocks = [np.zeros(len(rest), bool) for _ in range(BLOCKS)]
    for start, size in zip(offsets, sizes, strict=False):
        for block, part in zip(blocks, np.array_split(np.arange(start, start + size), BLOCKS), strict=True):
            block[part] = True
    values = []
    for block in blocks:
        step = np.linalg.lstsq(jacobian[~block], -rest[~block], rcond=1e-10)[0]
        moved = found.x.copy()
        moved[free] += step
        values.append(moved)
    return values


def _units(fitted: FittedLaw, courses: Sequence[SpecimenCourse], strain_range: float) -> Floats:
    """Each constant (m,) in MPa that alone would make a stress as large as that of the first course."""
    first = courses[0]
    used = first.strain <= strain_range
    rows = fitted.law.rows([Deformation.of(first.test.kind, first.strain[used])], fitted.shape)
    return np.asarray(np.linalg.norm(first.stress_MPa[used]) / np.linalg.norm(rows, axis=0))


def _shape_bounds(fitted: FittedLaw) -> list[tuple[float, float]]:
    """Bounds of each shape value: those of a start of the law that hold it."""
    starts = ([(one[1], one[2]) for one in start] for start in fitted.law.starts)
    inside = (
        found
        for found in starts
        if all(low <= value <= high for (low, high), value in zip(found, fitted.shape, strict=True))
    )
    return next(inside)


def course_error(material: FittedMaterial, courses: Sequence[SpecimenCourse], strain_range: float) -> float:
    """Root mean square of what is missed within the range, over that of the stress; tests count alike."""
    squares = []
    for course, slack in zip(courses, material.fitted.slack, strict=True):
        used = course.strain <= 1.02 * strain_range
        wrong = material.stress_MPa(course, slack)[used] - course.stress_MPa[used]
        squares.append(float(wrong @ wrong) / float(course.stress_MPa[used] @ course.stress_MPa[used]))
    return float(np.sqrt(np.mean(squares)))


def _relaxation_times(courses: Sequence[SpecimenCourse], strain_range: float) -> tuple[float, ...]:
    """Times of relaxation in s that the holds within the range can show; none without such holds."""
    held = [course for course in courses if course.holds_in(strain_range)]
    if not held:
        return ()
    steps = [np.diff(course.time_s[(course.phase == LOADING) & (course.cycle == 0)]) for course in held]
    step = min(float(np.median(one)) for one in steps)
    longest = max(float(course.time_s[-1]) for course in held)
    return relaxation_times(TimeScales(step, step, longest))


def _without_nothing(material: FittedMaterial) -> FittedMaterial:
    """The material without branches and a softening that hardly act."""
    series, softening = material.series, material.softening
    if series is not None:
        kept = [n for n, share in enumerate(series.relative_moduli) if share > LEAST_SHARE]
        series = Prony(tuple(series.relative_moduli[n] for n in kept), tuple(series.relaxation_times[n] for n in kept))
    if softening is not None and softening.loss < LEAST_LOSS:
        softening = None
    return replace(material, series=series if series is not None and series.relative_moduli else None,
                   softening=softening)  # fmt: skip
