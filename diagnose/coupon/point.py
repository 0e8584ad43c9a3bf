"""The answer of a coupon over a whole run: Newton on all samples at once.

Every sample has the residuals
    travel + c force - u = 0 (or force - f = 0)   and   lateral stress = 0
with the tester's compliance c. The stress remembers earlier samples only, so that the linearised system is solved by
forward substitution in time; Newton's iteration converges quadratically whatever relaxes. The largest energies of a
softening law are those of the round before, first of the coupon that does not soften: on first loading it is the same.
"""

from dataclasses import dataclass, replace

import numpy as np

from diagnose.coupon.kinematics import Kinematics, Reading, SimpleShear
from diagnose.coupon.memory import NO_SERIES, Relaxation, earlier_peaks, softened
from diagnose.tables import Drive
from mesh.types import Floats
from solve.materials.inelastic import Prony, Response, Softening
from solve.materials.laws import MediumLaw
from solve.solution.newton import NoEquilibriumError

TOLERANCE = 1e-7  # of the logarithm of the stretch, or of the shear; the iterate behind it errs by the square
MAX_ITERATIONS = 80  # four or five, unless samples lie at the kink of softening
MAX_ROUNDS = 30  # two or three
LARGEST_STEP = 0.3  # of the logarithm of the stretch, or of the shear, in one iteration


@dataclass(frozen=True)
class MaterialPoint:
    """law : in MPa; poisson_ratio : where the iteration starts; compliance_mm_per_N : of the tester."""

    kinematics: Kinematics
    law: MediumLaw
    poisson_ratio: float
    softening: Softening | None = None
    series: Prony = NO_SERIES
    compliance_mm_per_N: float = 0.0

    def answer(self, time_s: Floats, drive: Floats, kind: Drive) -> Floats:
        """Force (t,) in N of a travel (t,) in mm, or travel of a force. NoEquilibriumError."""
        return _Test(self, drive, kind == "displacement_mm", Relaxation.of(self.series, time_s)).answer()

    def travel_if_linear(self, force: Floats) -> Floats:
        """Travel (t,) of a force at the stiffness of small strains."""
        shear, bulk = self.law.shear_modulus, self.law.bulk_modulus
        modulus = shear if isinstance(self.kinematics, SimpleShear) else 9.0 * bulk * shear / (3.0 * bulk + shear)
        return force * self.kinematics.length_mm / (self.kinematics.area_mm2 * modulus)

    def energy(self, unknown: Floats) -> Floats:
        """Strain energy (t,) without softening."""
        return self.law.energy(self.kinematics.cauchy_green(unknown))

    def elastic(self, unknown: Floats, peaks: Floats | None) -> Response:
        """Stress and tangent without relaxation; softened from the largest energies before (t,), where given."""
        c = self.kinematics.cauchy_green(unknown)
        response = Response(*self.law.stress(c))
        if self.softening is None or peaks is None:
            return response
        return softened(self.softening, replace(response, energy=self.law.energy(c)), peaks)

    def reading(self, unknown: Floats, stress: Floats) -> Reading:
        """What the tester reads at a stress (t, 6)."""
        return self.kinematics.reading(unknown, stress, 0.0 if self.law.compressible else self.law.bulk_modulus)


@dataclass(frozen=True)
class _Test:
    """One run: drive (t,) in mm or N."""

    point: MaterialPoint
    drive: Floats
    by_travel: bool
    relaxation: Relaxation

    def answer(self) -> Floats:
        """Force or travel (t,). NoEquilibriumError."""
        point, peaks = self.point, None
        travel = self.drive if self.by_travel else point.travel_if_linear(self.drive)
        unknown = self._settled(point.kinematics.start(travel, point.poisson_ratio), None)
        if point.softening is not None:
            unknown, peaks = self._softened(unknown)
        now = point.reading(unknown, self.relaxation.relaxed(point.elastic(unknown, peaks).stress))
        return now.force if self.by_travel else now.travel + point.compliance_mm_per_N * now.force

    def _softened(self, unknown: Floats) -> tuple[Floats, Floats]:
        """Unknowns with softening and the largest energies before, from those without."""
        for _ in range(MAX_ROUNDS):
            peaks, before = earlier_peaks(self.point.energy(unknown)), unknown
            unknown = self._settled(before, peaks)
            if np.abs(unknown - before).max() <= TOLERANCE:
                return unknown, peaks
        raise self._nowhere()

    def _settled(self, unknown: Floats, peaks: Floats | None) -> Floats:
        """Unknowns (t, m) in balance."""
        last, damping = np.zeros_like(unknown), np.ones((len(unknown), 1))
        for _ in range(MAX_ITERATIONS):
            step = self._step(unknown, self.point.elastic(unknown, peaks))
            largest = float(np.abs(step).max())
            if not np.isfinite(largest):
                break
            damping = _damped(damping, step, last)
            last = np.clip(damping * step, -LARGEST_STEP, LARGEST_STEP)
            unknown = unknown + last
            if largest <= TOLERANCE:
                return unknown
        raise self._nowhere()

    def _step(self, unknown: Floats, elastic: Response) -> Floats:
        """Newton's correction (t, m)."""
        now = self.point.reading(unknown, self.relaxation.relaxed(elastic.stress))
        weight = self.point.compliance_mm_per_N if self.by_travel else 1.0
        along = float(self.by_travel)
        residual = np.column_stack([along * now.travel + weight * now.force - self.drive, now.lateral])
        by_stress = np.concatenate([weight * now.force_stress[:, None, :], now.lateral_stress], axis=1)
        of_drive = along * now.travel_unknown + weight * now.force_unknown
        by_unknown = np.concatenate([of_drive[:, None, :], now.lateral_unknown], axis=1)
        stress_by = np.asarray(elastic.tangent) @ self.point.kinematics.strain_rates(unknown)
        return self.relaxation.newton_step(residual, by_stress, stress_by, by_unknown)

    def _nowhere(self) -> NoEquilibriumError:
        reason = "the coupon has no equilibrium: the stress of its law falls within this travel or force"
        return NoEquilibriumError(reason, self.drive, None)


def _damped(damping: Floats, step: Floats, last: Floats) -> Floats:
    """Share (t, 1) of the step: halved where samples jump to and fro over a kink of softening, else raised to 1."""
    reversed_ = (step * last).sum(axis=1, keepdims=True) < -0.25 * (last * last).sum(axis=1, keepdims=True)
    return np.where(reversed_, 0.5 * damping, np.minimum(1.2 * damping, 1.0))
