"""A verification problem, and its result on this machine."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.linalg import LinAlgError

from mesh.types import MeshingError

ROUND_OFF = 1e-9
"""Relative errors below this tell nothing of an order of convergence."""


@dataclass(frozen=True)
class Problem:
    """One number with a reference that does not come from softdot.

    name : of lower-case words and hyphens. basis : the reason for the bound, a clause without a capital. reference :
    the value to be met. solve : our value, from the number of elements of a mesh where meshes names some, coarse to
    fine, of which the last one counts; ArithmeticError where it has no solution. limit : whether the reference is what
    ever finer meshes tend to, so that its errors have an order, and not a theory with an error of its own.
    """

    name: str
    title: str
    source: str
    unit: str
    bound_percent: float
    basis: str
    reference: Callable[[], float]
    solve: Callable[..., float]
    meshes: tuple[int, ...] = ()
    limit: bool = False

    def outcome(self) -> dict[str, Any]:
        """Solve the problem: name, reference, value, deviation and bound in percent, and whether it passed.

        Where there is no solution, value and deviation are None and failure says why.
        """
        reference = self.reference()
        try:
            values = [float(self.solve(n)) for n in self.meshes] or [float(self.solve())]
        except (ArithmeticError, LinAlgError, MeshingError) as error:
            return {**self._heading(reference), "value": None, "deviation_percent": None, "failure": str(error)}
        deviation = 100.0 * (values[-1] / reference - 1.0)
        return {
            **self._heading(reference),
            "value": values[-1],
            "deviation_percent": deviation,
            "passed": bool(abs(deviation) <= self.bound_percent),
            **({"meshes": self.meshes, "values": values} if self.meshes else {}),
            "observed_order": observed_order(self.meshes, np.array(values) / reference - 1.0) if self.limit else None,
        }

    def _heading(self, reference: float) -> dict[str, Any]:
        """The part of the result that is known before solving; passed is False there."""
        return {
            "name": self.name,
            "title": self.title,
            "source": self.source,
            "unit": self.unit,
            "reference": reference,
            "bound_percent": self.bound_percent,
            "basis": self.basis,
            "passed": False,
        }


def observed_order(meshes: tuple[int, ...], errors: Any) -> float | None:
    """Order in the size of the elements by which errors (m,) fall on the two finest meshes; None where it is unknown.

    >>> round(observed_order((2, 4), [0.04, 0.01]), 9)
    2.0
    >>> observed_order((), [0.1]) is None
    True
    """
    if len(meshes) < 2 or min(abs(error) for error in errors[-2:]) < ROUND_OFF:
        return None
    return float(np.log(abs(errors[-2] / errors[-1])) / np.log(meshes[-1] / meshes[-2]))
