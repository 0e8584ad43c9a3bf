"""All that was pressed for one rig: the baseline's table, what layers remember, and changes by candidates.

How deep the runs of a recording go.

What may float without counting as physics, through the model: sizes, moduli, d31, and the zero of the drive.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from diagnose.engines.segment import path
from diagnose.engines.segment.answer import FilmPlate
from diagnose.engines.segment.interpolation import Differences, effect_of
from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import Scene
from diagnose.vocabulary.layers.property_error import nuisance as wrong_number
from diagnose.vocabulary.layers.viscoelasticity import LARGEST_SHARE, relaxable
from geometry.arrays import Floats
from geometry.base import Report
from solve.mechanisms import with_mechanisms
from solve.mechanisms.layers.viscoelasticity import VISCOELASTICITY
from solve.model import Model, Physics, Press
from solve.press import press_segment
from solve.problem import with_rims_of_patches
from solve.reduced.fit import CELLS, ResponseTable
from solve.solution.newton import NoEquilibriumError
from solve.tables import job as job_files
from solve.tables.job import Job, Reduction
from solve.tables.rig_mesh import Mesh, MeshSettings, finer_mesh, mesh_of, rig_mesh
from solve.tables.smooth import PRESSED, TRUSTED, Depths, accuracy, change, replaced, smooth
from solve.tables.workers import run_all

LADDER_STEP = 1.05  # noise of the drive is far less than a step, and a table 5 % too deep costs nothing
DEEPER = 1.3  # of the depth that a force reaches: softer candidates go deeper, and layers creep


def deepest(model: Model, tet_mesh: Mesh, recording: Recording) -> float:
    """mm: of the displacements that drive, and where forces drive, of those with some way to go."""
    depths = [float(run.drive_values.max()) for run in recording.runs if run.drive == "displacement_mm"]
    forces = [float(run.drive_values.max()) for run in recording.runs if run.drive == "force_N"]
    if forces:
        depths.append(DEEPER * reached(model, tet_mesh, max(forces)))
    return max(depths)


def rounded_up(value: float) -> float:
    """The next power of LADDER_STEP, so that noise of the drive does not ask for presses anew."""
    return float(LADDER_STEP ** np.ceil(np.log(value) / np.log(LADDER_STEP)))


def reached(model: Model, tet_mesh: Mesh, force_N: float) -> float:
    """Depth in mm under a force. NoEquilibriumError."""
    pushed = replace(model, press=Press(force_N=force_N, load_steps=4), readout=None, physics=_elastic(model.physics))
    name = job_files.key(Job(pushed, tet_mesh, force_N, ()))
    found = job_files.recall(name)
    if found is None:
        found = np.array([_press(pushed, tet_mesh)])
        job_files.keep(name, found)
    return float(found[0])


def _press(model: Model, tet_mesh: Mesh) -> float:
    result = press_segment(ungapped(model), tet_mesh)
    if result.failure is not None:
        raise NoEquilibriumError(f"the baseline under {model.press.force_N:.3g} N: {result.failure}", np.zeros(0), None)
    return 1e3 * float(result.trace.dot_path_m[-1])


def _elastic(physics: Physics) -> Physics:
    """Without what acts in time."""
    return Physics(bonds=physics.bonds, delaminations=physics.delaminations, prestretch=physics.prestretch)


ZERO = "zero-of-the-drive"


def nuisance(scene: Scene, recording: Recording, name: str) -> Candidate | None:
    """The candidate with the one coordinate of a nuisance, None where the model has no such part."""
    if name != "offset_mm":
        return wrong_number(scene, name)
    if not any(run.drive == "displacement_mm" for run in recording.runs):
        return None
    most = offset_reach_mm(recording)
    coordinate = Coordinate("offset_mm", -most, most, (0.1 * most, -0.1 * most))
    return Candidate(ZERO, "dot", (coordinate,), lambda _: {}, units={"offset_mm": "mm"})


def offset_reach_mm(recording: Recording) -> float:
    """Six sigma of the largest error of the first touch that is declared."""
    return 6.0 * max((run.nuisance.get("offset_mm", 0.0) for run in recording.runs), default=0.0)


SHARES = 0.1, 0.25, 0.45, 0.7, 1.0
"""Of the depth, at which changes are seen: they are smooth over it."""
MARGIN = 1.02  # of the depth of the table over the deepest press
FINEST, MIDDLE = 0.4, 0.7
"""Element sizes of the finer meshes, in terms of the diagnosis mesh."""
MOST_NODES = 20_000  # 2 s of one core for each Newton step
CHEAP_NODES = 10_000  # of the middle mesh of a slice, with what stands for it in y
MATTERS = 1e-3  # of force and charge: what a press may differ by from those around it
ROUND_OFF = 1e-12  # of a weight
TOUCH = 1e-6  # of the depth: there is no logarithm of 0
SLIPS = 3  # steps between two of them under friction
Name = tuple[object, ...]
Place = tuple[float, float]
Sizes = tuple[Mesh, MeshSettings]


class Prepared:
    """depth_mm : of the table. pressed_mm : the deepest that the runs go, or a little more.

    relaxing : the layers whose memory is known.

    raw : the baseline's table on the diagnosis mesh; fit : the same with the smoothed answer of a finer mesh.
    accuracy, shortfalls : see diagnose.forward.Engine; shortfalls by name of the press.
    """

    def __init__(self, model: Model, options: MeshSettings, recording: Recording, report: Report) -> None:
        self.model = model
        self.tet_mesh, self.options = rig_mesh(model, options)
        self.pressed_mm = rounded_up(deepest(model, self.tet_mesh, recording))
        self.depth_mm = MARGIN * self.pressed_mm + offset_reach_mm(recording)
        self.depths = Depths(SHARES)
        self._changes: dict[Name, Floats] = {}
        self._differences: dict[Name, Differences] = {}
        self.shortfalls: dict[Name, str] = {}
        finest = finer_mesh(model, self.options, FINEST, MOST_NODES)
        meshes = finest, self._middle_mesh
        jobs = [replace(self.job(model, mesh), shares=PRESSED) for mesh in meshes]
        reduction, outputs = self._reduced([*jobs, *self._bases], report)
        fine, middle = (smooth(PRESSED, found) for found in outputs[: len(jobs)])
        self._smooth = fine.at(np.linspace(TOUCH, 1.0, CELLS + 1))
        made = reduction.made()
        self.relaxing, self.raw = reduction.relaxing, made.fit
        self.film = FilmPlate(made.film, made.pyroelectric_uC_per_m2_K)
        self.fit: ResponseTable = replaced(self.raw, self._smooth)
        fine_mm, middle_mm = (options.element_size_mm for _, options in meshes)
        self.accuracy = accuracy(middle, fine, fine_mm / middle_mm)

    def _reduced(self, jobs: Sequence[Job], report: Report) -> tuple[Reduction, list[Floats]]:
        """The reduction, with as many layers as have an equilibrium with all they may remember, and outputs of jobs.

        NoEquilibriumError where the baseline has none, or a layer that relaxes by rig.toml.
        """
        declared = self.model.physics.viscosity
        layers = sorted(relaxable(self.model), key=lambda layer: layer not in declared)
        while True:
            reduction = Reduction(self._bases[0].model, self.tet_mesh, self.depth_mm, tuple(layers), LARGEST_SHARE)
            try:
                outputs = run_all(jobs, report, [reduction])
            except NoEquilibriumError:
                if len(layers) <= len(declared):
                    raise
            else:
                return reduction, _all_there(outputs)
            told = f"No equilibrium with the full memory of {', '.join(layers)}"
            dropped = layers.pop()
            left_out = f"{VISCOELASTICITY.name} of {dropped} is left out of the candidates"
            self.shortfalls[VISCOELASTICITY.name, dropped] = f"{told}: {left_out}."

    @property
    def nothing(self) -> Floats:
        """No change, (n, 2 + e)."""
        return np.zeros((len(SHARES), 2 + len(self.film.electrodes)))

    @cached_property
    def _bases(self) -> tuple[Job, Job]:
        """The baseline on the diagnosis mesh and on the middle one: what changes are compared with and start from."""
        coarse, middle = self.job(self.model), self.job(self.model, self._middle_mesh)
        return replace(coarse, guides=True, parts=SLIPS), replace(middle, guides=True)

    @cached_property
    def _guides(self) -> list[str]:
        """Names of the bases in solve.tables.job."""
        return [job_files.key(job) for job in self._bases]

    @cached_property
    def _middle_mesh(self) -> Sizes:
        """See Traits.on_middle_mesh; a dot elsewhere is pressed on it too."""
        return finer_mesh(self.model, self.options, MIDDLE, MOST_NODES)

    @property
    def _all_finer(self) -> bool:
        """Whether a press on the middle mesh takes hardly longer, as that of a slice."""
        return len(self._middle_mesh[0].points_mm) <= CHEAP_NODES

    def add(self, candidates: Sequence[Candidate], places: Sequence[Place], report: Report) -> None:
        """Press what these candidates, and dots at these places, need beyond what was pressed. NoEquilibriumError."""
        wanted = {name: job for c in candidates for name, job in self._jobs(c) if name not in self._changes}
        moved = {_at(place): self.moved(place) for place in places if any(place) and _at(place) not in self._changes}
        wanted |= {name: (self.job(model, self._middle_mesh), 1) for name, model in moved.items()}
        self._changes |= self._pressed(wanted, report)
        for candidate in candidates:
            self._bridge(candidate)

    def refine(self, settings: Sequence[Setting], report: Report) -> bool:
        """Press settings alone where they are not known yet; whether one differs by more than MATTERS.

        A press that has no equilibrium, and one on a mesh that takes long, tells nothing. NoEquilibriumError.
        """
        asked = {press_name(s.candidate, s.values): s for s in settings if self._may_differ(s)}
        wanted = {name: self._job(s.candidate, s.values) for name, s in asked.items()}
        quick = {name: job for name, job in wanted.items() if len(job[0].tet_mesh.points_mm) <= CHEAP_NODES}
        largest = 0.0
        for name, found in self._pressed(quick, report).items():
            setting = asked[name]
            difference = found - self._between(setting)
            self._differences[_coordinates(setting.candidate)].add(setting.values, difference)
            largest = max(largest, self._size(difference))
        return largest > MATTERS

    def _may_differ(self, setting: Setting) -> bool:
        """Whether a press at these values would tell something new."""
        candidate = setting.candidate
        if not any(setting.values[n] for n in effect_of(candidate).pressed):
            return False
        differences = self._differences.setdefault(_coordinates(candidate), Differences(candidate))
        return not differences.known(setting.values)

    def _size(self, change: Floats) -> float:
        """The larger of the changes of force and of charge, relative to those at the deepest press."""
        force, _, *charges = self._smooth[-1]
        per_force = max(float(np.abs(charges).max()) / float(force), 1e-300)
        return max(float(np.abs(change[:, 0]).max()), float(np.abs(change[:, 2:]).max()) / per_force)

    def _pressed(self, wanted: Mapping[Name, tuple[Job, int]], report: Report) -> dict[Name, Floats]:
        """Changes by jobs, each with the number of its mesh; those without equilibrium are left out."""
        if not wanted:
            return {}
        bases = _all_there(run_all(self._bases, report))
        beside = {name: self._without_patch(job) for name, (job, _) in wanted.items()}
        others = {name: (job, wanted[name][1]) for name, job in beside.items() if job is not None}
        outputs = run_all([self._guided(*one) for one in (*wanted.values(), *others.values())], report)
        compared = dict(zip(others, outputs[len(wanted) :], strict=True))
        changes = {}
        for (name, (job, base)), found in zip(wanted.items(), outputs, strict=False):
            reference = compared.get(name, bases[base])
            if len(found) and len(reference):
                changes[name] = self._change(job, reference, found)
        return changes

    def _guided(self, job: Job, base: int) -> Job:
        """Starting from the baseline's equilibria, except where a moved dot touches other nodes."""
        moved = job.model.dot != self._bases[base].model.dot
        return job if moved else replace(job, guided_by=self._guides[base])

    def _without_patch(self, job: Job) -> Job | None:
        """The baseline on the mesh that a patch changes, so that only the patch is in the difference; None for none."""
        patches, known = job.model.physics.delaminations, self.model.physics.delaminations
        if patches == known or job.model.segment.section == "solid":
            return None
        moved = with_rims_of_patches(job.tet_mesh, job.model.segment, patches)
        return replace(self.job(self.model), tet_mesh=moved)

    def _change(self, job: Job, base: Floats, found: Floats) -> Floats:
        """Against the baseline on the same mesh; charges scaled to those of the finest mesh."""
        values = path.changes(found, base, SHARES, self.raw) if job.back else change(base, found)
        force, _, *charges = self._smooth[-1]
        per_force = (np.array(charges) / force) / (base[-1, 2:] / base[-1, 0])
        values[:, 2:] *= np.clip(np.nan_to_num(per_force, nan=1.0), *TRUSTED)
        return values

    def _bridge(self, candidate: Candidate) -> None:
        """Where the 3D model found no equilibrium, take the nearest press of this candidate that has one.

        Without any the candidate stays unprepared.
        """
        points = effect_of(candidate).points
        known = [point for point in points if press_name(candidate, point) in self._changes]
        for point in points:
            if point in known:
                continue
            name, instead = press_name(candidate, point), "it is left out of the candidates"
            if known:
                nearest = min(known, key=lambda other: float(np.linalg.norm(np.subtract(other, point))))
                self._changes[name] = self._changes[press_name(candidate, nearest)]
                instead = f"its press at {_values(candidate, nearest)} is used instead"
            what = f"{candidate.mechanism} ({candidate.component})"
            self.shortfalls[name] = f"No equilibrium with {what} at {_values(candidate, point)}: {instead}."

    def moved(self, place: Place) -> Model:
        """The model with the dot at a place, from where it stands."""
        return moved(self.model, place)

    def _jobs(self, candidate: Candidate) -> Iterator[tuple[Name, tuple[Job, int]]]:
        """Presses by name."""
        for point in effect_of(candidate).points:
            yield press_name(candidate, point), self._job(candidate, point)

    def _job(self, candidate: Candidate, point: Sequence[float]) -> tuple[Job, int]:
        """A press, and the number of its mesh: 0 for the diagnosis mesh, 1 for the middle one."""
        back = path.BACK if candidate.traits.shows_on_return else ()
        finer = candidate.traits.on_middle_mesh or (self._all_finer and not back)
        changed = with_mechanisms(self.model, [candidate.switched_on(point)])
        job = self.job(changed, self._middle_mesh if finer else None)
        parts = SLIPS if job.model.physics.friction > 0.0 else 1
        return replace(job, back=back, parts=parts), int(finer)

    def job(self, model: Model, mesh: Sizes | None = None) -> Job:
        """The press of a changed model on a mesh, moved with its layers, at once: nothing relaxes."""
        on = model.physics
        own = replace(structural(on), friction=on.friction, softening=on.softening, film_yield=on.film_yield)
        tet_mesh = mesh_of(model, self.model, *(mesh or (self.tet_mesh, self.options)))
        return Job(replace(ungapped(model), physics=own, readout=None), tet_mesh, self.depth_mm, SHARES)

    def change(self, place: Place, settings: Sequence[Setting]) -> Floats | None:
        """The sum (n, 2 + e) of what elastic settings and the dot's place change; None for nothing. ValueError."""
        parts = [] if not any(place) else [self._known(_at(place), f"a dot at {place} mm")]
        elastic = [setting for setting in settings if not setting.candidate.traits.shows_on_return]
        parts += [values for values in map(self._values, elastic) if values is not None]
        return np.sum(parts, axis=0) if parts else None

    def histories(self, settings: Sequence[Setting]) -> list[path.PathHistory]:
        """Of the settings that depend on the path. ValueError."""
        found = []
        for setting in settings:
            if setting.candidate.traits.shows_on_return:
                values = self._values(setting)
                found += [path.PathHistory(values, SHARES)] if values is not None else []
        return found

    def _values(self, setting: Setting) -> Floats | None:
        """Changes (n, 2 + e), or of a path (n + b r, 2 + e); None where the setting needs no press."""
        if not any(setting.values[n] for n in effect_of(setting.candidate).pressed):
            return None
        return self._between(setting)

    def _between(self, setting: Setting) -> Floats:
        """The same from the presses, and what those beyond the first differ by."""
        candidate, effect = setting.candidate, effect_of(setting.candidate)
        what = f"{candidate.mechanism} of {candidate.component}"
        weighed = zip(effect.weights(setting.values), effect.points, strict=True)
        parts = [w * self._known(press_name(candidate, p), what) for w, p in weighed if abs(w) > ROUND_OFF]
        more = self._differences.get(_coordinates(candidate))
        return np.asarray(np.sum(parts, axis=0) + (more.at(setting.values) if more is not None else 0.0))

    def _known(self, name: Name, what: str) -> Floats:
        if name not in self._changes:
            raise ValueError(f"{what} was not prepared")
        return self._changes[name]


def moved(model: Model, place: Place) -> Model:
    """A model with the dot at a place, from where it stands."""
    x, y = model.dot.offset_mm
    return replace(model, dot=model.dot.model_copy(update={"offset_mm": (x + place[0], y + place[1])}))


def _all_there(outputs: list[Floats]) -> list[Floats]:
    """The baseline's. NoEquilibriumError where it has none."""
    if not all(map(len, outputs)):
        raise NoEquilibriumError("the baseline has no equilibrium at the depth of these runs", np.zeros(0), None)
    return outputs


def press_name(candidate: Candidate, point: Sequence[float]) -> Name:
    """Name of a press, one for a nuisance and for the candidate that has it among others."""
    on = tuple((c.name, value) for c, value in zip(candidate.coordinates, point, strict=True) if value != 0.0)
    return (*candidate.name, on)


def _coordinates(candidate: Candidate) -> Name:
    """A candidate and a nuisance that is one of its coordinates are two."""
    return (*candidate.name, *(coordinate.name for coordinate in candidate.coordinates))


def _values(candidate: Candidate, point: Sequence[float]) -> str:
    """Parameters at a press, for a reader."""
    parameters = candidate.parameters(point)
    return ", ".join(f"{k} = {v:.3g}" if isinstance(v, float) else f"{k} = {v}" for k, v in parameters.items())


def _at(place: Place) -> Name:
    return ("place", *place)


def ungapped(model: Model) -> Model:
    """The dot at its first touch."""
    return replace(model, dot=model.dot.model_copy(update={"gap_mm": 0.0}))


def structural(physics: Physics) -> Physics:
    """What of the physics is in an elastic press."""
    return Physics(bonds=physics.bonds, delaminations=physics.delaminations, prestretch=physics.prestretch)
