"""The reduced model of one segment: force, charge and voltage for a recording, in milliseconds.

What a reduced model gives back, and how far it may be off.

A recording as the reduced model's kernel takes it, and what the force sensor reads in the end.

Reduced models kept on disk under a hash of all that they depend on.
"""

import json
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geometry.arrays import Floats, Ints
from geometry.cache import data_hash, folder, read_arrays, source_hash, write_arrays
from mesh.types import mesh_hash
from solve.materials.prony import Prony
from solve.model import Physics, Readout
from solve.readout.amplifier import amplify, input_of, other_charge_C, stages
from solve.reduced.fit import CELLS, ResponseTable
from solve.reduced.kernels import BY_DEPTH, BY_FORCE, TOO_DEEP, follow

if TYPE_CHECKING:
    from solve.reduced.build import ReductionTask


@dataclass(frozen=True)
class Raw:
    """The dot's path from its nominal touch (t,), and force, contact area and charges (t, 2 + e)."""

    time_s: Floats
    path_mm: Floats
    outputs: Floats


@dataclass(frozen=True)
class Accuracy:
    """Largest error against the 3D presses kept out of the fit, each a share of the 3D model's largest value.

    force, charge; charge_rate : of the charge's rate between the 3D model's time steps.
    """

    force: float
    charge: float
    charge_rate: float


@dataclass(frozen=True)
class ErrorBound:
    """What the answer may be off by at any time: a margin over what was measured on the presses kept out of the fit."""

    force_N: float
    charge_C: float
    voltage_V: float


@dataclass(frozen=True)
class ReducedResponse:
    """Over time (t,): the dot's path, the force sensor's reading, the charge and the amplifier's voltage.

    charge_C is that of the electrodes on this amplifier together, electrode_charge_C (t, e) of each.
    """

    time_s: Floats
    dot_path_mm: Floats
    force_N: Floats
    charge_C: Floats
    electrode_charge_C: Floats
    voltage_V: Floats
    error_bound: ErrorBound


def given(time_s: Floats, depth_mm: Floats | None, force_N: Floats | None, gap_mm: float) -> tuple[Floats, Floats, int]:
    """Time (t,) in s, drive (t,) in mm from touch or in N, and its kind. ValueError for what is no recording."""
    if (depth_mm is None) == (force_N is None):
        raise ValueError("give either depth_mm or force_N")
    given = depth_mm if depth_mm is not None else force_N
    time, drive = np.ascontiguousarray(time_s, dtype=np.float64), np.array(given, dtype=np.float64)
    if time.ndim != 1 or drive.shape != time.shape or len(time) < 2:
        raise ValueError("time_s and the drive need the same length, at least 2")
    if not (np.isfinite(time).all() and np.isfinite(drive).all() and (np.diff(time) > 0.0).all()):
        raise ValueError("time_s must increase, and both it and the drive be finite")
    return time, drive - (gap_mm if depth_mm is not None else 0.0), BY_DEPTH if depth_mm is not None else BY_FORCE


def branches(viscosity: Mapping[str, Prony], layers: tuple[str, ...]) -> tuple[Floats, Floats, Ints]:
    """Relative moduli, times (s) and layer numbers (b,) of all Prony branches."""
    rows = [
        (g, tau, layers.index(name))
        for name, series in viscosity.items()
        for g, tau in zip(series.relative_moduli, series.relaxation_times, strict=True)
        if g > 0.0
    ]
    table = np.array(rows).reshape(-1, 3)
    return table[:, 0].copy(), table[:, 1].copy(), table[:, 2].astype(np.int64)


Accelerated = Callable[[], Floats]
"""Acceleration (t,) of a path in mm/s2, calculated where a mass feels it."""


def sensed(
    drive: Floats, kind: int, path: Floats, contact: Floats, physics: Physics, accelerated: Accelerated
) -> Floats:
    """What the force sensor reads (t,): the force that drives, that of the rig's spring, or F_contact + m a''.

    A guide adds its friction to either of the latter. accelerated : the drive.
    """
    if kind == BY_FORCE:
        return drive.copy()
    if physics.rig_compliance_mm_per_N > 0.0:
        return np.asarray((drive - path) / physics.rig_compliance_mm_per_N + physics.guide.felt_N(drive))
    return felt(drive, contact, physics, accelerated)


def felt(depth: Floats, force: Floats, physics: Physics, accelerated: Accelerated) -> Floats:
    """Force (t,) with those of a mass and a guide which move along a path (t,) in mm: F + m a'' + f."""
    total = force + physics.guide.felt_N(depth)
    return total + 1e-6 * physics.moving_mass_g * accelerated() if physics.moving_mass_g > 0.0 else total


def second_differences(time: Floats, path: Floats) -> Floats:
    """Second derivative (t,) of a path (t,), at rest before and after."""
    step = np.diff(time)
    rate = np.concatenate([[0.0], np.diff(path) / step, [0.0]])
    width = np.concatenate([step[:1], 0.5 * (step[1:] + step[:-1]), step[-1:]])
    return np.asarray(np.diff(rate) / width)


MARGIN = 2.0  # of the bound over the largest error that was measured


@dataclass(frozen=True)
class ReducedModel:
    """See solve.reduced.build. relaxing : layer -> largest sum of its relative moduli.

    film : per electrode the capacitance (F) and the area (m2), (e, 2); pyroelectric_uC_per_m2_K of the film;
    structure : the parts of the physics that are in the samples.
    """

    fit: ResponseTable
    depth_mm: float
    relaxing: Mapping[str, float]
    film: Floats
    pyroelectric_uC_per_m2_K: float
    structure: str
    accuracy: Accuracy

    def respond(
        self,
        time_s: Floats,
        depth_mm: Floats | None = None,
        physics: Physics | None = None,
        readout: Readout | None = None,
        *,
        force_N: Floats | None = None,
        gap_mm: float = 0.0,
        wired: Floats | None = None,
    ) -> ReducedResponse:
        """The answer to a sensor displacement depth_mm (t,), negative while clear, or else to a force_N (t,).

        The segment is at rest before the first sample, whose depth or force it takes at once. wired : (e,) 1 for the
        electrodes on the amplifier, else 0.
        ValueError with one sentence for what the samples do not cover.
        """
        physics, readout = physics or Physics(), readout or Readout()
        self._refuse(physics)
        time, drive, kind = given(time_s, depth_mm, force_N, gap_mm)
        path, outputs = self._follow(time, drive, kind, physics)
        accelerated = partial(second_differences, time, drive)
        force = sensed(drive, kind, path, outputs[:, 0], physics, accelerated)
        area, constant = self.film[:, 1], self.pyroelectric_uC_per_m2_K
        each = outputs[:, 2:] + other_charge_C(time, outputs[:, 1], area, constant, physics)
        wired = np.ones(len(self.film)) if wired is None else np.asarray(wired, dtype=np.float64)
        charge, capacitance = each @ wired, float(self.film[:, 0] @ wired)
        voltage = amplify(time, charge, capacitance, readout, physics)
        bound = self._bound(Raw(time, path, outputs), wired, capacitance, readout, physics)
        return ReducedResponse(time, path + gap_mm, force, charge, each, voltage, bound)

    def _refuse(self, physics: Physics) -> None:
        if physics.friction > 0.0 or physics.softening or physics.film_yield is not None:
            raise ValueError("the reduced model has no friction, softening or yield: these need the full solver")
        if structure(physics) != self.structure:
            raise ValueError("the reduced model was made with other bonds, delaminations or prestretch: build it again")
        for name, series in physics.viscosity.items():
            if not series.linear:
                raise ValueError(f"the reduced model has no branches that flow: {name} needs the full solver")
            share, known = sum(series.relative_moduli), self.relaxing.get(name, 0.0)
            if share > known * (1.0 + 1e-9):
                raise ValueError(f"{name} relaxes by {share:g} of its stress: the reduced model knows up to {known:g}")

    def _follow(self, time: Floats, drive: Floats, kind: int, physics: Physics) -> tuple[Floats, Floats]:
        compliance = physics.rig_compliance_mm_per_N
        if kind == BY_DEPTH and compliance == 0.0 and drive.max() > self.depth_mm * (1.0 + 1e-9):
            raise ValueError(f"depth {drive.max():.4g} mm: the reduced model knows up to {self.depth_mm:g} mm")
        path, outputs = np.empty(len(time)), np.empty((len(time), 2 + len(self.film)))
        moduli, times, layer = branches(physics.viscosity, tuple(self.relaxing))
        fit, mass = self.fit, 1e-6 * physics.moving_mass_g  # N s2 / mm
        status = follow(
            time, drive, kind, compliance, mass, fit.table, fit.touch, self.depth_mm, fit.pairs, fit.start, moduli,
            times, layer, outputs.shape[1], path, outputs,
        )  # fmt: skip
        if status == TOO_DEEP:
            raise ValueError(f"the dot goes deeper than {self.depth_mm:g} mm, for which the reduced model was made")
        return path, outputs

    def _bound(self, answer: Raw, wired: Floats, capacitance: float, readout: Readout, physics: Physics) -> ErrorBound:
        """Of C V' = e' - V / R with an error e of the charge: |V| <= 2 max|e| / C and |V| <= R max|e'|.

        Shallow and slow presses get the error that the model has at full depth. A stage behind the input multiplies
        by at most its largest gain.
        """
        force, charge, rate = self._largest(answer, wired)
        charge *= MARGIN * self.accuracy.charge
        capacitance, resistance = input_of(readout, capacitance)
        voltage = (1.0 if np.isinf(resistance) else 2.0) * charge / abs(capacitance)
        if np.isfinite(resistance):
            voltage = min(voltage, abs(resistance) * MARGIN * self.accuracy.charge_rate * rate)
        for one in stages(readout, physics):
            voltage *= one.largest_gain()
        return ErrorBound(MARGIN * self.accuracy.force * force, charge, voltage)

    def _largest(self, answer: Raw, wired: Floats) -> tuple[float, float, float]:
        """Force, charge at full depth without relaxation or in this answer, and the charge's rate."""
        elastic = self.fit.table[:, 0]
        charge, known = answer.outputs[:, 2:] @ wired, elastic[:, 2 : 2 + len(wired)] @ wired
        slope = np.abs(np.diff(known)).max() * CELLS / self.depth_mm
        step = np.diff(answer.time_s)
        rate = max(np.abs(np.diff(charge) / step).max(), slope * np.abs(np.diff(answer.path_mm) / step).max())
        force = max(np.abs(elastic[:, 0]).max(), np.abs(answer.outputs[:, 0]).max())
        return float(force), float(max(np.abs(known).max(), np.abs(charge).max())), float(rate)


def structure(physics: Physics) -> str:
    """What of the physics the samples contain."""
    return repr((sorted(physics.bonds.items()), physics.delaminations, physics.prestretch))


def key(case: "ReductionTask", check: bool) -> str:
    """Hash of mesh, segment, materials, dot, depth, relaxing layers, physics and the solver's own source."""
    dot = case.dot
    places = (np.asarray(array).tolist() for array in (dot.tips_mm, dot.origin_mm, dot.rotation))
    content = {
        "segment": case.segment.model_dump(mode="json"),
        "materials": {name: material.model_dump(mode="json") for name, material in case.materials.items()},
        "dot": [dot.kind, dot.radius_mm, dot.height_mm, repr(dot), *places],
        "asked": [case.depth_mm, list(case.relaxing.items()), structure(case.physics), case.depth_nodes, check],
        "mesh": mesh_hash(case.tet_mesh),
        "solver": source_hash("solve.reduced.build"),
    }
    return data_hash(content)


def remembered(name: str, make: Callable[[], ReducedModel]) -> ReducedModel:
    """The model kept under this name, or a new one that is then kept. A damaged file is a miss."""
    path = folder() / f"reduced-{name}.npz"
    found = read(path)
    if found is None:
        found = make()
        with suppress(OSError):  # a cache that cannot be written is no cache
            write(path, found)
    return found


def read(path: Path) -> ReducedModel | None:
    """The model in a file, None when there is none or it is damaged."""
    return read_arrays(path, _decoded)


def _decoded(data: Mapping[str, Any]) -> ReducedModel:
    """The model in a file; ValueError when its arrays do not fit together."""
    told = json.loads(str(data["told"]))
    fit = ResponseTable(data["table"], data["touch"], data["start"], data["pairs"], told["missing"])
    if fit.table.shape[1] != len(fit.touch) or fit.table.shape[2] != 2 + len(data["film"]) + fit.start[-1]:
        raise ValueError("array shapes")
    rest = (data["film"], told["pyroelectric"], told["structure"], Accuracy(**told["accuracy"]))
    return ReducedModel(fit, told["depth_mm"], dict(told["relaxing"]), *rest)


def write(path: Path, model: ReducedModel) -> None:
    """Write the file whole. OSError."""
    told = {
        "missing": model.fit.missing, "pyroelectric": model.pyroelectric_uC_per_m2_K, "structure": model.structure,
        "accuracy": asdict(model.accuracy), "depth_mm": model.depth_mm, "relaxing": list(model.relaxing.items()),
    }  # fmt: skip
    fit = model.fit
    arrays = {
        "told": np.array(json.dumps(told)), "film": model.film, "table": fit.table, "touch": fit.touch,
        "start": fit.start, "pairs": fit.pairs,
    }  # fmt: skip
    write_arrays(path, arrays, compressed=True)
