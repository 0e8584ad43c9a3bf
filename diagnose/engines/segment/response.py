"""The signals of a run's instruments, from a response table and a drive."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.engines.segment.drive import Drive
from diagnose.signals.recording import Run
from foundation.arrays import Floats
from solve.added import Motion, added_charge_C
from solve.materials.prony import Prony
from solve.model import Model, Readout
from solve.physics import Physics, laws_of
from solve.readout.amplifier import amplify
from solve.readout.channels import amplify_channels
from solve.reduced.fit import ResponseTable
from solve.reduced.recording import branches, sensor_force_N
from solve.reduced.rig import compliance_mm_per_N, mass_Ns2_per_mm, unknown_of_rig
from solve.reduced.time_stepping import TOO_DEEP, follow


@dataclass(frozen=True)
class FilmPlate:
    """The film as a plate with e electrodes. electrodes (e, 2) : capacitance in F and area in m2 of each.

    pyroelectric_uC_per_m2_K : pyroelectric constant.
    """

    electrodes: Floats
    pyroelectric_uC_per_m2_K: float

    def with_capacitance_factor(self, factor: float) -> "FilmPlate":
        """Film whose capacitance is larger by a factor, as that of a thinner one."""
        return replace(self, electrodes=self.electrodes * [factor, 1.0])

    def whole_charge_C(self, time_s: Floats, found: "Mechanics", physics: Physics) -> Floats:
        """Charge (t, e) of the strain and of all that is added to it; time (t,) from the first touch."""
        told = found.area_m2, self.electrodes[:, 1], self.pyroelectric_uC_per_m2_K, found.charge_C
        return np.asarray(found.charge_C + added_charge_C(physics.added, time_s, *told))


@dataclass(frozen=True)
class Mechanics:
    """Dot and segment over time (t,): path of the dot in mm, contact force in N and area in m2, charges (t, e) in C."""

    path_mm: Floats
    force_N: Floats
    area_m2: Floats
    charge_C: Floats


def mechanics(
    fit: ResponseTable, depth_mm: float, layers: tuple[str, ...], drive: Drive, values: Floats, on: Model
) -> Mechanics:
    """Mechanics under a drive of these values (t,). ValueError where the dot goes deeper than the table."""
    physics, modes = on.physics, int(fit.start[-1])
    observed = fit.table.shape[2] - modes
    path, outputs = np.empty(len(values)), np.empty((len(values), observed))
    moduli, times, layer = branches(laws_of(physics.inelastic, Prony), layers)
    compliance = compliance_mm_per_N(physics)
    unknown = [] if drive.by_depth and compliance == 0.0 else unknown_of_rig(physics)
    if unknown:
        raise ValueError(f"{', '.join(unknown)}: without the 3D model a dot moves on its own by spring and mass alone")
    status = follow(
        drive.time_s, values, drive.kind, compliance, mass_Ns2_per_mm(physics), fit.table, fit.touch, depth_mm,
        fit.pairs, fit.start, moduli, times, layer, observed, path, outputs,
    )  # fmt: skip
    if status == TOO_DEEP:
        raise ValueError(f"the dot goes deeper than {depth_mm:.4g} mm, the most that was prepared")
    # between its presses a table may tell an area just below none, of which there is no power
    return Mechanics(path, outputs[:, 0], np.maximum(outputs[:, 1], 0.0), outputs[:, 2:])


def channel_signals(
    run: Run, names: Sequence[str], drive: Drive, values: Floats, found: Mechanics, film: FilmPlate, on: Model,
    ahead_s: float = 0.0,
) -> dict[str, Floats]:  # fmt: skip
    """Signals (t,) of the named channels of a run.

    Where nothing pushes, nobody can tell where a dot hangs: there the path is as recorded. ahead_s : by which the mains
    are ahead of the first touch.
    """
    signals: dict[str, Floats] = {}
    voltages = sorted((name for name in names if name.startswith("voltage")), key=_electrode_number)
    if voltages:
        signals |= amplifier_voltages(voltages, drive.time_s, found, film, on, ahead_s)
    if "force_N" in names:
        told = (values, drive.kind, found.path_mm, found.force_N, on.physics)
        motion = Motion(values, lambda: run.velocity_mm_per_s, lambda: run.acceleration_mm_per_s2)
        signals["force_N"] = sensor_force_N(*told, motion)
    if "displacement_mm" in names:
        path = found.path_mm + on.dot.gap_mm + compliance_mm_per_N(on.physics) * values  # the rig's sensor, not the dot
        signals["displacement_mm"] = np.where(drive.touching, path, run.channels.get("displacement_mm", path))
    return {name: signals[name] for name in names}


def _electrode_number(name: str) -> int:
    """Number of the electrode in the name of a channel, 0 without one: voltage_3_V -> 3."""
    return int("0" + "".join(filter(str.isdigit, name)))


def amplifier_voltages(
    names: Sequence[str], time_s: Floats, found: Mechanics, film: FilmPlate, on: Model, ahead_s: float
) -> dict[str, Floats]:
    """Voltages (t,) by name: one of all electrodes together, or one of each with what leaks in from the others.

    names : in the order of the electrodes.
    """
    charge = film.whole_charge_C(time_s, found, on.physics)
    time_s = time_s + ahead_s  # the amplifier itself knows differences of time only
    readout = on.readout or Readout()
    if len(names) == 1:
        told = (time_s, charge.sum(axis=1), float(film.electrodes[:, 0].sum()), readout, on.physics)
        return {names[0]: amplify(*told)}
    voltages = amplify_channels(time_s, charge, film.electrodes[:, 0], readout, on.physics)
    return dict(zip(names, voltages, strict=True))
