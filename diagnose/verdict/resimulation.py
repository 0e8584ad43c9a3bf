"""Check of a verdict by the full model: runs pressed again, without and with what was named, within a limit of time."""

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diagnose.findings import Findings, Fit
from diagnose.forward import Engine, Setting, Signals
from diagnose.next_press.parting import without_phase
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats
from foundation.progress import Report
from solve.mechanisms import Mechanism

TRAINING, HELD_OUT = "training", "held-out"


@dataclass(frozen=True)
class Resimulation:
    """One run by the full model, engine.

    role : of its presses, training, held-out, or both where each press was held out once. reduced_error : channel ->
    root mean square of fast less full model over that of the full model, named mechanisms on. before, after : channel
    -> the same of full model with its fitted nuisances less recording, over the recording. signals : with the
    mechanisms and nuisances, (t,) each.
    """

    run: str
    role: str
    engine: str
    reduced_error: Mapping[str, float]
    before: Mapping[str, float]
    after: Mapping[str, float]
    signals: Signals

    @property
    def before_all(self) -> float:
        """Error of the full model without mechanisms over all channels, each counting alike, as in a Fit."""
        return _rms_of_channels(self.before)

    @property
    def after_all(self) -> float:
        """Error of the full model with what was named over all channels."""
        return _rms_of_channels(self.after)


def _rms_of_channels(errors: Mapping[str, float]) -> float:
    return float(np.sqrt(np.mean(np.square(list(errors.values()))))) if errors else 0.0


class OutOfTimeError(Exception):
    """Raised once the limit of time is over."""


def resimulate(
    recording: Recording, engine: Engine, findings: Findings, report: Report, limit_s: float | None
) -> Iterator[Resimulation]:
    """Resimulations of the shortest run with training presses, the shortest with held-out ones, then of all others.

    The others only without a limit, nothing where nothing is named. NoEquilibriumError; OutOfTimeError once the limit
    is over.
    """
    if findings.best is None or findings.improved is None:
        return
    timed = _time_limited(report, limit_s)
    for number, role in _runs_and_roles(recording, findings)[: 2 if limit_s is not None else None]:
        yield _resimulate_run(recording, number, role, engine, findings, timed)


def _runs_and_roles(recording: Recording, findings: Findings) -> list[tuple[int, str]]:
    """Runs and their roles: the shortest with training presses, the shortest other one with held-out ones, the rest."""
    runs = recording.runs
    shortest = sorted(range(len(runs)), key=lambda number: len(runs[number].time_s))
    training, held_out = (
        [number for number in shortest if _has_press_of(fit, runs[number], runs)]
        for fit in (findings.train, findings.held_out)
    )
    first = next((number for number in training if held_out != [number]), shortest[0])
    second = [number for number in held_out if number != first][:1]
    others = [number for number in shortest if number not in (first, *second)]
    return [
        (number, " and ".join(role for role, its in ((TRAINING, training), (HELD_OUT, held_out)) if number in its))
        for number in (first, *second, *others)
    ]


def _has_press_of(fit: Fit | None, run: Run, runs: Sequence[Run]) -> bool:
    """Whether a press of the fit belongs to a run: names of presses begin with the label of their run."""
    if fit is None:
        return False
    labels = sorted((each.label for each in runs), key=len, reverse=True)
    owners = [next((label for label in labels if press.startswith(label)), None) for press in fit.presses]
    return run.label in owners


def _resimulate_run(
    recording: Recording, number: int, role: str, engine: Engine, findings: Findings, report: Report
) -> Resimulation:
    """Resimulation of one run, without and with the named mechanisms. NoEquilibriumError."""
    run, settings = recording.runs[number], without_phase(findings.best.settings if findings.best else ())
    full = engine.solve(number, [setting_mechanism(setting) for setting in settings], report)
    without = engine.solve(number, [], report)
    fast, fast_without = engine.predict(number, settings), engine.predict(number, ())
    improved, baseline = (findings.improved or {})[run.label], findings.baseline[run.label]
    channels = [name for name in run.answers if name in full]
    # nuisances were fitted to the fast model; what the full one differs by is added to the fitted signals
    after = {name: improved[name] + full[name] - fast[name] for name in channels}
    before = {name: baseline[name] + without[name] - fast_without[name] for name in channels}
    return Resimulation(
        run=run.label,
        role=role,
        engine=engine.name,
        reduced_error={name: relative_error(fast[name], full[name]) for name in channels},
        before={name: _misfit(run, name, before[name]) for name in channels},
        after={name: _misfit(run, name, after[name]) for name in channels},
        signals=after,
    )


def setting_mechanism(setting: Setting) -> Mechanism:
    """Mechanism of a setting as a configuration has it. ValueError for values beyond its bounds."""
    return setting.candidate.as_mechanism(setting.values)


def relative_error(values: Floats, reference: Floats) -> float:
    """Root mean square of the difference over that of the reference; 0 for a reference of zeros."""
    size = float(np.sqrt(np.mean(reference**2)))
    return float(np.sqrt(np.mean((values - reference) ** 2))) / size if size else 0.0


def _misfit(run: Run, channel: str, values: Floats) -> float:
    used = run.usable(channel)
    return relative_error(values[used], run.channels[channel][used])


def _time_limited(report: Report, limit_s: float | None) -> Report:
    """Report that passes on what it is told, and raises OutOfTimeError once the time is over."""
    end = time.monotonic() + limit_s if limit_s is not None else float("inf")

    def report_in_time(what: str, done: int, count: int) -> None:
        if time.monotonic() > end:
            raise OutOfTimeError(f"checking with the full 3D model was stopped after {limit_s:g} s")
        report(what, done, count)

    return report_in_time
