"""Presses of the 3D model of one rig: its baseline on the diagnosis mesh and on a finer one, changed models on both."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from diagnose.engines.segment.path_history import BACK
from diagnose.forward import Candidate
from foundation.arrays import Floats
from foundation.executor import Executor
from foundation.progress import Report
from solve.delaminations import with_rims_of_patches
from solve.mechanisms import with_mechanisms
from solve.model import Model
from solve.physics import nonlinear_laws
from solve.solution.errors import NoEquilibriumError
from solve.tables import cache
from solve.tables.depth_press import DepthPress
from solve.tables.rig_mesh import Mesh, MeshSettings, finer_mesh, mesh_of
from solve.tables.workers import run_all

SHARES = 0.1, 0.25, 0.45, 0.7, 1.0
"""Of the depth, at which changes are seen: they are smooth over it."""
MIDDLE = 0.7
"""Element sizes of the finer mesh, in terms of the diagnosis mesh."""
MOST_NODES = 20_000  # 2 s of one core for each Newton step
CHEAP_NODES = 10_000  # of the finer mesh of a slice, with what stands for it in y
SLIPS = 3  # steps between two of them under friction
Name = tuple[object, ...]
Place = tuple[float, float]
Sizes = tuple[Mesh, MeshSettings]


@dataclass(frozen=True)
class Presses:
    """tet_mesh, options : of the diagnosis mesh. depth_mm : to which every model is pressed."""

    model: Model
    tet_mesh: Mesh
    options: MeshSettings
    depth_mm: float

    @cached_property
    def bases(self) -> tuple[DepthPress, DepthPress]:
        """The baseline on the diagnosis mesh and on the middle one: what changes are compared with and start from."""
        coarse, middle = self.job(self.model), self.job(self.model, self.middle_mesh)
        return replace(coarse, guides=True, parts=SLIPS), replace(middle, guides=True)

    @cached_property
    def _guides(self) -> list[str]:
        """Names of the bases in solve.tables.cache."""
        return [cache.key(job) for job in self.bases]

    @cached_property
    def middle_mesh(self) -> Sizes:
        """See Traits.on_middle_mesh; a dot elsewhere is pressed on it too."""
        return finer_mesh(self.model, self.options, MIDDLE, MOST_NODES)

    @property
    def all_finer(self) -> bool:
        """Whether a press on the middle mesh takes hardly longer, as that of a slice."""
        return len(self.middle_mesh[0].points_mm) <= CHEAP_NODES

    def job(self, model: Model, mesh: Sizes | None = None) -> DepthPress:
        """The press of a changed model on a mesh, moved with its layers, at once: nothing relaxes."""
        on = model.physics
        of_segment = tuple(term for term in on.terms if not term.of_rig)
        own = replace(on.structure, terms=of_segment, inelastic=nonlinear_laws(on.inelastic))
        tet_mesh = mesh_of(model, self.model, *(mesh or (self.tet_mesh, self.options)), MOST_NODES)
        return DepthPress(replace(ungapped(model), physics=own, readout=None), tet_mesh, self.depth_mm, SHARES)

    def with_candidate(self, candidate: Candidate, point: Sequence[float]) -> tuple[DepthPress, int]:
        """A press, and the number of its mesh: 0 for the diagnosis mesh, 1 for the middle one."""
        back = BACK if candidate.traits.shows_on_return else ()
        finer = candidate.traits.on_middle_mesh or (self.all_finer and not back)
        changed = with_mechanisms(self.model, [candidate.as_mechanism(point)])
        job = self.job(changed, self.middle_mesh if finer else None)
        parts = SLIPS if any(term.follows_time for term in job.model.physics.terms) else 1
        return replace(job, back=back, parts=parts), int(finer)

    def compared(
        self, wanted: Mapping[Name, tuple[DepthPress, int]], report: Report, executor: Executor
    ) -> dict[Name, tuple[DepthPress, Floats, Floats]]:
        """By name the job, outputs (n, 2 + e) of the baseline on the same mesh, and its own; none without equilibrium.

        wanted : jobs, each with the number of its mesh. NoEquilibriumError where the baseline has none.
        """
        if not wanted:
            return {}
        bases = all_there(run_all(self.bases, report, executor=executor))
        beside = {name: (self._without_patch(job), mesh) for name, (job, mesh) in wanted.items()}
        others = {name: (job, mesh) for name, (job, mesh) in beside.items() if job is not None}
        jobs = [self._guided(*one) for one in (*wanted.values(), *others.values())]
        outputs = run_all(jobs, report, executor=executor)
        own = dict(zip(others, outputs[len(wanted) :], strict=True))
        found = {
            name: (job, own.get(name, bases[base]), seen)
            for (name, (job, base)), seen in zip(wanted.items(), outputs, strict=False)
        }
        return {name: three for name, three in found.items() if len(three[1]) and len(three[2])}

    def _guided(self, job: DepthPress, base: int) -> DepthPress:
        """Starting from the baseline's equilibria, except where a moved dot touches other nodes."""
        moved = job.model.dot != self.bases[base].model.dot
        return job if moved else replace(job, guided_by=self._guides[base])

    def _without_patch(self, job: DepthPress) -> DepthPress | None:
        """The baseline on the mesh that a patch changes, so that only the patch is in the difference; None for none."""
        patches, known = job.model.physics.delaminations, self.model.physics.delaminations
        if patches == known or job.model.segment.section == "solid":
            return None
        moved = with_rims_of_patches(job.tet_mesh, job.model.segment, patches)
        return replace(self.job(self.model), tet_mesh=moved)


def moved(model: Model, place: Place) -> Model:
    """A model with the dot at a place, from where it stands."""
    x, y = model.dot.offset_mm
    return replace(model, dot=model.dot.model_copy(update={"offset_mm": (x + place[0], y + place[1])}))


def all_there(outputs: list[Floats]) -> list[Floats]:
    """The baseline's. NoEquilibriumError where it has none."""
    if not all(map(len, outputs)):
        raise NoEquilibriumError("the baseline has no equilibrium at the depth of these runs", np.zeros(0), None)
    return outputs


def ungapped(model: Model) -> Model:
    """The dot at its first touch."""
    return replace(model, dot=model.dot.model_copy(update={"gap_mm": 0.0}))
