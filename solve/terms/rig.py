"""What drives a dot whose approach is unknown: a spring between the rig's sensor and the dot, or a force.

The balance of forces along the approach a is
    F_contact(a) + what else acts on the dot = (u - a) / c    driven by a displacement u through the compliance c, or
                                             = F              driven by a force F.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.terms.base import Block, History, Term, Trial
from solve.terms.builder import Builder
from solve.terms.definition import TermDefinition


@dataclass(frozen=True)
class RigTerm(Term):
    """Spring of the rig, or the force that drives. approach_dof : unknown number; compliance : solver units, None where
    a force drives.

    alone : nothing but the contact resists the force, so that the dot rests where none pushes.
    """

    approach_dof: int
    compliance: float | None
    alone: bool = True
    is_load = True

    @property
    def groups(self) -> tuple[Ints, ...]:
        """The dot's approach."""
        return (np.array([[self.approach_dof]]),)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Residual and tangent of the drive."""
        residual, tangent = -self.drive_force(trial), 0.0
        if self.compliance is not None:
            tangent += 1.0 / self.compliance
        elif np.isinf(trial.time_step) or (trial.drive == 0.0 and self.alone):  # nothing pushes: it is at rest
            residual, tangent = float(trial.x[self.approach_dof]), 1.0
        yield Block(0, slice(0, 1), np.array([[[tangent]]]), np.array([[residual]]))

    def load_norm(self, trial: Trial, forces: Floats) -> float:
        """Magnitude of the force that drives the dot."""
        return abs(self.drive_force(trial))

    def drive_force(self, trial: Trial) -> float:
        """Reading of the rig's force sensor in solver units."""
        if self.compliance is None:
            return trial.drive
        return (trial.drive - float(trial.x[self.approach_dof])) / self.compliance


@dataclass(frozen=True)
class RigSpring(TermDefinition):
    """A compliance between the displacement sensor and the dot, which a force that drives does not feel."""

    compliance_mm_per_N: float = 0.0
    words = "a compliant rig"
    of_rig = True

    @property
    def frees_dot(self) -> bool:
        """Whether the rig gives way, so that the dot's approach is unknown."""
        return not self.is_off

    @property
    def is_off(self) -> bool:
        """Whether the rig is rigid."""
        return self.compliance_mm_per_N == 0.0

    def build(self, make: Builder) -> Iterator[Term]:
        """Build the spring, where a displacement drives."""
        if not (make.force_driven or self.is_off):
            compliance = 1e-3 * self.compliance_mm_per_N * make.units.force / make.units.length / make.share
            yield RigTerm(make.unknowns.approach, compliance)
