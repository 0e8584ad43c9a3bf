"""A press from the equilibria of a similar one: Newton's method starts beside each of them, without the steps between.

Moduli, glue or remembered stress change an equilibrium less than the way down to it does, so that a similar press is a
good start.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from mesh.symmetry import MIRRORED_TET_NODES
from mesh.types import UPSIDE_DOWN, Planes, TetMesh
from solve.solution.crushing import crushes
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolver
from solve.solution.march import march
from solve.solution.newton import equilibrate
from solve.solution.schedule import Target
from solve.system import State, System

Found = Sequence[tuple[float, Floats]]
"""Places and the unknowns (count,) there, one at least, in the order in which they were found."""


@dataclass(frozen=True)
class Equilibria:
    """Equilibria of one press at n places, element by element, so that any numbering of the unknowns can read them.

    places : (n,), ascending. displacement_m : (n, m, 10, 3) of the nodes of the tetrahedra. pressure_Pa : (n, m, 4) of
    their corners. contact_Pa : (n, k, 6) of the nodes of the contact's facets. What acts in one place only, a glue or
    an electrode, is left out.
    """

    places: Floats
    displacement_m: Floats
    pressure_Pa: Floats
    contact_Pa: Floats

    @classmethod
    def of(cls, system: System, tet_mesh: TetMesh, found: Found) -> "Equilibria":
        """Equilibria of a system, of places, which ascend, and the unknowns there."""
        displacement, pressure, contact = _unknowns_by_element(system, tet_mesh)
        course, units = Course.of(found), system.units
        known = np.column_stack([course.unknowns, np.zeros(len(found))])  # index -1, a prescribed value, reads zero
        return cls(course.places, known[:, displacement] * units.length, known[:, pressure] * units.stress,
                   known[:, contact] * units.stress)  # fmt: skip

    def unfold(self, axes: Planes) -> "Equilibria":
        """The equilibria on the elements of mesh.symmetry.mirrored_mesh about these planes."""
        moved, pressure, contact = self.displacement_m, self.pressure_Pa, self.contact_Pa
        for axis in axes:
            sign = np.ones(3)
            sign[axis] = -1.0
            moved = np.concatenate([moved, moved[:, :, MIRRORED_TET_NODES] * sign], axis=1)
            pressure = np.concatenate([pressure, pressure[:, :, MIRRORED_TET_NODES[:4]]], axis=1)
            contact = np.concatenate([contact, contact[:, :, UPSIDE_DOWN]], axis=1)
        return Equilibria(self.places, moved, pressure, contact)

    def course(self, system: System, tet_mesh: TetMesh) -> "Course | None":
        """Unknowns of another system on these elements; None on other ones, such as a slice in the place of a solid."""
        numbers, units = _unknowns_by_element(system, tet_mesh), system.units
        known = self.displacement_m / units.length, self.pressure_Pa / units.stress, self.contact_Pa / units.stress
        if any(values.shape[1:] != place.shape for place, values in zip(numbers, known, strict=True)):
            return None
        found = np.zeros((len(self.places), system.count + 1))
        for place, values in zip(numbers, known, strict=True):
            found[:, place] = values
        return Course(self.places, found[:, :-1])


def _unknowns_by_element(system: System, tet_mesh: TetMesh) -> tuple[Ints, Ints, Ints]:
    """Numbers of the unknowns by element: displacements (m, 10, 3), pressures (m, 4) and contact pressures (k, 6)."""
    numbers = system.unknowns
    return numbers.displacement[tet_mesh.tets], numbers.pressure, numbers.contact[tet_mesh.facets["contact"]]


@dataclass(frozen=True)
class Course:
    """Course of a similar press: unknowns (n, count) at places (n,), which ascend."""

    places: Floats
    unknowns: Floats

    @classmethod
    def of(cls, found: Found) -> "Course":
        """Course of places, which ascend, and the unknowns (count,) there."""
        places, unknowns = zip(*found, strict=True)
        return cls(np.array(places), np.array(unknowns))

    def at(self, place: float) -> Floats:
        """Unknowns (count,) at a place, on the straight line between the two beside it."""
        i = int(np.clip(np.searchsorted(self.places, place), 1, len(self.places) - 1))
        before, after = self.places[i - 1 : i + 1]
        share = (place - before) / (after - before)
        return np.asarray((1.0 - share) * self.unknowns[i - 1] + share * self.unknowns[i])

    def guess(self, found: Found, place: float) -> Floats:
        """Unknowns (count,) at a place: those of this course, and the difference of the last two found, carried on."""
        (last, x), *before = found[:-3:-1]
        off = x - self.at(last)
        for earlier, y in before:
            off = off + (off - (y - self.at(earlier))) * (place - last) / (last - earlier)
        return np.asarray(self.at(place) + off)


def weighted_sum(*weighed: tuple[float, Course]) -> Course:
    """Weighted sum of courses, at the places of the first."""
    places = weighed[0][1].places
    return Course(places, np.array([sum(weight * course.at(place) for weight, course in weighed) for place in places]))


def reach(
    system: System, linear: LinearSolver, past: list[State], target: Target, kink: bool, guess: Floats | None
) -> str | None:
    """Reach a target at once from a guess (count,) beside the equilibrium, else by march, and return what that
    returns. An element that is crushed where the similar press had crushed it too is no fold that this step made.
    """
    if guess is not None:
        with suppress(NoEquilibriumError):
            state = equilibrate(system, linear, guess, target.load, target.time, past[-1])
            last = past[-1].x
            if crushes(system, last, guess) or not crushes(system, last, state.x):
                past.append(state)
                del past[:-2]
                return None
    return march(system, linear, past, target, kink, lambda *_: None)
