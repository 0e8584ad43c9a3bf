"""A term of the discrete problem: what acts on the segment, with its residual, its tangent and its memory."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from foundation.arrays import Bools, Floats, Ints

History = Any  # arrays that a term carries from one converged state to the next; None for one without memory


@dataclass(frozen=True)
class Trial:
    """A trial state and the converged state before it, in solver units (time in s).

    x : (count,) unknowns; displacement : (n, 3) nodes; move : (3,) displacement of the dot; drive : what the rig
    prescribes of the approach (displacement of the sensor, or force). previous_... : the same, last converged.
    damped : the step is too coarse for the motion of a mass, whose oscillation is to fade.
    """

    x: Floats
    displacement: Floats
    move: Floats
    drive: float
    previous_displacement: Floats
    previous_move: Floats
    previous_drive: float
    time: float
    time_step: float
    damped: bool = False


class Block(NamedTuple):
    """Element matrices (s, k, k) and residuals (s, k) of the elements in part of one group of a term.

    part : a slice, or the numbers of the elements. Symmetric terms fill the upper triangles only.
    """

    group: int
    part: slice | Ints
    matrices: Floats
    residuals: Floats


class Term(ABC):
    """One part of the problem: a medium, the film, a bond, the contact, the rig.

    groups : arrays (m, k) of unknowns, -1 where prescribed, one row an element.
    """

    symmetric = True
    is_load = False  # whether load_norm is to be asked
    inelastic: tuple[Any, ...] = ()  # laws with memory, whose memories are the history of the term

    @property
    @abstractmethod
    def groups(self) -> tuple[Ints, ...]:
        """Unknowns (m, k) of each group of elements."""

    def start(self) -> History:
        """Memory of the undeformed state at rest."""
        return None

    @abstractmethod
    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Residuals and consistent tangents, group by group and chunk by chunk."""

    def advance(self, trial: Trial, history: History) -> History:
        """Memory once the trial state has converged."""
        return history

    def status(self, trial: Trial, history: History) -> Bools:
        """Discrete states (open or touching, stick or slip) that must repeat before Newton has converged."""
        return np.zeros(0, bool)

    def elements_in(self, trial: Trial, status: Bools) -> Iterator[Block] | None:
        """Blocks as of elements, with constraints in these states (d,) in place of the trial's own; None where a term
        has no way.
        """
        return None

    def touches(self, status: Bools) -> bool:
        """Whether the dot touches, by the discrete states of this term."""
        return False

    def load_norm(self, trial: Trial, forces: Floats) -> float:
        """Norm of the load that this term puts on; forces : its part of the residual at the displacements."""
        return 0.0

    def dot_force(self, trial: Trial) -> Floats:
        """Part (3,) of this term in the dot's force on the meshed body."""
        return np.zeros(3)

    def contact_traction(self, trial: Trial) -> Floats:
        """Traction (c, 3) of the dot on the surface, per undeformed area, at nodes of the contact facets; (3,) zeros
        for none.
        """
        return np.zeros(3)

    def constraints(self) -> tuple[Ints, Floats]:
        """Lagrange multipliers without a diagonal entry: their unknowns (c,) and nodal areas (c,)."""
        return np.zeros(0, np.int64), np.zeros(0)

    def time_error(self, history: History, new: History, time_step: float, after_kink: bool) -> float:
        """Estimated error of the time integration in a step, relative; zero for a term without rates.

        after_kink : the rate of loading jumped at the start of the step.
        """
        return 0.0
