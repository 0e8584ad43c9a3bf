"""The reduced model of one segment: force, charge and voltage for a recording, in milliseconds."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from foundation.arrays import Floats
from solve.added import Motion, added_charge_C
from solve.materials.prony import Prony
from solve.model import Readout
from solve.physics import Physics, laws_of
from solve.readout.amplifier import amplify, input_of, stages
from solve.reduced.fit import CELLS, ResponseTable
from solve.reduced.recording import branches, check_recording, second_differences, sensor_force_N
from solve.reduced.response import Accuracy, ErrorBound, Raw, ReducedResponse
from solve.reduced.rig import compliance_mm_per_N, mass_Ns2_per_mm, unknown_of_rig, unknown_of_segment
from solve.reduced.time_stepping import BY_DEPTH, BY_FORCE, TOO_DEEP, follow

ERROR_MARGIN = 2.0  # of the bound over the largest error that was measured


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
        self._refuse_unsampled(physics)
        time, drive, kind = check_recording(time_s, depth_mm, force_N, gap_mm)
        path, outputs = self._follow(time, drive, kind, physics)
        motion = Motion(drive, partial(np.gradient, drive, time), partial(second_differences, time, drive))
        force = sensor_force_N(drive, kind, path, outputs[:, 0], physics, motion)
        area, constant = self.film[:, 1], self.pyroelectric_uC_per_m2_K
        each = outputs[:, 2:] + added_charge_C(physics.added, time, outputs[:, 1], area, constant, outputs[:, 2:])
        wired = np.ones(len(self.film)) if wired is None else np.asarray(wired, dtype=np.float64)
        charge, capacitance = each @ wired, float(self.film[:, 0] @ wired)
        voltage = amplify(time, charge, capacitance, readout, physics)
        bound = self._bound(Raw(time, path, outputs), wired, capacitance, readout, physics)
        return ReducedResponse(time, path + gap_mm, force, charge, each, voltage, bound)

    def _refuse_unsampled(self, physics: Physics) -> None:
        """ValueError for physics that the samples do not cover."""
        if unknown := unknown_of_segment(physics):
            raise ValueError(f"the reduced model has no {' and no '.join(unknown)}: that needs the full solver")
        if structure_key(physics) != self.structure:
            other = "other bonds, delaminations, prestretch or elastic terms"
            raise ValueError(f"the reduced model was made with {other}: build it again")
        for name, series in laws_of(physics.inelastic, Prony).items():
            if not series.linear:
                raise ValueError(f"the reduced model has no branches that flow: {name} needs the full solver")
            share, known = sum(series.relative_moduli), self.relaxing.get(name, 0.0)
            if share > known * (1.0 + 1e-9):
                raise ValueError(f"{name} relaxes by {share:g} of its stress: the reduced model knows up to {known:g}")

    def _follow(self, time: Floats, drive: Floats, kind: int, physics: Physics) -> tuple[Floats, Floats]:
        """Path of the dot (t,) and outputs (t, 2 + e) over time. ValueError where the dot goes too deep."""
        compliance = compliance_mm_per_N(physics)
        unknown = unknown_of_rig(physics) if kind == BY_FORCE or compliance > 0.0 else []
        if unknown:
            raise ValueError(f"the reduced model moves no dot with {' and '.join(unknown)}: that needs the full solver")
        if kind == BY_DEPTH and compliance == 0.0 and drive.max() > self.depth_mm * (1.0 + 1e-9):
            raise ValueError(f"depth {drive.max():.4g} mm: the reduced model knows up to {self.depth_mm:g} mm")
        path, outputs = np.empty(len(time)), np.empty((len(time), 2 + len(self.film)))
        moduli, times, layer = branches(laws_of(physics.inelastic, Prony), tuple(self.relaxing))
        fit, mass = self.fit, mass_Ns2_per_mm(physics)
        status = follow(
            time, drive, kind, compliance, mass, fit.table, fit.touch, self.depth_mm, fit.pairs, fit.start, moduli,
            times, layer, outputs.shape[1], path, outputs,
        )  # fmt: skip
        if status == TOO_DEEP:
            raise ValueError(f"the dot goes deeper than {self.depth_mm:g} mm, for which the reduced model was made")
        return path, outputs

    def _bound(self, answer: Raw, wired: Floats, capacitance: float, readout: Readout, physics: Physics) -> ErrorBound:
        """Bound of the error of an answer. With an error e of the charge in C V' = e' - V / R, |V| <= 2 max|e| / C and
        |V| <= R max|e'|.

        Shallow and slow presses get the error that the model has at full depth. A stage behind the input multiplies
        by at most its largest gain.
        """
        force, charge, rate = self._largest_signals(answer, wired)
        charge *= ERROR_MARGIN * self.accuracy.charge
        capacitance, resistance = input_of(readout, capacitance)
        voltage = (1.0 if np.isinf(resistance) else 2.0) * charge / abs(capacitance)
        if np.isfinite(resistance):
            voltage = min(voltage, abs(resistance) * ERROR_MARGIN * self.accuracy.charge_rate * rate)
        for one in stages(readout, physics):
            voltage *= one.largest_gain()
        return ErrorBound(ERROR_MARGIN * self.accuracy.force * force, charge, voltage)

    def _largest_signals(self, answer: Raw, wired: Floats) -> tuple[float, float, float]:
        """Largest force, charge and rate of the charge, at full depth without relaxation or in this answer."""
        elastic = self.fit.table[:, 0]
        charge, known = answer.outputs[:, 2:] @ wired, elastic[:, 2 : 2 + len(wired)] @ wired
        slope = np.abs(np.diff(known)).max() * CELLS / self.depth_mm
        step = np.diff(answer.time_s)
        rate = max(np.abs(np.diff(charge) / step).max(), slope * np.abs(np.diff(answer.path_mm) / step).max())
        force = max(np.abs(elastic[:, 0]).max(), np.abs(answer.outputs[:, 0]).max())
        return float(force), float(max(np.abs(known).max(), np.abs(charge).max())), float(rate)


def structure_key(physics: Physics) -> str:
    """Text of the physics that the samples contain, by which models are told apart."""
    built_in = physics.structure
    return repr((sorted(built_in.bonds.items()), built_in.delaminations, built_in.prestretch, built_in.terms))
