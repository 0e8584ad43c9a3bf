"""From the tests of a specimen to a material: what was read, which laws fit, and what is doubtful."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.material.course import LOADING, SpecimenCourse, course_of
from softdot.material.elastic_fit import BLOCKS, LARGEST_SLACK, LoadingCurve, RankedLaw, rank_laws
from softdot.material.memory_fit import FittedMaterial, course_error, fit_memory
from softdot.material.specimen_file import KINDS, LARGEST_PLAIN_STRAIN, read_test
from softdot.material.stable_laws import STABLE_LAWS, Deformation, laws_for

BEST_LAWS = 3  # whose memory is fitted, and which are asked of other kinds
COARSE_ERROR, LOOSE_SPREAD = 0.1, 0.2  # of the stress, from which a page warns
LEAST_SLACK = 0.001


@dataclass(frozen=True)
class MaterialRequest:
    """What softdot material is asked. kinds : one for all files, or one each. sizes : of every specimen.

    slack : nominal strain before a specimen is loaded, None to fit it. law : its name, None for the best.
    preconditioned : whether the last cycle alone is fitted.
    """

    files: tuple[Path, ...]
    kinds: tuple[str, ...] = ("tension",)
    sizes: Mapping[str, float] = field(default_factory=dict)
    columns: str | None = None
    strain_range: float = 0.5
    slack: float | None = None
    poisson_ratio: float = 0.499
    law: str | None = None
    preconditioned: bool = False

    def courses(self) -> list[SpecimenCourse]:
        """Every test, read and cut. InputError."""
        if len(self.kinds) not in (1, len(self.files)):
            raise InputError(f"--kind is given {len(self.kinds)} times for {len(self.files)} tests: once, or once each")
        kinds = self.kinds * len(self.files) if len(self.kinds) == 1 else self.kinds
        pairs = zip(self.files, kinds, strict=True)
        return [course_of(read_test(file, kind, self.sizes, self.columns), self.strain_range) for file, kind in pairs]


@dataclass(frozen=True)
class Characterisation:
    """Tests and what was fitted to them. ranked : laws, the chosen one first; material : it, with its memory."""

    request: MaterialRequest
    courses: tuple[SpecimenCourse, ...]
    curves: tuple[LoadingCurve, ...]
    ranked: tuple[RankedLaw, ...]
    material: FittedMaterial

    @property
    def reached(self) -> float:
        """Largest nominal strain of the data within the range."""
        return max(float(curve.strain.max()) for curve in self.curves)

    @property
    def has_memory(self) -> bool:
        """Whether anything relaxes or softens."""
        return self.material.series is not None or self.material.softening is not None

    @cached_property
    def error(self) -> float:
        """What the material misses of the stress, relative: of the first loading, or of whole courses."""
        if not self.has_memory:
            return self.ranked[0].error
        return course_error(self.material, self.courses, self.request.strain_range)

    @cached_property
    def other_kinds(self) -> dict[str, tuple[float, list[float]]]:
        """Kind that was not tested -> strain, and nominal stress there by each of the best laws."""
        strain = 0.5 * self.reached
        untested = [kind for kind in KINDS if kind not in {course.test.kind for course in self.courses}]
        best = [one.fitted for one in self.ranked[:BEST_LAWS]]
        return {
            kind: (strain, [float(one.stress_MPa(Deformation.of(kind, np.array([strain])))[0]) for one in best])
            for kind in untested
        }

    @property
    def warnings(self) -> list[str]:
        """What a user has to know, in sentences."""
        told = [*self._of_fit(), *self._of_courses()]
        spread = {kind: max(stresses) / min(stresses) - 1.0 for kind, (_, stresses) in self.other_kinds.items()}
        kind = max(spread, key=lambda one: spread[one], default="")
        if kind and spread[kind] > LOOSE_SPREAD:
            told.append(
                f"laws that fit almost as well differ by {100 * spread[kind]:.2g} % in {kind} at "
                f"{50 * self.reached:.3g} % of strain; a test of that kind decides"
            )
        return told

    def _of_fit(self) -> list[str]:
        chosen, told = self.ranked[0], []
        if self.error > COARSE_ERROR:
            told.append(
                f"no law of the library fits: the best misses {100 * self.error:.2g} % of the stress; a foam, a yield "
                "or a slip of the grips are not among them"
            )
        for course, slack in zip(self.courses, chosen.fitted.slack, strict=True):
            if self.request.slack is None and slack > LEAST_SLACK:
                told.append(
                    f"'{course.test.file.name}': {100 * slack:.2g} % of strain before the specimen is loaded are taken "
                    "for slack of the grips or the first touch; --slack-percent 0 keeps them"
                    + ("; that is the most that is taken" if slack > 0.98 * LARGEST_SLACK else "")
                )
        return told

    def _of_courses(self) -> list[str]:
        told = []
        for course in self.courses:
            name, strain = course.test.file.name, float(course.strain.max())
            if strain < 0.98 * self.request.strain_range:
                told.append(f"'{name}': ends at {100 * strain:.3g} % of strain, short of the range of the fit")
            if course.test.has_plain_strain and strain > 2.0:
                told.append(f"'{name}': the strain has no unit and is taken as a fraction: {100 * strain:.4g} %")
            if course.cycles == 1 and not self.request.preconditioned:
                told.append(f"'{name}': of one cycle only the loading is fitted; softening shows in a second one")
            if course.holds_s and not course.holds_in(self.request.strain_range):
                told.append(f"'{name}': its holds lie beyond the range of the fit and say nothing of relaxation")
        return told


def characterise(request: MaterialRequest) -> Characterisation:
    """Read the tests, fit every law and choose the one that predicts best. InputError."""
    _refuse_numbers(request)
    courses = tuple(request.courses())
    curves = tuple(_loading(course, request) for course in courses)
    kinds = len({course.test.kind for course in courses})
    laws = [law for law in STABLE_LAWS if law.name == request.law] or laws_for(kinds)
    ranked = rank_laws(curves, request.slack, laws)
    material = FittedMaterial(ranked[0].fitted, request.poisson_ratio)
    remembers = any(course.cycles > 1 or course.holds_in(request.strain_range) for course in courses)
    if remembers and not request.preconditioned:
        fits = [fit_memory(one.fitted, courses, request.strain_range, request.poisson_ratio)
                for one in ranked[:BEST_LAWS]]  # fmt: skip
        errors = [course_error(one, courses, request.strain_range) for one in fits]
        best = int(np.argmin(errors))
        material, ranked = fits[best], [ranked[best], *ranked[:best], *ranked[best + 1 :]]
    return Characterisation(request, courses, curves, tuple(ranked), material)


def _refuse_numbers(request: MaterialRequest) -> None:
    """InputError for a number outside of what is allowed."""
    if not 0.01 <= request.strain_range <= LARGEST_PLAIN_STRAIN:
        raise InputError(f"--strain-range-percent = {100 * request.strain_range:g}: must be from 1 to 3000")
    if request.slack is not None and not 0.0 <= request.slack <= LARGEST_SLACK:
        raise InputError(f"--slack-percent = {100 * request.slack:g}: must be from 0 to {100 * LARGEST_SLACK:g}")
    if not 0.4 <= request.poisson_ratio < 0.5:
        raise InputError(f"--poisson-ratio = {request.poisson_ratio:g}: must be from 0.4 to below 0.5, of a rubber")
    for name, value in request.sizes.items():
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"--{name.replace('_', '-')} = {value:g}: must be above 0")


def _loading(course: SpecimenCourse, request: MaterialRequest) -> LoadingCurve:
    """The loading to which laws are fitted: the first, or the last of a preconditioned specimen. InputError."""
    strain: Floats = course.strain
    chosen = course.virgin
    if request.preconditioned:
        last = max(int(n) for n in set(course.cycle[course.phase == LOADING].tolist()))
        chosen = (course.cycle == last) & (course.phase == LOADING)
        if last == 0:
            raise InputError(f"'{course.test.file}': has one loading; --preconditioned needs cycles")
        strain = strain - strain[chosen][0]
    chosen = chosen & (strain <= request.strain_range) & (strain >= 0.0)
    if chosen.sum() < 2 * BLOCKS - 2:
        raise InputError(
            f"'{course.test.file}': has {chosen.sum()} samples of loading up to {100 * request.strain_range:g} % of "
            f"strain; {2 * BLOCKS - 2} are needed, or a larger --strain-range-percent"
        )
    return LoadingCurve(course.test.kind, strain[chosen], course.stress_MPa[chosen])


def cycle_peaks(courses: Sequence[SpecimenCourse]) -> list[tuple[str, list[float]]]:
    """File and largest stress in MPa of each cycle, of tests with several."""
    return [(course.test.file.name, course.peaks_MPa) for course in courses if course.cycles > 1]
