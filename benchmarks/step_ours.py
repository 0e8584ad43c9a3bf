"""Assembly and one Newton step of the cube by softdot: python -m benchmarks.step_ours CELLS [LAW [REPEATS]].

LAW : "mixed" (what softdot uses for rubber) or "displacement" (FElupe's law for step_felupe, by our foam's kernel).
"""

import json
import sys
from collections.abc import Callable

import numpy as np

from benchmarks.cube import BULK, SHEAR, Cube, cube, state
from benchmarks.displacement_law import DisplacementLaw
from benchmarks.timing import REPEATS, Phases
from solve.fem.assembly import scatter
from solve.fem.numbering import along_x
from solve.fem.pattern import build_pattern
from solve.fem.tangent import Tangent
from solve.materials.laws import InvariantLaw
from solve.solution.factorisation import Pardiso
from solve.terms.base import Trial
from solve.terms.solid import solid_region


def law_of(name: str) -> InvariantLaw:
    """The law by name."""
    if name == "displacement":
        return DisplacementLaw(SHEAR / 2.0)
    return InvariantLaw(SHEAR / 2.0, 0.0, 0.0, 0.0, BULK)


def numbering(case: Cube, name: str) -> np.ndarray:
    """Our number of each of the case's unknowns, as solve.fem.pattern numbers those of a segment."""
    nodes = np.nonzero(case.displacement_dofs >= 0)[0]
    if name == "mixed":
        nodes = np.append(nodes, case.corners)
    return along_x(case.points[nodes])


def assembler(case: Cube, name: str) -> Callable[[], tuple[Tangent, np.ndarray]]:
    """Assembly of tangent and residual at the case's state, in our numbers."""
    new = numbering(case, name)
    count, width = len(new), 34 if name == "mixed" else 30
    dofs = np.append(new, -1)[case.dofs[:, :width]]
    solid = solid_region("cube", law_of(name), case.points, case.tets, dofs)
    pattern = build_pattern([dofs], count)
    u, p = state(case.points)
    x = np.empty(count)
    x[new] = np.append(u[case.displacement_dofs >= 0], p[case.corners])[:count]
    trial = Trial(x, u, np.zeros(3), 0.0, u, np.zeros(3), 0.0, 0.0, 1.0)

    def assemble() -> tuple[Tangent, np.ndarray]:
        residual, data = np.zeros(count), np.zeros(len(pattern.indices))
        for _, part, ke, re in solid.elements(trial, solid.start()):
            scatter(ke, re, dofs[part], pattern.slots[0][part], data, residual)
        return Tangent(pattern.matrix(data)), residual

    return assemble


def measure(cells: int, law: str, repeats: int) -> dict:
    """Medians of the phases; the analysis of the pattern is done once, as in a press."""
    case, once, phases = cube(cells), Phases(), Phases()
    assemble = once("prepare", assembler, case, law)
    tangent, _ = assemble()
    direct = Pardiso()
    once("analyse and factorise", direct.factorise, tangent)
    for _ in range(repeats):
        tangent, residual = phases("assemble", assemble)
        phases("factorise", direct.factorise, tangent)
        step = phases("solve", direct.back_substitute, -residual)
    error = np.linalg.norm(tangent @ step + residual) / np.linalg.norm(residual)
    step = step[numbering(case, law)]
    first = case.displacement_dofs[case.corners].max(axis=1) >= 0
    corner = step[case.displacement_dofs[case.corners][first]]
    answer = {"corners": float(np.linalg.norm(corner)), "pressure": float(np.linalg.norm(step[-len(case.corners) :]))}
    return {
        "unknowns": len(step),
        "elements": len(case.tets),
        "seconds": phases.medians(),
        "once": once.medians(),
        "linear_residual": float(error),
        "step": answer,
    }


if __name__ == "__main__":
    chosen = sys.argv[2] if len(sys.argv) > 2 else "mixed"
    print(json.dumps(measure(int(sys.argv[1]), chosen, int(sys.argv[3]) if len(sys.argv) > 3 else REPEATS)))
