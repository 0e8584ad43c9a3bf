"""The answer of a coupon over a whole run: Newton on all samples at once.

Every sample has the residuals
    travel + c force - u = 0 (or force - f = 0)   and   lateral stress = 0
with the tester's compliance c. The stress remembers earlier samples only, so that the linearised system is solved by
forward substitution in time; Newton's iteration converges quadratically whatever relaxes. The largest energies of a
softening law are those of the round before, first of the coupon that does not soften: on first loading it is the same.
What relaxes is in relaxation.py and flow.py; softening is a running maximum.
"""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from diagnose.engines.coupon.flow import FlowingBranches
from diagnose.engines.coupon.kinematics import Kinematics, SimpleShear, TesterReading
from diagnose.engines.coupon.relaxation import NO_SERIES, Relaxation
from diagnose.signals.recording import Drive
from foundation.arrays import Floats
from solve.materials.inelastic import StressResponse
from solve.materials.laws import MediumLaw
from solve.materials.mullins import Softening
from solve.materials.multiplicative import MultiplicativeMaxwell
from solve.materials.prony import Prony
from solve.solution.errors import NoEquilibriumError


def earlier_peaks(energy: Floats, before: float = 0.0) -> Floats:
    """Largest energy (t,) before each sample of a history (t,); before : the largest before the first sample."""
    return np.maximum.accumulate(np.concatenate([[before], energy[:-1]]))


def soften(law: Softening, elastic: StressResponse, peaks: Floats) -> StressResponse:
    """Response (t points) where every sample remembers a largest energy (t,)."""
    return replace(law.update(elastic, (peaks,), 0.0)[0], energy=None)


def youngs_modulus_MPa(law: MediumLaw) -> float:
    """Young's modulus at small strains, 9 K G / (3 K + G)."""
    shear, bulk = law.shear_modulus, law.bulk_modulus
    return 9.0 * bulk * shear / (3.0 * bulk + shear)


STRETCH_TOLERANCE = 1e-6  # of the logarithm of the stretch, or of the shear; the iterate behind it errs by the square
MAX_NEWTON_ITERATIONS = 80  # four or five, unless samples lie at the kink of softening
MAX_SOFTENING_ROUNDS = 30  # two or three
DRIVE_SHARES = 0.3, 0.6, 0.85  # on the way to a drive that is too far from small strains for Newton's method
PULL_STEPS = 10  # to the largest drive of an earlier run
LARGEST_NEWTON_STEP = 0.3  # of the logarithm of the stretch, or of the shear, in one iteration


@dataclass(frozen=True)
class PointAnswer:
    """Answer of a material point. values (t,) : force in N or travel in mm. unknown (t, m) : where nothing softens."""

    values: Floats
    unknown: Floats


@dataclass(frozen=True)
class MaterialPoint:
    """A coupon that deforms uniformly. law : in MPa. poisson_ratio : from which the iteration starts.

    series : what relaxes. compliance_mm_per_N : of the tester.
    """

    kinematics: Kinematics
    law: MediumLaw
    poisson_ratio: float
    softening: Softening | None = None
    series: Prony = NO_SERIES
    compliance_mm_per_N: float = 0.0

    def answer(self, time_s: Floats, drive: Floats, kind: Drive) -> Floats:
        """Force (t,) in N under a travel (t,) in mm, or travel under a force. NoEquilibriumError."""
        return self.answer_near(time_s, drive, kind).values

    def answer_near(
        self, time_s: Floats, drive: Floats, kind: Drive, near: Floats | None = None, peak_before: float = 0.0
    ) -> PointAnswer:
        """Answer with its unknowns. near (t, m) : those of a similar point, from which the iteration starts.

        peak_before : largest energy of the specimen in earlier runs, MPa. NoEquilibriumError.
        """
        test = _CouponRun(self, drive, kind == "displacement_mm", self.relaxation(time_s), peak_before)
        start = test.initial_unknowns()
        for nearby in (start,) if near is None else (near, start):
            with suppress(NoEquilibriumError):
                return test.answer_near(nearby)
        for share in DRIVE_SHARES:
            start = replace(test, drive=share * drive).answer_near(start).unknown
        return test.answer_near(start)

    def relaxation(self, time_s: Floats) -> Relaxation | FlowingBranches:
        """Relaxation of the point's series at times (t,) in s."""
        if isinstance(self.series, MultiplicativeMaxwell):
            return FlowingBranches.from_series(self.series, self.law.shear_modulus, time_s)
        return Relaxation.from_series(self.series, time_s)

    def peak_energy(self, largest: Mapping[Drive, float]) -> float:
        """Largest energy in MPa under drives that reach these values, one after the other. NoEquilibriumError."""
        if self.softening is None or not largest:
            return 0.0
        elastic, time = replace(self, softening=None, series=NO_SERIES), np.arange(1.0 + PULL_STEPS)
        pulls = [elastic.answer_near(time, value * time / PULL_STEPS, kind) for kind, value in largest.items()]
        return max(float(self.energy(pull.unknown[-1:])[0]) for pull in pulls)

    def travel_if_linear(self, force: Floats) -> Floats:
        """Travel (t,) in mm under a force (t,) in N at the stiffness of small strains."""
        sheared = isinstance(self.kinematics, SimpleShear)
        modulus = self.law.shear_modulus if sheared else youngs_modulus_MPa(self.law)
        return force * self.kinematics.length_mm / (self.kinematics.area_mm2 * modulus)

    def energy(self, unknown: Floats) -> Floats:
        """Strain energy (t,) in MPa at unknowns (t, m), without softening."""
        return self.law.energy(self.kinematics.cauchy_green(unknown))

    def elastic_response(self, unknown: Floats, peaks: Floats | None) -> StressResponse:
        """Stress and tangent at unknowns (t, m) without relaxation; softened by earlier peak energies (t,) if given."""
        c = self.kinematics.cauchy_green(unknown)
        response = StressResponse(*self.law.stress(c))
        if self.softening is None or peaks is None:
            return response
        return soften(self.softening, replace(response, energy=self.law.energy(c)), peaks)

    def tester_reading(self, unknown: Floats, stress: Floats) -> TesterReading:
        """Force, travel and lateral stress that the tester reads at unknowns (t, m) and stress (t, 6)."""
        return self.kinematics.tester_reading(unknown, stress, 0.0 if self.law.compressible else self.law.bulk_modulus)


@dataclass(frozen=True)
class _CouponRun:
    """One run of a coupon test. drive (t,) : in mm or N. peak_before : largest energy in earlier runs, MPa."""

    point: MaterialPoint
    drive: Floats
    by_travel: bool
    relaxation: Relaxation | FlowingBranches
    peak_before: float

    def initial_unknowns(self) -> Floats:
        """Unknowns (t, m) near those of small strains."""
        travel = self.drive if self.by_travel else self.point.travel_if_linear(self.drive)
        return self.point.kinematics.initial_unknowns(travel, self.point.poisson_ratio)

    def answer_near(self, start: Floats) -> PointAnswer:
        """Force or travel, from unknowns (t, m) nearby. NoEquilibriumError."""
        point = self.point
        elastic, stress = self._solve_balance(start, None)
        unknown, stress = (elastic, stress) if point.softening is None else self._solve_softening(elastic)
        now = point.tester_reading(
            unknown, self.relaxation.relaxed_stress(stress, point.kinematics.cauchy_green(unknown))
        )
        answer = now.force if self.by_travel else now.travel + point.compliance_mm_per_N * now.force
        return PointAnswer(answer, elastic)

    def _solve_softening(self, unknown: Floats) -> tuple[Floats, Floats]:
        """Unknowns (t, m) and elastic stress (t, 6) with softening, from the unknowns without."""
        for _ in range(MAX_SOFTENING_ROUNDS):
            peaks, before = earlier_peaks(self.point.energy(unknown), self.peak_before), unknown
            unknown, stress = self._solve_balance(before, peaks)
            if np.abs(unknown - before).max() <= STRETCH_TOLERANCE:
                return unknown, stress
        raise self._no_equilibrium()

    def _solve_balance(self, unknown: Floats, peaks: Floats | None) -> tuple[Floats, Floats]:
        """Unknowns (t, m) in balance, and the elastic stress (t, 6) there, by its tangent over the last step."""
        last, damping = np.zeros_like(unknown), np.ones((len(unknown), 1))
        for _ in range(MAX_NEWTON_ITERATIONS):
            elastic = self.point.elastic_response(unknown, peaks)
            strain_by = self.point.kinematics.strain_derivatives(unknown)
            stress_by = np.asarray(elastic.tangent) @ strain_by
            step = self._newton_correction(unknown, elastic.stress, stress_by, strain_by)
            largest = float(np.abs(step).max())
            if not np.isfinite(largest):
                break
            damping = _damping(damping, step, last)
            last = np.clip(damping * step, -LARGEST_NEWTON_STEP, LARGEST_NEWTON_STEP)
            unknown = unknown + last
            if largest <= STRETCH_TOLERANCE:
                return unknown, elastic.stress + np.einsum("tcm,tm->tc", stress_by, last)
        raise self._no_equilibrium()

    def _newton_correction(self, unknown: Floats, stress: Floats, stress_by: Floats, strain_by: Floats) -> Floats:
        """Newton's correction (t, m). stress (t, 6) : the elastic one. stress_by, strain_by (t, 6, m) : derivatives."""
        strain = self.point.kinematics.cauchy_green(unknown)
        now = self.point.tester_reading(unknown, self.relaxation.relaxed_stress(stress, strain))
        weight = self.point.compliance_mm_per_N if self.by_travel else 1.0
        along = float(self.by_travel)
        residual = np.column_stack([along * now.travel + weight * now.force - self.drive, now.lateral])
        by_stress = np.concatenate([weight * now.force_stress[:, None, :], now.lateral_stress], axis=1)
        of_drive = along * now.travel_unknown + weight * now.force_unknown
        by_unknown = np.concatenate([of_drive[:, None, :], now.lateral_unknown], axis=1)
        return self.relaxation.newton_step(residual, by_stress, stress_by, by_unknown, strain, strain_by)

    def _no_equilibrium(self) -> NoEquilibriumError:
        reason = "the coupon has no equilibrium: the stress of its law falls within this travel or force"
        return NoEquilibriumError(reason, self.drive, None)


def _damping(damping: Floats, step: Floats, last: Floats) -> Floats:
    """Damping (t, 1) of a step: halved where samples jump to and fro over a kink of softening, else raised to 1."""
    reversed_ = (step * last).sum(axis=1, keepdims=True) < -0.25 * (last * last).sum(axis=1, keepdims=True)
    return np.where(reversed_, 0.5 * damping, np.minimum(1.2 * damping, 1.0))
