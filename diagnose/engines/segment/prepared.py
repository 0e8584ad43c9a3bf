"""Presses of one rig and what was learnt: the baseline's table, what layers remember, changes by candidates."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from diagnose.engines.segment import path_history as path
from diagnose.engines.segment.depth import deepest_mm, offset_reach_mm, round_up_depth
from diagnose.engines.segment.interpolation import Differences, PressedEffect, candidate_effect
from diagnose.engines.segment.presses import (
    CHEAP_NODES,
    DEPTH_SHARES,
    MOST_NODES,
    Name,
    Place,
    Presses,
    require_equilibria,
    with_dot_moved,
)
from diagnose.engines.segment.response import FilmPlate
from diagnose.engines.segment.rough_presses import at_all_places, rough_effect
from diagnose.forward import Candidate, Setting
from diagnose.signals.recording import Recording
from diagnose.vocabulary.layers.viscoelasticity import LARGEST_SHARE, relaxable
from foundation.arrays import Floats
from foundation.executor import HERE, Executor
from foundation.progress import Report
from solve.mechanisms.layers.viscoelasticity import VISCOELASTICITY
from solve.model import Model
from solve.physics import linear_laws
from solve.reduced.fit import CELLS, ResponseTable
from solve.solution.errors import NoEquilibriumError
from solve.tables.depth_press import DepthPress
from solve.tables.reduction import Reduction
from solve.tables.rig_mesh import MeshSettings, finer_mesh, rig_mesh
from solve.tables.smoothing import PRESSED, smooth
from solve.tables.table_accuracy import accuracy
from solve.tables.table_changes import TRUSTED, Depths, change, with_elastic_outputs
from solve.tables.workers import run_all

TABLE_DEPTH_RATIO = 1.02  # depth of the table over that of the deepest run
FINEST_ELEMENT_RATIO = 0.4  # element sizes of the finest mesh over those of the diagnosis mesh
RELEVANT_CHANGE = 1e-3  # of force and charge: what a press may differ by from those around it
NEGLIGIBLE_WEIGHT = 1e-12  # of a press: round-off
TOUCH_DEPTH_SHARE = 1e-6  # of the depth: there is no logarithm of 0


class Prepared:
    """Presses of one rig: the baseline's table, what layers remember, and changes by candidates.

    depth_mm : of the table. pressed_mm : depth of the deepest run, or a little more. relaxing : the layers whose memory
    is known. raw : the baseline's table on the diagnosis mesh; fit : the same with the smoothed answer of a finer mesh.
    executor : does all presses, now and later. accuracy, shortfalls : see diagnose.forward.Engine; shortfalls by name
    of the press.
    """

    def __init__(
        self, model: Model, options: MeshSettings, recording: Recording, report: Report, executor: Executor = HERE
    ) -> None:
        self.model, self._executor = model, executor
        tet_mesh, options = rig_mesh(model, options)
        self.pressed_mm = round_up_depth(deepest_mm(model, tet_mesh, recording))
        self.depth_mm = TABLE_DEPTH_RATIO * self.pressed_mm + offset_reach_mm(recording)
        self.presses = Presses(model, tet_mesh, options, self.depth_mm)
        self.depths = Depths(DEPTH_SHARES)
        self._changes: dict[Name, Floats] = {}
        self._rough_changes: dict[Name, Floats] = {}
        self._differences: dict[Name, Differences] = {}
        self.shortfalls: dict[Name, str] = {}
        finest = finer_mesh(model, options, FINEST_ELEMENT_RATIO, MOST_NODES)
        meshes = finest, self.presses.middle_mesh
        jobs = [replace(self.presses.press_job(model, mesh), shares=PRESSED) for mesh in meshes]
        reduction, outputs = self._reduce([*jobs, *self.presses.baseline_jobs], report)
        fine, middle = (smooth(PRESSED, found) for found in outputs[: len(jobs)])
        self._smooth = fine.at(np.linspace(TOUCH_DEPTH_SHARE, 1.0, CELLS + 1))
        made = reduction.build_model()
        self.relaxing, self.raw = reduction.relaxing, made.fit
        self.film = FilmPlate(made.film, made.pyroelectric_uC_per_m2_K)
        self.fit: ResponseTable = with_elastic_outputs(self.raw, self._smooth)
        fine_mm, middle_mm = (options.element_size_mm for _, options in meshes)
        self.accuracy = accuracy(middle, fine, fine_mm / middle_mm)

    def _reduce(self, jobs: Sequence[DepthPress], report: Report) -> tuple[Reduction, list[Floats]]:
        """Reduction of the baseline, and outputs of jobs.

        It has as many layers as have an equilibrium with all they may remember. NoEquilibriumError where the baseline
        has none, or a layer that relaxes by rig.toml.
        """
        declared = linear_laws(self.model.physics.inelastic)
        layers = sorted(relaxable(self.model), key=lambda layer: layer not in declared)
        while True:
            reduction = Reduction(
                self.presses.baseline_jobs[0].model, self.presses.tet_mesh, self.depth_mm, tuple(layers), LARGEST_SHARE
            )
            try:
                outputs = run_all(jobs, report, [reduction], self._executor)
            except NoEquilibriumError:
                if len(layers) <= len(declared):
                    raise
            else:
                return reduction, require_equilibria(outputs)
            told = f"No equilibrium with the full memory of {', '.join(layers)}"
            dropped = layers.pop()
            left_out = f"{VISCOELASTICITY.name} of {dropped} is left out of the candidates"
            self.shortfalls[VISCOELASTICITY.name, dropped] = f"{told}: {left_out}."

    @property
    def no_change(self) -> Floats:
        """Changes (n, 2 + e) of 0."""
        return np.zeros((len(DEPTH_SHARES), 2 + len(self.film.electrodes)))

    def add(self, candidates: Sequence[Candidate], places: Sequence[Place], report: Report) -> None:
        """Press what these candidates, and dots at these places, need beyond what was pressed. NoEquilibriumError."""
        wanted = {name: job for c in candidates for name, job in self._named_jobs(c) if name not in self._changes}
        elsewhere = [place for place in places if any(place) and _place_name(place) not in self._changes]
        on, mesh = self.presses, self.presses.middle_mesh
        wanted |= {
            _place_name(place): (on.press_job(with_dot_moved(self.model, place), mesh), 1) for place in elsewhere
        }
        self._changes |= self._press_changes(wanted, report)
        for candidate in candidates:
            self._replace_failed_presses(candidate)

    def add_roughly(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Few and coarse presses of candidates; all of them where a rough one fails. NoEquilibriumError."""
        points = {press_name(one, point): (one, point) for one in candidates for point in rough_effect(one).points}
        known = self._changes.keys() | self._rough_changes.keys()
        unknown = {name: one for name, one in points.items() if name not in known}
        jobs = {name: self.presses.candidate_job(*one, roughly=True) for name, one in unknown.items()}
        self._rough_changes |= self._press_changes(jobs, report)
        failed = [one for name, (one, _) in unknown.items() if name not in self._rough_changes]
        self.add(list(dict.fromkeys(failed)), (), report)

    def refine(self, settings: Sequence[Setting], report: Report) -> list[Setting]:
        """Press settings alone where they are not pressed yet; returns those that differ by more than RELEVANT_CHANGE.

        A press that has no equilibrium, and one on a mesh that takes long, tells nothing. NoEquilibriumError.
        """
        asked = {press_name(s.candidate, s.values): s for s in map(_pressed_part, settings) if self._may_differ(s)}
        wanted = {name: self.presses.candidate_job(s.candidate, s.values) for name, s in asked.items()}
        quick = {name: job for name, job in wanted.items() if len(job[0].tet_mesh.points_mm) <= CHEAP_NODES}
        differing = []
        for name, found in self._press_changes(quick, report).items():
            setting = asked[name]
            told = self._interpolate_change(setting)
            difference = found if told is None else found - told
            self._differences[_coordinates_name(setting.candidate)].add(setting.values, difference)
            differing += [setting] if self._change_size(difference) > RELEVANT_CHANGE else []
        return [setting for setting in settings if _pressed_part(setting) in differing]

    def _may_differ(self, setting: Setting) -> bool:
        """Whether a press at these values may differ from what those before say of it."""
        candidate = setting.candidate
        if not any(setting.values):
            return False
        differences = self._differences.setdefault(_coordinates_name(candidate), Differences(candidate))
        return not differences.is_pressed_at(setting.values)

    def _change_size(self, change: Floats) -> float:
        """Size of a change: the larger of those of force and of charge, relative to both at the deepest press."""
        force, _, *charges = self._smooth[-1]
        per_force = max(float(np.abs(charges).max()) / float(force), 1e-300)
        return max(float(np.abs(change[:, 0]).max()), float(np.abs(change[:, 2:]).max()) / per_force)

    def _press_changes(self, wanted: Mapping[Name, tuple[DepthPress, int]], report: Report) -> dict[Name, Floats]:
        """Changes by name of jobs, each with the number of its mesh; those without equilibrium are left out."""
        return {
            name: self._change_of_press(*three)
            for name, three in self.presses.run_with_baselines(wanted, report, self._executor).items()
        }

    def _change_of_press(self, job: DepthPress, base: Floats, found: Floats) -> Floats:
        """Change of a press against the baseline on the same mesh; charges scaled to those of the finest mesh."""
        along = job.shares, job.back, job.returns, self.raw
        values = path.path_changes(found, base, *along) if job.back else change(base, found)
        force, _, *charges = self._smooth[-1]
        per_force = (np.array(charges) / force) / (base[-1, 2:] / base[-1, 0])
        values[:, 2:] *= np.clip(np.nan_to_num(per_force, nan=1.0), *TRUSTED)
        return values if job.shares == DEPTH_SHARES else at_all_places(values, DEPTH_SHARES)

    def _replace_failed_presses(self, candidate: Candidate) -> None:
        """Take the nearest press of this candidate where the 3D model found no equilibrium.

        Without any the candidate stays unprepared.
        """
        points = candidate_effect(candidate).points
        known = [point for point in points if press_name(candidate, point) in self._changes]
        for point in points:
            if point in known:
                continue
            name, instead = press_name(candidate, point), "it is left out of the candidates"
            if known:
                nearest = min(known, key=lambda other: float(np.linalg.norm(np.subtract(other, point))))
                self._changes[name] = self._changes[press_name(candidate, nearest)]
                instead = f"its press at {_parameter_words(candidate, nearest)} is used instead"
            what = f"{candidate.mechanism} ({candidate.component})"
            self.shortfalls[name] = f"No equilibrium with {what} at {_parameter_words(candidate, point)}: {instead}."

    def _named_jobs(self, candidate: Candidate) -> Iterator[tuple[Name, tuple[DepthPress, int]]]:
        """Names of a candidate's presses, each with its job and the number of its mesh."""
        for point in candidate_effect(candidate).points:
            yield press_name(candidate, point), self.presses.candidate_job(candidate, point)

    def table_change(self, place: Place, settings: Sequence[Setting]) -> Floats | None:
        """Change (n, 2 + e) of the table by elastic settings and the dot's place; None for no change. ValueError."""
        parts = [] if not any(place) else [self._pressed_change(_place_name(place), f"a dot at {place} mm")]
        parts += [
            values for values in map(self._interpolate_change, self.elastic_settings(settings)) if values is not None
        ]
        return np.sum(parts, axis=0) if parts else None

    def elastic_settings(self, settings: Sequence[Setting]) -> list[Setting]:
        """Settings that change the table: they need presses and do not depend on the path."""
        return [one for one in settings if not one.candidate.traits.shows_on_return and _needs_press(one)]

    def path_dependent_settings(self, settings: Sequence[Setting]) -> list[Setting]:
        """Settings that need presses and depend on the path."""
        return [one for one in settings if one.candidate.traits.shows_on_return and _needs_press(one)]

    def path_histories(self, settings: Sequence[Setting]) -> list[path.PathHistory]:
        """Histories of the settings that depend on the path. ValueError for one that was not prepared."""
        each = map(self._interpolate_change, self.path_dependent_settings(settings))
        return [path.PathHistory(values, DEPTH_SHARES) for values in each if values is not None]

    def _interpolate_change(self, setting: Setting) -> Floats | None:
        """Changes (n, 2 + e) by a setting, or of a path (n + b r, 2 + e); None where it is as good as off.

        They come from the first presses, and from what those beyond differ by.
        """
        candidate = setting.candidate
        weighed = _weighed_presses(candidate_effect(candidate), setting)
        if not weighed.keys() <= self._changes.keys():
            weighed = _weighed_presses(rough_effect(candidate), setting)
        what = f"{candidate.mechanism} of {candidate.component}"
        parts = [weight * self._pressed_change(name, what) for name, weight in weighed.items()]
        more = self._differences.get(_coordinates_name(candidate))
        beyond = more.difference_at(setting.values) if more is not None else None
        parts += [beyond] if beyond is not None else []
        return np.sum(parts, axis=0) if parts else None

    def _pressed_change(self, name: Name, what: str) -> Floats:
        found = self._changes.get(name, self._rough_changes.get(name))
        if found is None:
            raise ValueError(f"{what} was not prepared")
        return found


def _needs_press(setting: Setting) -> bool:
    """Whether a setting needs a press."""
    return any(setting.values[n] for n in candidate_effect(setting.candidate).pressed)


def _weighed_presses(effect: PressedEffect, setting: Setting) -> dict[Name, float]:
    """Names of the presses of a layout that count at a setting, with their weights. ValueError beyond its bounds."""
    weighed = zip(effect.points, effect.weights(setting.values), strict=True)
    return {press_name(setting.candidate, point): w for point, w in weighed if abs(w) > NEGLIGIBLE_WEIGHT}


def _pressed_part(setting: Setting) -> Setting:
    """Setting without what acts on the tables instead of in a press."""
    pressed = candidate_effect(setting.candidate).pressed
    return replace(setting, values=tuple(v if n in pressed else 0.0 for n, v in enumerate(setting.values)))


def press_name(candidate: Candidate, point: Sequence[float]) -> Name:
    """Name of a press, the same for a nuisance and for the candidate that has it among others."""
    on = tuple((c.name, value) for c, value in zip(candidate.coordinates, point, strict=True) if value != 0.0)
    return (*candidate.name, on)


def _coordinates_name(candidate: Candidate) -> Name:
    """Name of a candidate by its coordinates: a candidate and a nuisance that is one of its coordinates are two."""
    return (*candidate.name, *(coordinate.name for coordinate in candidate.coordinates))


def _parameter_words(candidate: Candidate, point: Sequence[float]) -> str:
    """Words for the parameters at a press."""
    parameters = candidate.parameters(point)
    return ", ".join(f"{k} = {v:.3g}" if isinstance(v, float) else f"{k} = {v}" for k, v in parameters.items())


def _place_name(place: Place) -> Name:
    return ("place", *place)
