"""The content of summary.json: the results of a run, in the units that people read."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from foundation.arrays import Floats
from softdot.config.hashes import config_hash
from softdot.config.schema import Config
from softdot.output import RUN
from softdot.sensitivity import least_detectable, press_noise, sensitivity
from solve.model import Model, Readout
from solve.readout.course import PressCourse
from solve.readout.noise import PER_DECADE, NoiseBudget
from solve.result import PressResult
from solve.solution.schedule import fraction
from solve.waveform import Waveform

MM, PC, PF, MPA = 1e3, 1e12, 1e12, 1e-6
"""Factors from SI units to those of the summary."""


@dataclass(frozen=True)
class History:
    """Load history, each of shape (s,), index 0 unloaded; electrodes taken in parallel."""

    indentation_mm: Floats
    reaction_force_N: Floats
    film_charge_pC: Floats
    open_circuit_voltage_V: Floats


def history(result: PressResult) -> History:
    """The history of a press with electrodes in parallel: charges and capacitances add up, V = Q / C."""
    steps = result.steps
    charge = np.array([step.film_charge_C.sum() for step in steps])
    weighted = np.array([step.open_circuit_voltage_V @ result.capacitance_F for step in steps])
    return History(
        indentation_mm=MM * np.array([step.indentation_m for step in steps]),
        reaction_force_N=np.array([step.reaction_force_N for step in steps]) + 0.0,  # no -0 at rest
        film_charge_pC=PC * charge,
        open_circuit_voltage_V=weighted / result.capacitance_F.sum(),
    )


def heading(config: Config) -> dict[str, Any]:
    """The keys of the summary that are known before any work."""
    from softdot.version import installed_version

    return {
        "format": RUN.format,
        "softdot_version": installed_version(),
        "config_hash": config_hash(config),
        "seed": config.seed,
        "config": config.model_dump(mode="json"),
        "from_default": list(config.from_default),
    }


def press_part(model: Model, result: PressResult, along: PressCourse) -> dict[str, Any]:
    """The keys of the summary that the press gives. along : its course."""
    past, solved = history(result), along.solved
    readout_voltage_V = None if along.together_V is None else along.together_V[solved]
    voltage = past.open_circuit_voltage_V if readout_voltage_V is None else readout_voltage_V
    budget = press_noise(model, result, along)
    noise_V = (model.readout or Readout()).noise_V if budget is None else budget.rms_V
    part = {
        "indentation_mm": past.indentation_mm,
        "reaction_force_N": past.reaction_force_N,
        "film_charge_pC": past.film_charge_pC,
        "open_circuit_voltage_V": past.open_circuit_voltage_V,
    }
    if result.follows_time:
        part["time_s"] = np.array([step.time_s for step in result.steps])
    if readout_voltage_V is not None:
        part["readout_voltage_V"] = readout_voltage_V
        part["time_s"] = along.time_s[solved]
    found = {
        **part,
        "film": film(result),
        "electrodes": electrodes(result, along),
        "sensitivity": {
            **sensitivity(past.indentation_mm, past.reaction_force_N, past.film_charge_pC, voltage, noise_V),
            **_instants(past, voltage, along, noise_V),
        },
        **({} if budget is None else {"noise": _noise_part(budget)}),
        "course": course_part(model, result, along),
    }
    return {**found, "solver": _solver_part(found, result)}


def _noise_part(budget: NoiseBudget) -> dict[str, Any]:
    """The noise of the recorded voltage: root mean square, its parts, and their spectra at ten frequencies a decade."""
    shown = slice(None, None, PER_DECADE // 10)
    return {
        "rms_V": budget.rms_V,
        "parts_V": dict(budget.parts_V),
        "above_half_rate_V": budget.above_half_rate_V,
        "bias_offset_V": budget.offset_V,
        "frequency_Hz": budget.frequency_Hz[shown],
        "density_V_per_rtHz": {
            name: np.sqrt(one[shown]) for name, one in budget.density_V2_per_Hz.items() if one.any()
        },
    }


def _instants(past: History, voltage_V: Floats, along: PressCourse, noise_V: float) -> dict[str, float | None]:
    """Times of the stated voltage per depth, and of the least detectable depth on the way in."""
    times = along.time_s[along.solved]
    deepest = int(np.argmax(past.indentation_mm))
    least = least_detectable(past.indentation_mm, voltage_V, noise_V)
    way_in = slice(0, int(along.solved[deepest]) + 1)
    depth = np.maximum.accumulate(MM * along.indentation_m[way_in])
    when = None if least is None else float(np.interp(least, depth, along.time_s[way_in]))
    return {"at_time_s": float(times[deepest]), "least_detectable_at_time_s": when}


PARALLEL_CHANNEL = "together"
"""Name of the channel of all electrodes in parallel, beside those of each."""


def channels(along: PressCourse, names: Sequence[str]) -> dict[str, Floats]:
    """Voltage of each amplifier over time (n,) by the name of its electrode; of several also of all in parallel."""
    if along.channels_V is None or along.together_V is None:
        return {}
    together = {PARALLEL_CHANNEL: along.together_V} if len(names) > 1 else {}
    return {**together, **dict(zip(names, along.channels_V.T, strict=True))}


def course_part(model: Model, result: PressResult, along: PressCourse) -> dict[str, Any]:
    """The course of a press: drive, force, charge, voltage and read-out at its times, electrodes by name."""
    names, press = result.electrode_names, model.press
    drive = {"indentation_mm": MM * along.indentation_m}
    if press.force_N is not None:
        drive["force_N"] = press.force_N * fraction(press.waveform or Waveform(), along.time_s)
    return {
        "time_s": along.time_s,
        **drive,
        "reaction_force_N": along.reaction_force_N,
        "charge_pC": dict(zip(names, PC * along.charge_C.T, strict=True)),
        "voltage_V": dict(zip(names, along.voltage_V.T, strict=True)),
        "readout_V": channels(along, names),
        "solved": along.solved,
        "readout_error_percent": along.readout_error_percent,
    }


def course_columns(part: Mapping[str, Any]) -> dict[str, Floats]:
    """The curves of a course_part as columns, with electrode or channel at the end of their name: charge_pC_left."""
    columns: dict[str, Floats] = {}
    for key, value in part.items():
        if isinstance(value, Mapping):
            columns |= {f"{key}_{name}": curve for name, curve in value.items()}
        elif key not in ("solved", "readout_error_percent"):
            columns[key] = value
    return columns


def _solver_part(found: Mapping[str, Any], result: PressResult) -> dict[str, Any]:
    """The report of the solver; a result with a number that is not finite did not converge, whatever the residual."""
    told, nonsense = solver(result), not_finite(found)
    if told["converged"] and nonsense is not None:
        return {**told, "converged": False, "failure": f"{nonsense} is not a finite number"}
    return told


def not_finite(value: Any, name: str = "") -> str | None:
    """The place of the first NaN or infinite number of a summary, such as 'readout_voltage_V[1]'; None without one."""
    if isinstance(value, Mapping):
        items = [(item, f"{name}.{key}" if name else str(key)) for key, item in value.items()]
    elif isinstance(value, list | tuple | np.ndarray) and np.ndim(value) > 0:
        items = [(item, f"{name}[{number}]") for number, item in enumerate(value)]
    else:
        return name if isinstance(value, float | np.floating) and not np.isfinite(value) else None
    return next((where for item, inner in items if (where := not_finite(item, inner)) is not None), None)


def film(result: PressResult) -> dict[str, Any]:
    """The film's capacitance and largest strain, stress and charge density, away from held rims and at them."""
    peak = result.film_peak
    return {
        "capacitance_pF": PF * result.capacitance_F.sum(),
        "max_principal_strain": peak.strain,
        "max_principal_stress_MPa": MPA * peak.stress_Pa,
        "charge_density_pC_per_mm2": [1e6 * density for density in peak.charge_density_C_per_m2],
        "rim_distance_mm": MM * peak.rim_distance_m,
        "rim_principal_strain": peak.rim_strain,
        "rim_principal_stress_MPa": MPA * peak.rim_stress_Pa,
    }


def electrodes(result: PressResult, along: PressCourse) -> list[dict[str, Any]]:
    """Charge and voltage of each electrode at the solved steps."""
    return [
        {
            "name": name,
            "capacitance_pF": PF * result.capacitance_F[number],
            "film_charge_pC": [PC * step.film_charge_C[number] for step in result.steps],
            "open_circuit_voltage_V": [step.open_circuit_voltage_V[number] for step in result.steps],
            **({} if along.channels_V is None else {"readout_voltage_V": along.channels_V[along.solved, number]}),
        }
        for number, name in enumerate(result.electrode_names)
    ]


def solver(result: PressResult) -> dict[str, Any]:
    """The report of the solver; step 0 is the unloaded state and does not count."""
    return {
        "converged": result.converged,
        "failure": result.failure,
        "load_steps": len(result.steps) - 1,
        "newton_iterations": sum(step.newton_iterations for step in result.steps),
        "linear_solver": result.linear_solver,
        "max_relative_residual": result.max_relative_residual,
    }


def stopped_solver(failure: str) -> dict[str, Any]:
    """The report of the solver where an earlier stage failed."""
    return {"converged": False, "failure": failure, "load_steps": 0}


def mesh_part(quality: Mapping[str, Any], unknowns: int | None) -> dict[str, Any]:
    """Quality of the mesh and, once known, the number of unknowns."""
    return {**quality, "unknowns": unknowns}
