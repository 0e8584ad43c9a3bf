"""The discrete problem: residual and tangent of everything that acts on the segment.

Unknowns live in one vector; all are in units of a length (the segment's) and a stress (the stiffest medium's shear
modulus), so that the answer and the iterations do not depend on metres or millimetres. Time is in seconds.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from solve.fem.assembly import scatter, scatter_unsymmetric
from solve.fem.numbering import Unknowns
from solve.fem.pattern import Pattern
from solve.fem.tangent import Tangent
from solve.terms.base import History, Term, Trial
from solve.terms.contact import ContactFacets
from solve.terms.film import FilmRegion
from solve.terms.rig import RigTerm
from solve.terms.solid import SolidRegion
from solve.units import Units

CONTACT_SPRING = 1e4  # only steers the preconditioner of the linear solver


@dataclass(frozen=True)
class Load:
    """What the rig prescribes, in solver units: lateral position of the dot, and its approach or its force."""

    lateral: tuple[float, float]
    drive: float


@dataclass(frozen=True)
class State:
    """A converged state: time in s, load, unknowns, memory of each term, largest norm of contact forces so far.

    time_error : of the step to it, where it exceeds the tolerance (see System.time_error), else zero.
    snapped : Newton found no equilibrium near the one before it (see solve.solution.continuation).
    work, most_work : what the dot has put into the segment, now and at most so far (see solve.solution.work).
    """

    time: float
    load: Load
    x: Floats
    histories: tuple[History, ...]
    force_scale: float = 0.0
    iterations: int = 0
    relative_residual: float = 0.0
    time_error: float = 0.0
    snapped: bool = False
    work: float = 0.0
    most_work: float = 0.0

    @property
    def is_damped(self) -> bool:
        """Whether the step to this state was damped (see solve.terms.base.Trial)."""
        return self.time_error > 0.0


@dataclass(frozen=True)
class Evaluation:
    """Residual (count,), tangent, norm of the contact forces, discrete states of all terms, any node in contact."""

    residual: Floats
    tangent: Tangent
    load_norm: float
    status: Bools
    touching: bool


@dataclass(frozen=True)
class System:
    """All terms of the problem; points in solver units. contact is the contact's geometry, with or without friction."""

    points: Floats
    unknowns: Unknowns
    count: int
    units: Units
    terms: tuple[Term, ...]
    contact: ContactFacets
    pattern: Pattern

    @property
    def solids(self) -> tuple[SolidRegion, ...]:
        """The terms of the media."""
        return tuple(term for term in self.terms if isinstance(term, SolidRegion))

    @property
    def film(self) -> FilmRegion:
        """The term of the film."""
        return next(term for term in self.terms if isinstance(term, FilmRegion))

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is symmetric."""
        return all(term.symmetric for term in self.terms)

    @property
    def rig(self) -> RigTerm | None:
        """The term between the rig's sensor and the dot; None where the dot's depth is prescribed."""
        return next((term for term in self.terms if isinstance(term, RigTerm)), None)

    @property
    def force_driven(self) -> bool:
        """Whether a force drives the dot."""
        return self.rig is not None and self.rig.compliance is None

    @cached_property
    def mechanical(self) -> Ints:
        """Numbers of the displacements that are unknown."""
        numbers = np.unique(self.unknowns.displacement)
        return numbers[numbers >= 0]

    def history_of(self, term: Term, state: State) -> History:
        """Memory of one term in a state."""
        return next(h for t, h in zip(self.terms, state.histories, strict=True) if t is term)

    def at_rest(self, load: Load) -> State:
        """The undeformed state."""
        return State(0.0, load, np.zeros(self.count), tuple(term.start() for term in self.terms))

    def displacement(self, x: Floats) -> Floats:
        """Nodal displacements (n, 3) of an unknown vector (count,)."""
        return np.append(x, 0.0)[self.unknowns.displacement]  # index -1, a prescribed value, reads zero

    def move(self, x: Floats, load: Load) -> Floats:
        """Displacement of the dot (3,)."""
        approach = load.drive if self.unknowns.approach < 0 else x[self.unknowns.approach]
        return np.array([*load.lateral, -approach])

    def trial(self, x: Floats, load: Load, time: float, previous: State, damped: bool = False) -> Trial:
        """A trial state x (count,) after a converged one, as the terms see it; time in s."""
        return Trial(
            x=x,
            displacement=self.displacement(x),
            move=self.move(x, load),
            drive=load.drive,
            previous_displacement=self.displacement(previous.x),
            previous_move=self.move(previous.x, previous.load),
            previous_drive=previous.load.drive,
            time=time,
            time_step=time - previous.time,
            damped=damped,
        )

    def dot_force(self, trial: Trial) -> Floats:
        """Resultant of the dot on the meshed body (3,)."""
        return np.asarray(sum(term.dot_force(trial) for term in self.terms))

    def contact_traction(self, trial: Trial) -> Floats:
        """Traction of the dot on the surface, per undeformed area, at the nodes of the contact facets (c, 3)."""
        return np.asarray(sum(term.contact_traction(trial) for term in self.terms))

    @property
    def factorisation_shift(self) -> Floats:
        """Diagonal of the contact rows for the factorisation only: a stiff spring instead of a constraint."""
        shift = np.zeros(self.count)
        for multipliers, area in (term.constraints() for term in self.terms):
            shift[multipliers] = -area / CONTACT_SPRING
        return shift

    def evaluate(self, trial: Trial, histories: tuple[History, ...]) -> Evaluation:
        """Residual and tangent at a trial state. InvertedElementError."""
        residual = np.zeros(self.count)
        data = np.zeros(len(self.pattern.indices))
        excess = None if self.symmetric else np.zeros(len(data))
        load_norm, touching, status, slots = 0.0, False, [], iter(self.pattern.slots)
        for term, history in zip(self.terms, histories, strict=True):
            before = residual.copy() if term.is_load else residual
            own = [next(slots) for _ in term.groups]
            for block in term.elements(trial, history):
                dofs, slot = term.groups[block.group][block.part], own[block.group][block.part]
                if term.symmetric:
                    scatter(block.matrices, block.residuals, dofs, slot, data, residual)
                else:
                    scatter_unsymmetric(block.matrices, block.residuals, dofs, slot, data, excess, residual)
            status.append(term.status(trial, history))
            if term.is_load:
                load_norm = max(load_norm, term.load_norm(trial, (residual - before)[self.mechanical]))
            touching = touching or term.touches(status[-1])
        upper = self.pattern.matrix(data)
        lower = None if excess is None else self.pattern.matrix(excess)
        return Evaluation(residual, Tangent(upper, lower), load_norm, np.concatenate(status), touching)

    def states(self, trial: Trial, histories: tuple[History, ...]) -> Bools:
        """Discrete states of all terms."""
        return np.concatenate([term.status(trial, own) for term, own in zip(self.terms, histories, strict=True)])

    def with_status(
        self, now: Evaluation, trial: Trial, histories: tuple[History, ...], status: Bools
    ) -> Evaluation | None:
        """The evaluation of a trial state with other discrete states (d,); None where a term does not know how.

        Only the constraints are assembled again, which takes a tenth of the time.
        """
        residual, data = now.residual.copy(), now.tangent.upper.data.copy()
        slots, at = iter(self.pattern.slots), 0
        for term, history in zip(self.terms, histories, strict=True):
            own, count = [next(slots) for _ in term.groups], len(term.status(trial, history))
            before, after = now.status[at : at + count], status[at : at + count]
            at += count
            if np.array_equal(before, after):
                continue
            for sign, states in ((-1.0, before), (1.0, after)):
                blocks = term.elements_in(trial, states)
                if blocks is None:
                    return None
                for block in blocks:
                    dofs, slot = term.groups[block.group][block.part], own[block.group][block.part]
                    scatter(sign * block.matrices, sign * block.residuals, dofs, slot, data, residual)
        return replace(now, residual=residual, tangent=Tangent(self.pattern.matrix(data)), status=status)

    def advance(self, trial: Trial, histories: tuple[History, ...]) -> tuple[History, ...]:
        """Memories once the trial state has converged."""
        return tuple(term.advance(trial, history) for term, history in zip(self.terms, histories, strict=True))

    def time_error(self, state: State, new: State, after_kink: bool) -> float:
        """Largest error estimate of the terms that integrate in time, relative."""
        return max(
            term.time_error(old, now, new.time - state.time, after_kink)
            for term, old, now in zip(self.terms, state.histories, new.histories, strict=True)
        )
