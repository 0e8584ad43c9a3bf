"""The reduced model of one segment: force, charge and voltage for a recording, in milliseconds."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mesh.types import Floats
from solve.materials.prony import Prony
from solve.parameters import Readout
from solve.physics import Physics
from solve.reduced.circuit import amplify, filters
from solve.reduced.fit import Fit
from solve.reduced.response_kernel import BY_DEPTH, BY_FORCE, TOO_DEEP, follow


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
    """What the answer may be off by at any time, as measured on the presses kept out of the fit."""

    force_N: float
    charge_C: float
    voltage_V: float


@dataclass(frozen=True)
class Response:
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


@dataclass(frozen=True)
class ReducedModel:
    """See solve.reduced.build. relaxing : layer -> largest sum of its relative moduli.

    film : per electrode the capacitance (F) and the area (m2), (e, 2); pyroelectric_uC_per_m2_K of the film;
    structure : the parts of the physics that are in the samples.
    """

    fit: Fit
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
    ) -> Response:
        """The answer to a sensor displacement depth_mm (t,), negative while clear, or else to a force_N (t,).

        The segment is at rest before the first sample. wired : (e,) 1 for the electrodes on the amplifier, else 0.
        ValueError with one sentence for what the samples do not cover.
        """
        physics, readout = physics or Physics(), readout or Readout()
        self._refuse(physics)
        time, drive, kind = _given(time_s, depth_mm, force_N, gap_mm)
        path, outputs = self._follow(time, drive, kind, physics)
        force, mass = outputs[:, 0].copy(), 1e-6 * physics.moving_mass_g  # N s2 / mm
        if kind == BY_FORCE:
            force = drive.copy()
        elif physics.rig_compliance_mm_per_N > 0.0:
            force = (drive - path) / physics.rig_compliance_mm_per_N
        elif mass > 0.0:
            force = force + mass * _acceleration(time, drive)
        each = outputs[:, 2:] + self._other_charge(time, outputs[:, 1], physics)
        wired = np.ones(len(self.film)) if wired is None else np.asarray(wired, dtype=np.float64)
        charge, capacitance = each @ wired, float(self.film[:, 0] @ wired)
        voltage = amplify(time, charge, capacitance, readout, physics)
        bound = self._bound(time, outputs, wired, capacitance, readout, physics)
        return Response(time, path + gap_mm, force, charge, each, voltage, bound)

    def _refuse(self, physics: Physics) -> None:
        if physics.friction > 0.0 or physics.softening or physics.film_yield is not None:
            raise ValueError("the reduced model has no friction, softening or yield: these stay with the full solve")
        if structure(physics) != self.structure:
            raise ValueError("the reduced model was made with other bonds, delaminations or prestretch: build it anew")
        for name, series in physics.viscosity.items():
            share = sum(series.relative_moduli)
            if share > self.relaxing.get(name, 0.0) * (1.0 + 1e-9):
                allowed = self.relaxing.get(name, 0.0)
                raise ValueError(f"{name} relaxes by {share:g} of its stress: the reduced model knows up to {allowed:g}")

    def _follow(self, time: Floats, drive: Floats, kind: int, physics: Physics) -> tuple[Floats, Floats]:
        compliance = physics.rig_compliance_mm_per_N
        if kind == BY_DEPTH and compliance == 0.0 and drive.max() > self.depth_mm * (1.0 + 1e-9):
            raise ValueError(f"depth {drive.max():.4g} mm: the reduced model knows up to {self.depth_mm:g} mm")
        path, outputs = np.empty(len(time)), np.empty((len(time), 2 + len(self.film)))
        moduli, times, layer = _branches(physics.viscosity, tuple(self.relaxing))
        told = (time, drive, kind, compliance, 1e-6 * physics.moving_mass_g, self.fit.table, self.fit.touch)
        series = (self.fit.pairs, self.fit.owner, moduli, times, layer)
        if follow(*told, self.depth_mm, *series, outputs.shape[1], path, outputs) == TOO_DEEP:
            raise ValueError(f"the dot goes deeper than {self.depth_mm:g} mm, the most that the reduced model knows")
        return path, outputs

    def _other_charge(self, time: Floats, contact_area: Floats, physics: Physics) -> Floats:
        """Charge of heat and of touch (t, e), as solve.recorder adds it."""
        area, heat = self.film[:, 1], physics.pyroelectric
        elapsed = np.maximum(time - time[0], 0.0)
        temperature = -heat.temperature_step_K * np.expm1(-elapsed / heat.time_constant_s)
        pyroelectric = 1e-6 * self.pyroelectric_uC_per_m2_K * temperature[:, None] * area
        touched = contact_area / max(float(contact_area.max()), 1e-300)
        return np.asarray(pyroelectric + 1e-12 * physics.contact_charge_pC * touched[:, None] * area / area.sum())

    def _bound(
        self, time: Floats, outputs: Floats, wired: Floats, capacitance: float, readout: Readout, physics: Physics
    ) -> ErrorBound:
        """Of C V' = e' - V / R with an error e of the charge: |V| <= 2 max|e| / C and |V| <= R max|e'|.

        A filter behind it multiplies by at most the integral of its |impulse response|, below 2 for a first-order
        low-pass (1) and high-pass (2); higher orders ring: 2 is taken for each order.
        """
        charge = outputs[:, 2:] @ wired
        off = self.accuracy.charge * float(np.abs(charge).max())
        rate = self.accuracy.charge_rate * float(np.abs(np.diff(charge) / np.diff(time)).max())
        if readout.mode == "charge":
            capacitance = 1e-12 * (readout.feedback_pF or np.inf)
            resistance = 1e6 * (readout.feedback_MOhm or np.inf)
        else:
            capacitance = capacitance + 1e-12 * readout.input_capacitance_pF
            resistance = 1e6 * (readout.input_resistance_MOhm or np.inf)
        static = (1.0 if np.isinf(resistance) else 2.0) * off / capacitance
        voltage = min(static, resistance * rate) if rate > 0.0 else static
        for _, order, kind in filters(readout, physics):
            voltage *= 1.0 if (kind, order) == ("low", 1) else 2.0**order
        return ErrorBound(self.accuracy.force * float(np.abs(outputs[:, 0]).max()), off, voltage)


def structure(physics: Physics) -> str:
    """What of the physics the samples contain."""
    return repr((sorted(physics.bonds.items()), physics.delaminations, physics.prestretch))


def _given(
    time_s: Floats, depth_mm: Floats | None, force_N: Floats | None, gap_mm: float
) -> tuple[Floats, Floats, int]:
    """Time, drive and its kind, checked."""
    if (depth_mm is None) == (force_N is None):
        raise ValueError("give either depth_mm or force_N")
    given = depth_mm if depth_mm is not None else force_N
    time, drive = np.ascontiguousarray(time_s, dtype=np.float64), np.array(given, dtype=np.float64)
    if time.ndim != 1 or drive.shape != time.shape or len(time) < 2:
        raise ValueError("time_s and the drive need one equal length of at least 2")
    if not (np.isfinite(time).all() and np.isfinite(drive).all() and (np.diff(time) > 0.0).all()):
        raise ValueError("time_s must increase, and both it and the drive be finite")
    return time, drive - (gap_mm if depth_mm is not None else 0.0), BY_DEPTH if depth_mm is not None else BY_FORCE


def _branches(
    viscosity: Mapping[str, Prony], layers: tuple[str, ...]
) -> tuple[Floats, Floats, np.ndarray[tuple[int], np.dtype[np.int64]]]:
    """Relative moduli, times (s) and layer numbers (b,) of all Prony branches."""
    rows = [
        (g, tau, layers.index(name))
        for name, series in viscosity.items()
        for g, tau in zip(series.relative_moduli, series.relaxation_times, strict=True)
        if g > 0.0
    ]
    table = np.array(rows).reshape(-1, 3)
    return table[:, 0].copy(), table[:, 1].copy(), table[:, 2].astype(np.int64)


def _acceleration(time: Floats, depth: Floats) -> Floats:
    """Second derivative (t,) by differences, at rest before and after."""
    step = np.diff(time)
    rate = np.concatenate([[0.0], np.diff(depth) / step, [0.0]])
    width = np.concatenate([step[:1], 0.5 * (step[1:] + step[:-1]), step[-1:]])
    return np.asarray(np.diff(rate) / width)
