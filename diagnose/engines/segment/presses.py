"""Presses of the 3D model of one rig: its baseline on the diagnosis mesh and on a finer one, changed models on both."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from diagnose.engines.segment.path_history import TURNING_NUMBERS
from diagnose.engines.segment.rough_presses import rough_job
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

DEPTH_SHARES = 0.1, 0.25, 0.45, 0.7, 1.0
"""Shares of the depth at which changes are read: they are smooth over it."""
MIDDLE_ELEMENT_RATIO = 0.7
"""Element sizes of the middle mesh over those of the diagnosis mesh."""
MOST_NODES = 20_000  # of a mesh: 2 s of one core for each Newton step
CHEAP_NODES = 10_000  # of the middle mesh of a slice, with its copies along y
FRICTION_SUBSTEPS = 3  # between two of the depths, where there is friction
Name = tuple[object, ...]
Place = tuple[float, float]
Sizes = tuple[Mesh, MeshSettings]


@dataclass(frozen=True)
class Presses:
    """Jobs that press the 3D model of one rig. tet_mesh, options : of the diagnosis mesh. depth_mm : of every press."""

    model: Model
    tet_mesh: Mesh
    options: MeshSettings
    depth_mm: float

    @cached_property
    def baseline_jobs(self) -> tuple[DepthPress, DepthPress]:
        """Jobs of the baseline on the diagnosis mesh and on the middle one.

        Changed models are compared with them and start from their equilibria.
        """
        coarse, middle = self.press_job(self.model), self.press_job(self.model, self.middle_mesh)
        return replace(coarse, guides=True, parts=FRICTION_SUBSTEPS), replace(middle, guides=True)

    @cached_property
    def _guides(self) -> list[str]:
        """Names of the baseline's jobs in solve.tables.cache."""
        return [cache.key(job) for job in self.baseline_jobs]

    @cached_property
    def middle_mesh(self) -> Sizes:
        """The middle mesh, see Traits.on_middle_mesh; a dot elsewhere is pressed on it too."""
        return finer_mesh(self.model, self.options, MIDDLE_ELEMENT_RATIO, MOST_NODES)

    @property
    def is_middle_mesh_cheap(self) -> bool:
        """Whether a press on the middle mesh takes hardly longer, as that of a slice."""
        return len(self.middle_mesh[0].points_mm) <= CHEAP_NODES

    def press_job(self, model: Model, mesh: Sizes | None = None) -> DepthPress:
        """Job that presses a changed model on a mesh, moved with its layers, at once: nothing relaxes."""
        on = model.physics
        of_segment = tuple(term for term in on.terms if not term.of_rig)
        own = replace(on.structure, terms=of_segment, inelastic=nonlinear_laws(on.inelastic))
        tet_mesh = mesh_of(model, self.model, *(mesh or (self.tet_mesh, self.options)), MOST_NODES)
        return DepthPress(replace(without_gap(model), physics=own, readout=None), tet_mesh, self.depth_mm, DEPTH_SHARES)

    def candidate_job(
        self, candidate: Candidate, point: Sequence[float], roughly: bool = False
    ) -> tuple[DepthPress, int]:
        """Job that presses a candidate at a point (q,), and the number of its mesh.

        It is 0 for the diagnosis mesh, 1 for the middle one. roughly : as diagnose.engines.segment.rough_presses.
        """
        back = TURNING_NUMBERS if candidate.traits.shows_on_return else ()
        finer = not roughly and (candidate.traits.on_middle_mesh or (self.is_middle_mesh_cheap and not back))
        changed = with_mechanisms(self.model, [candidate.as_mechanism(point)])
        job = self.press_job(changed, self.middle_mesh if finer else None)
        parts = FRICTION_SUBSTEPS if any(term.follows_time for term in job.model.physics.terms) else 1
        whole = replace(job, back=back, parts=parts)
        return rough_job(whole) if roughly else whole, int(finer)

    def run_with_baselines(
        self, wanted: Mapping[Name, tuple[DepthPress, int]], report: Report, executor: Executor
    ) -> dict[Name, tuple[DepthPress, Floats, Floats]]:
        """Run jobs: by name the job, outputs (n, 2 + e) of the baseline on the same mesh, and its own.

        wanted : jobs, each with the number of its mesh; those without equilibrium are left out. NoEquilibriumError
        where the baseline has none.
        """
        if not wanted:
            return {}
        bases = require_equilibria(run_all(self.baseline_jobs, report, executor=executor))
        beside = {name: (self._job_without_patch(job), mesh) for name, (job, mesh) in wanted.items()}
        others = {name: (job, mesh) for name, (job, mesh) in beside.items() if job is not None}
        jobs = [self._guided_job(*one) for one in (*wanted.values(), *others.values())]
        outputs = run_all(jobs, report, executor=executor)
        own = dict(zip(others, outputs[len(wanted) :], strict=True))
        found = {
            name: (job, own.get(name, self._seen_as(job, bases[base])), seen)
            for (name, (job, base)), seen in zip(wanted.items(), outputs, strict=False)
        }
        return {name: three for name, three in found.items() if len(three[1]) and len(three[2])}

    def _guided_job(self, job: DepthPress, base: int) -> DepthPress:
        """Job that starts from the baseline's equilibria, except where a moved dot touches other nodes."""
        moved = job.model.dot != self.baseline_jobs[base].model.dot
        return job if moved else replace(job, guided_by=self._guides[base])

    def _job_without_patch(self, job: DepthPress) -> DepthPress | None:
        """Job of the baseline on the mesh that a patch changes, so that only the patch is in the difference.

        None where there is no patch.
        """
        patches, known = job.model.physics.delaminations, self.model.physics.delaminations
        if patches == known or job.model.segment.section == "solid":
            return None
        moved = with_rims_of_patches(job.tet_mesh, job.model.segment, patches)
        return replace(self.press_job(self.model), tet_mesh=moved, shares=job.shares)

    @staticmethod
    def _seen_as(job: DepthPress, base: Floats) -> Floats:
        """Outputs of the baseline at the shares of a job."""
        return base[[DEPTH_SHARES.index(share) for share in job.shares]]


def with_dot_moved(model: Model, place: Place) -> Model:
    """Model with the dot moved by a place in mm from where it stands."""
    x, y = model.dot.offset_mm
    return replace(model, dot=model.dot.model_copy(update={"offset_mm": (x + place[0], y + place[1])}))


def require_equilibria(outputs: list[Floats]) -> list[Floats]:
    """Outputs of the baseline's jobs. NoEquilibriumError where one has none."""
    if not all(map(len, outputs)):
        raise NoEquilibriumError("the baseline has no equilibrium at the depth of these runs", np.zeros(0), None)
    return outputs


def without_gap(model: Model) -> Model:
    """Model with the dot at its first touch."""
    return replace(model, dot=model.dot.model_copy(update={"gap_mm": 0.0}))
