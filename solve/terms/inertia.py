"""The mass that moves with the dot, by the alpha method of Wood, Bossak and Zienkiewicz.

Second order (Int. J. Numer. Methods Eng. 15, 1981): the mass feels (1 - alpha) a''_new + alpha a''_old, Newmark's
beta = (1 - alpha)^2 / 4, gamma = 1/2 - alpha. Of an oscillation too fast for the step a share FADE is left after each;
one that is resolved keeps its energy to third order. Without this a small mass between coarse steps would ring at a
made-up frequency for ever.

Where the dot strikes within a step that is too coarse for the blow, the velocities of that method are made up, and the
dot may rebound with more energy than it came with. Such a step is damped: by Euler's implicit method, which never gains
energy against a contact whose force grows with the depth.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.added import Motion
from solve.terms.base import Block, History, Term, Trial
from solve.terms.builder import Builder
from solve.terms.definition import TermDefinition

FADE = 0.5  # spectral radius at infinite frequency
ALPHA = (FADE - 1.0) / (FADE + 1.0)
BETA, GAMMA = 0.25 * (1.0 - ALPHA) ** 2, 0.5 - ALPHA


@dataclass(frozen=True)
class MassTerm(Term):
    """Mass that moves with the dot. approach_dof : unknown number; mass : solver units, above 0."""

    approach_dof: int
    mass: float

    @property
    def groups(self) -> tuple[Ints, ...]:
        """The dot's approach."""
        return (np.array([[self.approach_dof]]),)

    def start(self) -> History:
        """Velocity and acceleration of the dot, and the approach itself, at rest (3,)."""
        return np.zeros(3)

    def _motion(self, trial: Trial, history: History) -> Floats:
        """Velocity, acceleration and approach at the end of the step."""
        velocity, acceleration, before = history
        now, dt = float(trial.x[self.approach_dof]), trial.time_step
        if np.isinf(dt):  # long at rest
            return np.array([0.0, 0.0, now])
        if trial.damped:
            mean = (now - before) / dt
            return np.array([mean, (mean - velocity) / dt, now])
        new = (now - before - dt * velocity) / (BETA * dt**2) - (0.5 / BETA - 1.0) * acceleration
        return np.array([velocity + dt * ((1.0 - GAMMA) * acceleration + GAMMA * new), new, now])

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Force of inertia and its tangent."""
        new, alpha, beta = float(self._motion(trial, history)[1]), *((0.0, 1.0) if trial.damped else (ALPHA, BETA))
        residual = self.mass * ((1.0 - alpha) * new + alpha * float(history[1]))
        tangent = self.mass * (1.0 - alpha) / (beta * trial.time_step**2)
        yield Block(0, slice(0, 1), np.array([[[tangent]]]), np.array([[residual]]))

    def advance(self, trial: Trial, history: History) -> History:
        """Motion at the converged state."""
        return self._motion(trial, history)

    def time_error(self, history: History, new: History, time_step: float, after_kink: bool) -> float:
        """Local error (beta - 1/6) dt^2 (a_new - a_old) of the approach (Zienkiewicz and Xie, 1991), relative to it.

        The acceleration does not jump where the rate of loading does.
        """
        largest = max(abs(float(new[2])), abs(float(history[2])), 1e-12)
        return (BETA - 1.0 / 6.0) * time_step**2 * abs(float(new[1] - history[1])) / largest


@dataclass(frozen=True)
class MovingMass(TermDefinition):
    """A mass between the force sensor and the dot."""

    mass_g: float = 0.0
    words = "a moving mass"
    follows_time = True
    of_rig = True
    resists = True

    @property
    def is_off(self) -> bool:
        """Whether there is no mass."""
        return self.mass_g == 0.0

    def build(self, make: Builder) -> Iterator[Term]:
        """Build the mass on the approach, where that is unknown."""
        if make.unknowns.approach >= 0:
            yield MassTerm(make.unknowns.approach, 1e-3 * self.mass_g / make.units.mass * make.share)

    def force_N(self, motion: Motion) -> Floats:
        """Force of inertia m a'' (t,) in N."""
        return np.asarray(1e-6 * self.mass_g * motion.acceleration())
