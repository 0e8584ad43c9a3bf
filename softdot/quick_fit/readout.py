"""Resistance and capacitance of the read-out, gain, offset and lag of each run, fitted to the voltages of a recording.

The charges are those of the rig's baseline, which is pressed once and kept; the rest takes seconds. Gains, offsets and
lags have the widths that rig.toml declares, or DEFAULT_WIDTHS: charge over capacitance tells a gain from a capacitance
only as far as the gain is known.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from diagnose.engines.readout_alone import ReadoutEngine, with_voltages_alone
from diagnose.findings import Interval
from diagnose.fit.baseline import fit_baseline
from diagnose.fit.intervals import profile_intervals
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted, fit_mechanisms
from diagnose.fit.samples import Samples
from diagnose.forward import Signals
from diagnose.inference.findings_of_fits import labelled, nuisance_values
from diagnose.noise.estimate import noise_models
from diagnose.signals.reading import thin_recording
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.progress import Report
from softdot.config.rig import Rig
from softdot.config.schema import Config
from solve.materials.parameters import PiezoelectricFilm
from solve.mechanisms import with_mechanisms
from solve.model import Model, Readout

CHARGES = Readout(mode="charge", feedback_pF=1000.0)
"""An amplifier that gives the charge itself, in -nC."""
DEFAULT_WIDTHS = {"gain": 0.05, "lag_s": 5e-3}
"""One sigma of what rig.toml declares no width of; an offset has this share of the largest voltage."""
OFFSET_SHARE = 0.05


@dataclass(frozen=True)
class ReadoutFit:
    """A fit of the read-out. names (n,) : R, C, then gains, offsets and lags; values, sigmas, priors (n,), prior inf
    where there is none; correlation (n, n).

    intervals : of R and C by their keys, 90 %; in the units of the keys. stated : R and C of rig.toml, inf for none.
    shown : label -> voltages with the fit. noise_rms : (label, channel) -> its root mean square. misfit : root mean
    square of what is left, whitened: 1 for noise alone. samples : how many voltages.
    """

    recording: Recording
    names: tuple[str, ...]
    values: Floats
    sigmas: Floats
    priors: Floats
    correlation: Floats
    intervals: Mapping[str, Interval]
    stated: Mapping[str, float]
    shown: Mapping[str, Signals]
    noise_rms: Mapping[tuple[str, str], float]
    misfit: float
    samples: int


def fit_readout(rig: Rig, report: Report) -> ReadoutFit:
    """Fit the read-out of a rig with a segment. InputError for what this cannot fit, by name; NoEquilibriumError."""
    config, readout = _refused(rig)
    return fit_engine(_engine(rig, config, readout, report), report)


def fit_engine(engine: ReadoutEngine, report: Report) -> ReadoutFit:
    """Fit R and C of an engine, with the nuisances of its recording, from several starts."""
    report("fit", 0, 1)
    model = ObservedModel(Samples(engine.recording, noise_models(engine.recording)), engine)
    baseline = fit_baseline(model)
    first, second = (one.coordinates[0].starts for one in engine.candidates)
    starts = [np.array([start, second[0]]) for start in first]
    fits = [fit_mechanisms(model, baseline, engine.candidates, start, 0.0) for start in starts]
    return _outcome(model, engine, max(fits, key=lambda one: one.evidence))


def _refused(rig: Rig) -> tuple[Config, Readout]:
    """Configuration and amplifier of a rig. InputError for one whose read-out alone cannot be fitted."""
    where = f"recording '{rig.folder}'"
    if rig.config is None:
        what = "specimen" if rig.recording.specimen is not None else "geometry = 'unknown'"
        raise InputError(f"{where}: {what}: --only readout needs the charges of a rig with [segment]")
    first = rig.recording.runs[0].readout or Readout()
    for run in rig.recording.runs:
        if not run.voltages:
            raise InputError(f"{where}: '{run.file}' has no voltage, which --only readout fits")
        if (run.readout or Readout()) != first:
            raise InputError(
                f"{where}: the run '{run.label}' states another [runs.readout] than the first; --only readout fits one "
                "amplifier"
            )
    film = rig.config.layer_materials()["film"]
    if isinstance(film, PiezoelectricFilm) and film.coupling == "two-way":
        raise InputError(f"{where}: coupling = 'two-way': --only readout needs charges that no voltage acts back on")
    hum = [one.name for one in rig.config.mechanisms if one.traits.free_phase and not one.is_off]
    if hum:
        raise InputError(f"{where}: mechanisms: {hum[0]} has another phase in every run; leave it out")
    return rig.config, first


def _engine(rig: Rig, config: Config, readout: Readout, report: Report) -> ReadoutEngine:
    """The read-out alone, with the charges of the rig's baseline and the voltages that it explains."""
    from diagnose.engines.segment.engine import segment_engine
    from softdot.config.model import model_of

    electrical = [one for one in config.mechanisms if one.traits.electrical]
    bare = config.model_copy(
        update={"readout": None, "mechanisms": tuple(one for one in config.mechanisms if one not in electrical)}
    )
    recording = thin_recording(rig.recording)
    model, behind = model_of(bare), with_voltages_alone(recording, CHARGES)
    segment = segment_engine(model, bare.mesh, behind, report)
    charges = [segment.predict(number, ()) for number in range(len(behind.runs))]
    amplifier: Model = with_mechanisms(replace(model, readout=readout), electrical)
    asked = with_voltages_alone(recording, amplifier.readout or Readout())
    asked = replace(asked, runs=tuple(replace(run, nuisance=_widths(run)) for run in asked.runs))
    told = zip(charges, behind.runs, strict=True)
    return ReadoutEngine(
        recording=asked,
        charge_C=tuple(-1e-9 * np.column_stack([of[name] for name in run.voltages]) for of, run in told),
        capacitance_F=_one_for_each(segment.first_presses.film.electrodes[:, 0], len(behind.runs[0].voltages)),
        readout=amplifier.readout or Readout(),
        physics=amplifier.physics,
        error=float(segment.accuracy.get("voltage_V", 0.0)),
    )


def _one_for_each(capacitance_F: Floats, channels: int) -> Floats:
    """Capacitance of each channel: one of all electrodes together, or one of each."""
    return capacitance_F if len(capacitance_F) == channels else np.array([capacitance_F.sum()])


def _widths(run: Run) -> dict[str, float]:
    """Prior deviations of gain, offset and lag of a run."""
    largest = max(float(np.abs(run.channels[name][run.valid[name]]).max()) for name in run.voltages)
    widths = {**DEFAULT_WIDTHS, "offset_V": OFFSET_SHARE * largest}
    return {name: run.nuisance.get(name, width) for name, width in widths.items()}


def _with_common_gain(model: ObservedModel, fit: Fitted) -> Fitted:
    """Fit with a gain that all runs share, as wide as that of one: else many runs would seem to know a capacitance.

    It widens intervals and moves no value.
    """
    gains = np.array([one.name == "gain" for one in model.nuisances])
    common = fit.system.nuisance_design[:, np.flatnonzero(gains)].sum(axis=1, keepdims=True)
    return replace(fit, system=fit.system.with_nuisance_columns(common, model.sigma[gains].max(keepdims=True)))


def _outcome(model: ObservedModel, engine: ReadoutEngine, fit: Fitted) -> ReadoutFit:
    nuisances = fit.closest_nuisances(model)
    fit = _with_common_gain(model, fit)
    told = nuisance_values(model, nuisances)
    covariance, jacobian = _covariance(fit), _slopes_of_keys(engine, fit)
    scale = np.concatenate([jacobian, np.ones(len(nuisances))])
    sigmas = np.abs(scale) * np.sqrt(np.diag(covariance))
    correlation = covariance / np.sqrt(np.outer(np.diag(covariance), np.diag(covariance)))
    correlation *= np.outer(np.sign(scale), np.sign(scale))
    intervals = {
        key: interval
        for key, each in zip(engine.keys, profile_intervals(model, fit), strict=True)
        for interval in each.values()
    }
    left = fit.system.weighted_rows(fit.system.residual - _tangents(fit) @ nuisances)
    return ReadoutFit(
        recording=model.samples.recording,
        names=(*engine.keys, *told),
        values=np.array([*(intervals[key].value for key in engine.keys), *(value for value, _ in told.values())]),
        sigmas=sigmas,
        priors=np.array([np.inf, np.inf, *(sigma for _, sigma in told.values())]),
        correlation=correlation,
        intervals=intervals,
        stated={
            key: float(getattr(engine.readout, key) or nothing)
            for key, nothing in zip(engine.keys, (np.inf, 0.0), strict=True)
        },
        shown=labelled(model, nuisances, fit.settings),
        noise_rms={key: float(law["rms"]) for key, law in model.samples.noise_summaries().items()},
        misfit=float(np.sqrt(np.mean(left**2))),
        samples=len(model.samples),
    )


def _tangents(fit: Fitted) -> Floats:
    """Tangents (n, p) of the nuisances; all rows are looked at."""
    return fit.system.nuisance_design[:, : len(fit.system.values)]


def _covariance(fit: Fitted) -> Floats:
    """Covariance (q + p, q + p) of coordinates and nuisances, with the engine's own error integrated out."""
    count, sigma = fit.slopes.shape[1], fit.system.sigma
    columns = [fit.system.weighted_rows(fit.slopes), sigma * fit.system.weighted_rows(fit.system.nuisance_design)]
    design = np.hstack(columns)  # nuisances in units of their priors
    prior = np.concatenate([np.zeros(count), np.ones(len(sigma))])
    inverse = np.linalg.inv(design.T @ design + np.diag(prior))
    kept = count + len(fit.system.values)
    scale = np.concatenate([np.ones(count), sigma])[:kept]
    return np.asarray(inverse[:kept, :kept] * np.outer(scale, scale))


def _slopes_of_keys(engine: ReadoutEngine, fit: Fitted) -> Floats:
    """Change (q,) of R and C per unit of their coordinates."""
    slopes = []
    for candidate, value in zip(engine.candidates, fit.values, strict=True):
        step = 1e-6
        ends = [next(iter(candidate.parameters([value + sign * step]).values())) for sign in (1.0, -1.0)]
        slopes.append((ends[0] - ends[1]) / (2.0 * step))
    return np.array(slopes)
