"""One dot over one segment of an array by NGSolve; see ngsolve_press.py, from which contact and solver come.

A program of its own, CASE.npz -> JSON on stdout. Half of the array at y >= 0 is solved; the dot stands at x = dot_x.
The elements follow the edges of the electrodes, so that each is a set of whole elements.
"""

import json
import sys

import ngsolve as ng
import numpy as np
from ngsolve_plate import D31, D32, D33, RELATIVE_PERMITTIVITY, VACUUM_PF_PER_MM
from ngsolve_press import DotPress


class DotOnArray(DotPress):
    """A half of an array under a rigid sphere."""

    def __init__(self, case) -> None:
        self.dot_x, self.electrodes = float(case["dot_x"]), case["electrodes"]
        super().__init__(case)

    def _arm(self, u):
        """From the centre of the sphere to the surface."""
        return super()._arm(u) - ng.CF((self.dot_x, 0.0, 0.0))

    def _voltage(self) -> list[float]:
        """Open-circuit voltage of each electrode."""
        stress, _ = self._film_stress(self.state.components[0])
        density = D31 * stress[0, 0] + D32 * stress[1, 1] + D33 * stress[2, 2]
        film = ng.dx(definedon=self.domain.Materials("film"))
        found = []
        for x0, x1 in self.electrodes:
            under = ng.IfPos(ng.x - x0, 1.0, 0.0) * ng.IfPos(x1 - ng.x, 1.0, 0.0)
            charge = ng.Integrate(under * density * film, self.domain) / self.thickness
            area = ng.Integrate(under * film, self.domain) / self.thickness
            found.append(charge / (RELATIVE_PERMITTIVITY * VACUUM_PF_PER_MM * area / self.thickness))
        return found


if __name__ == "__main__":
    with np.load(sys.argv[1]) as case:
        print(json.dumps(DotOnArray(case).press(float(case["depth"]), int(case["steps"]))))
