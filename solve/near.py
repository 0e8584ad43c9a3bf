"""A press from the equilibria of a similar one: Newton's method starts beside each of them, without the steps between.

Moduli, glue or remembered stress change an equilibrium less than the way down to it does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mesh.types import Floats, Ints, TetMesh
from solve.linear import LinearSolver
from solve.march import march
from solve.newton import NoEquilibriumError, equilibrate
from solve.schedule import Target
from solve.system import State, System


@dataclass(frozen=True)
class Equilibria:
    """Of one press at n places, element by element, so that any numbering of the unknowns can read them.

    displacement_m : (n, m, 10, 3) of the nodes of the tetrahedra. pressure_Pa : (n, m, 4) of their corners.
    contact_Pa : (n, k, 6) of the nodes of the contact's facets. What acts in one place only, a glue or an electrode,
    is left out.
    """

    displacement_m: Floats
    pressure_Pa: Floats
    contact_Pa: Floats

    @classmethod
    def of(cls, system: System, tet_mesh: TetMesh, found: Sequence[Floats]) -> "Equilibria":
        """Of unknowns (count,) at each place."""
        displacement, pressure, contact = _places(system, tet_mesh)
        known = np.column_stack([np.array(found), np.zeros(len(found))])  # index -1, a prescribed value, reads zero
        units = system.units
        return cls(known[:, displacement] * units.length, known[:, pressure] * units.stress,
                   known[:, contact] * units.stress)  # fmt: skip

    def unknowns(self, system: System, tet_mesh: TetMesh) -> list[Floats]:
        """(count,) at each place, for another system on these elements. ValueError on other elements."""
        places, units = _places(system, tet_mesh), system.units
        known = self.displacement_m / units.length, self.pressure_Pa / units.stress, self.contact_Pa / units.stress
        if any(values.shape[1:] != place.shape for place, values in zip(places, known, strict=True)):
            raise ValueError("the equilibria are those of other elements")
        found = np.zeros((len(self.displacement_m), system.count + 1))
        for place, values in zip(places, known, strict=True):
            found[:, place] = values
        return list(found[:, :-1])


def _places(system: System, tet_mesh: TetMesh) -> tuple[Ints, Ints, Ints]:
    """Numbers of the unknowns by element: (m, 10, 3), (m, 4) and (k, 6)."""
    numbers = system.unknowns
    return numbers.displacement[tet_mesh.tets], numbers.pressure, numbers.contact[tet_mesh.facets["contact"]]


def guess(near: Sequence[Floats], places: Sequence[float] | Floats, found: Sequence[Floats]) -> Floats:
    """The next of the unknowns (count,): those nearby, and the difference of those found so far, carried on linearly.

    near : at each of the places, which ascend; found : at the first of them, one at least.
    """
    last = len(found) - 1
    off = found[-1] - near[last]
    if last > 0:
        rate = (off - (found[-2] - near[last - 1])) / (places[last] - places[last - 1])
        off = off + rate * (places[last + 1] - places[last])
    return np.asarray(near[last + 1] + off)


def reach(
    system: System, linear: LinearSolver, past: list[State], target: Target, kink: bool, beside: Floats | None
) -> str | None:
    """At once from a guess (count,) beside the equilibrium, else by marching; as solve.march.march."""
    if beside is not None:
        try:
            past.append(equilibrate(system, linear, beside, target.load, target.time, past[-1]))
        except NoEquilibriumError:
            pass
        else:
            del past[:-3]
            return None
    return march(system, linear, past, target, kink, lambda *_: None)
