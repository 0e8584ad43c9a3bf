"""A viscous guide that rubs on what moves with the dot, with Stribeck's fall of the friction as a film of oil forms.

    F(v) = c v + F_s exp(-(v / v_s)^2) tanh(v / v_r),      v_r = v_s / 30
(Armstrong-Helouvry, Dupont and Canudas de Wit, Automatica 30, 1994, with tanh in place of the sign of v). What it rubs
at any speed is in solve.terms.guide.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.added import Motion
from solve.terms.base import Block, History, Term, Trial
from solve.terms.builder import Builder
from solve.terms.definition import TermDefinition

SHARPNESS = 30.0  # v_s / v_r: below a thirtieth of Stribeck's speed the guide sticks by its elasticity


@dataclass(frozen=True)
class GuideTerm(Term):
    """F(v) on the approach, whose velocity is that over the step.

    dof : number of the approach. mm, newton : one of each in solver units.
    """

    dof: int
    guide: "ViscousGuide"
    mm: float
    newton: float

    @property
    def groups(self) -> tuple[Ints, ...]:
        """The dot's approach."""
        return (np.array([[self.dof]]),)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Force of the guide and its tangent."""
        speed = float(trial.x[self.dof] + trial.previous_move[2]) / trial.time_step
        rubs, slope = self.guide.friction(np.array(speed / self.mm))
        tangent = float(slope) / (self.mm * trial.time_step)
        yield Block(0, slice(0, 1), np.array([[[tangent * self.newton]]]), np.array([[float(rubs) * self.newton]]))


@dataclass(frozen=True)
class ViscousGuide(TermDefinition):
    """Force per velocity, and Stribeck's friction with the speed at which it has faded to 1/e."""

    viscous_N_s_per_mm: float = 0.0
    stribeck_N: float = 0.0
    stribeck_mm_per_s: float = 1.0
    words = "a viscous guide"
    follows_time = True
    of_rig = True
    resists = True

    @property
    def is_off(self) -> bool:
        """No force at any speed."""
        return self.viscous_N_s_per_mm == self.stribeck_N == 0.0

    def friction(self, v: Floats) -> tuple[Floats, Floats]:
        """Force in N and its derivative, at velocities in mm/s."""
        sharp = self.stribeck_mm_per_s / SHARPNESS
        fades, turns = np.exp(-((v / self.stribeck_mm_per_s) ** 2)), np.tanh(v / sharp)
        slope = fades * ((1.0 - turns**2) / sharp - 2.0 * v / self.stribeck_mm_per_s**2 * turns)
        force = self.viscous_N_s_per_mm * v + self.stribeck_N * fades * turns
        return np.asarray(force), np.asarray(self.viscous_N_s_per_mm + self.stribeck_N * slope)

    def build(self, make: Builder) -> Iterator[Term]:
        """On the approach, where it is unknown."""
        if make.unknowns.approach >= 0:
            newton = make.share / make.units.force
            yield GuideTerm(make.unknowns.approach, self, 1e-3 / make.units.length, newton)

    def force_N(self, motion: Motion) -> Floats:
        """Friction (t,) in N along a prescribed path."""
        return self.friction(motion.velocity())[0]
