"""Presses of the 3D model that fill the tables: down, and from several depths up again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from foundation.arrays import Floats
from geometry.dot_at_rest import resolve_dot
from mesh.types import TetMesh
from solve.model import Model, Press
from solve.setup import Setup, discretise
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolver
from solve.solution.march import rest_state
from solve.solution.schedule import Target
from solve.solution.similar_press import Equilibria, reach
from solve.system import Load, State

RETURN = 0.95, 0.85, 0.75, 0.6, 0.4, 0.15, 0.03
"""Of the depth from which the dot returns: closest where softened rubber leaves its first curve."""


@dataclass(frozen=True)
class DepthPress:
    """One press of a model on a mesh to depth_mm, seen at shares (n,) of it, growing from above 0 to 1.

    back : numbers of the shares from which the dot also returns; seen on the way at `returns` of that depth.
    parts : steps to each share: slip takes several, and what guides it. guides : whether its equilibria are kept for
    others.
    guided_by : name in solve.tables.cache of such a press, to start from; "" for none.
    """

    model: Model
    tet_mesh: TetMesh
    depth_mm: float
    shares: tuple[float, ...]
    back: tuple[int, ...] = ()
    returns: tuple[float, ...] = RETURN
    parts: int = 1
    guides: bool = False
    guided_by: str = ""

    def solve(self, near: Equilibria | None = None) -> tuple[Floats, Equilibria | None]:
        """Solve the press: outputs (n + b r, 2 + e), force in N, contact area in m2, charges in C; down, then way back
        by way back.

        Also, where it guides, the equilibria at rest and on the way down. near : those of a similar press.
        NoEquilibriumError.
        """
        setup = _set_up(self)
        linear = LinearSolver(setup.system.factorisation_shift)
        try:
            outputs, found = _press_all(self, setup, linear, near)
        finally:
            linear.close()
        return outputs, Equilibria.of(setup.system, setup.tet_mesh, found) if self.guides else None


def _set_up(job: DepthPress) -> Setup:
    model = replace(job.model, press=Press(indentation_mm=job.depth_mm))
    return discretise(model, job.tet_mesh, resolve_dot(model.dot, model.segment))


def _press_all(
    job: DepthPress, setup: Setup, linear: LinearSolver, near: Equilibria | None
) -> tuple[Floats, list[tuple[float, Floats]]]:
    """Press to all shares, and back from some: outputs, and the unknowns at each place on the way down."""
    start = Target(0.0, Load((0.0, 0.0), 0.0), True)
    rest = rest_state(setup.system, linear, start)
    setup.recorder.start(rest)
    places = 0.0, *job.shares
    beside = near.unfold(setup.unfolded).course(setup.system, setup.tet_mesh) if near is not None else None
    past, found, down, back = [rest], [(0.0, rest.x)], list[Floats](), list[Floats]()
    for number, (before, share) in enumerate(pairwise(places)):
        for place in np.linspace(before, share, job.parts + 1)[1:]:
            _press_to(setup, linear, past, place, beside.guess(found, place) if beside else None)
            found.append((place, past[-1].x))
        down.append(_outputs(setup, past))
        if number in job.back:
            returning = past[-1:]
            for part in job.returns:
                _press_to(setup, linear, returning, part * share)
                back.append(_outputs(setup, returning))
    return np.array([*down, *back]), found


def _press_to(setup: Setup, linear: LinearSolver, past: list[State], share: float, guess: Floats | None = None) -> None:
    """Press to a share of the depth; past is extended. NoEquilibriumError."""
    target = Target(past[-1].time + 1.0, Load((0.0, 0.0), share * setup.full_drive), True)
    failure = reach(setup.system, linear, past, target, True, guess)
    if failure is not None:
        raise NoEquilibriumError(f"a press at {share:.2f} of the depth: {failure}", past[-1].x, None)


def _outputs(setup: Setup, past: Sequence[State]) -> Floats:
    """Force in N, contact area in m2 and charges in C of the last state, (2 + e,)."""
    setup.recorder.record(past[-1], past[-2] if len(past) > 1 else past[-1])
    record = setup.recorder.records.pop()
    return np.array([record.contact_force_N[2], record.contact_area_m2, *record.film_charge_C])
