"""The folder of a diagnosis: from recordings to a verdict; everything appears at once or not at all."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from diagnose.engines.some_runs import other_runs, select_runs
from diagnose.findings import Findings
from diagnose.forward import Engine
from diagnose.next_press.choose import MOST_PRESSES, NextPress, next_presses
from diagnose.noise.estimate import noise_models
from diagnose.other_units import other_units
from diagnose.signals.reading import thin_recording
from diagnose.signals.recording import Recording
from diagnose.signals.run_checks import refuse_slow_sampling
from diagnose.verdict.content import FORMAT, verdict, waveform_file
from diagnose.verdict.resimulation import OutOfTimeError, Resimulation, resimulate
from diagnose.verdict.words import sentences
from foundation.cache import check_cache_folder
from foundation.errors import InputError
from foundation.executor import Executor
from foundation.progress import Report
from softdot.config.rig import Rig, load_rig
from softdot.diagnosis.engine import engine_for, without_mechanisms
from softdot.executors import executor_for
from softdot.json_files import plain, write_json
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress
from solve.solution.errors import NoEquilibriumError

DIAGNOSIS = Product(
    FORMAT,
    "verdict.json",
    frozenset({"verdict.json", "report.html", "plots", "improved.toml", *map(waveform_file, range(MOST_PRESSES))}),
)
UNCHECKED_SENTENCE = "The result was not checked with the full 3D model, because --fast-model-only was given."
FULL_MODEL_S = 240.0  # for presses by the full model, of the ten minutes that a first diagnosis may take


@dataclass(frozen=True)
class Options:
    """The options of a diagnosis.

    full_model_s : seconds for runs by the full model; None: for every run, however long it takes; 0: for none. seed :
    of everything random; None: that of rig.toml. without : mechanisms that are no candidates. hold_out : parts of
    labels; runs whose label has one of them only score the result of the others.
    """

    full_model_s: float | None = FULL_MODEL_S
    seed: int | None = None
    without: tuple[str, ...] = ()
    hold_out: tuple[str, ...] = ()


@dataclass
class FullModelRuns:
    """Runs pressed again by the full model. failure : reason where one has no equilibrium. warnings : of missing
    runs.
    """

    runs: list[Resimulation] = field(default_factory=list)
    failure: str | None = None
    warnings: list[str] = field(default_factory=list)


def run_diagnosis(
    folder: Path,
    out: Path,
    options: Options | None = None,
    progress: Progress | None = None,
    scheduler: str | None = None,
) -> dict[str, Any]:
    """Diagnose a recording into the folder out and return the content of verdict.json.

    Presses are done by processes of this computer, or on the Dask cluster of a scheduler (tcp://HOST:PORT).
    InputError before any work for what cannot be read or written; NoEquilibriumError when the baseline has none. In
    both cases nothing is written. A named mechanism that the full model cannot press is told in fit.failure.
    """
    options, progress = options or Options(), progress or Logged()
    check_cache_folder()
    rig = load_rig(folder)
    _refuse_what_sampling_misses(rig)
    rig = replace(rig, recording=thin_recording(rig.recording))
    held_out_runs(rig.recording, options.hold_out)
    noise_models(rig.recording)  # refuses a channel without known noise before any press
    with executor_for(scheduler) as executor, staged_folder(out, DIAGNOSIS) as staged:
        summary: dict[str, Any] = plain(_fill(rig, options, progress, staged, executor))
        write_json(staged / DIAGNOSIS.summary, summary)
    return summary


def _refuse_what_sampling_misses(rig: Rig) -> None:
    """InputError for a run that is too slow for a mechanism of rig.toml that acts up to a frequency."""
    asked = rig.config.mechanisms if rig.config is not None else ()
    for mechanism, run in product(asked, rig.recording.runs):
        if mechanism.traits.acts_up_to:
            frequency_Hz = getattr(mechanism.values(), mechanism.traits.acts_up_to)
            refuse_slow_sampling(run, frequency_Hz, mechanism.name)


def _fill(rig: Rig, options: Options, progress: Progress, folder: Path, executor: Executor) -> dict[str, Any]:
    """Make everything but verdict.json, and return its content."""
    from diagnose.inference.diagnose import diagnose
    from diagnose.inference.held_runs import diagnose_and_score
    from softdot.diagnosis.report import write_evidence
    from softdot.version import installed_version

    report = _report_to(progress)
    seed = rig.bench.seed if options.seed is None else options.seed
    progress.stage("model")
    engine = without_mechanisms(engine_for(rig, report, executor), options.without)
    progress.stage("compare")
    held = held_out_runs(rig.recording, options.hold_out)
    if held:
        findings = diagnose_and_score(rig.recording, engine, held, seed, report, progress.note)
    else:
        findings = diagnose(rig.recording, engine, seed, report, progress.note)
    named_on = select_runs(rig.recording, other_runs(rig.recording, held))
    progress.stage("check with the full model")
    proof = _full_model_runs(rig, engine, findings, report, options.full_model_s)
    progress.stage("plan")
    following = next_presses(rig.recording, engine, findings)
    progress.stage("write")
    told = sentences(named_on, findings, following, proof.runs)
    units = other_units(rig.recording, engine)
    warnings = [*rig.recording.warnings, *units, *engine.shortfalls, *proof.warnings]
    summary = verdict(findings, [str(sentence) for sentence in told], following, proof.runs, warnings)
    summary["fit"]["failure"] = proof.failure
    summary |= {"softdot_version": installed_version(), "seed": seed}
    _write_files(rig, engine, findings, following, folder)
    write_evidence(rig.recording, findings, told, plain(summary), proof.runs, folder)
    return summary


def held_out_runs(recording: Recording, parts: Sequence[str]) -> list[int]:
    """Numbers of the runs whose label contains one of these parts. InputError for a part that none has, or all."""
    labels = [run.label for run in recording.runs]
    for part in parts:
        if not any(part in label for label in labels):
            raise InputError(f"--hold-out '{part}': no run has it in its label; they are {', '.join(labels)}")
    held = [number for number, label in enumerate(labels) if any(part in label for part in parts)]
    if len(held) == len(labels):
        raise InputError(f"--hold-out '{parts[-1]}': holds out every run; at least one has to stay")
    return held


def _full_model_runs(
    rig: Rig, engine: Engine, findings: Findings, report: Report, limit_s: float | None
) -> FullModelRuns:
    """Press as many runs by the full model as the time allows."""
    proof = FullModelRuns()
    if limit_s == 0.0:
        proof.warnings += [UNCHECKED_SENTENCE] if findings.best is not None else []
        return proof
    try:
        for run in resimulate(rig.recording, engine, findings, report, limit_s):
            proof.runs.append(run)  # those before an error are kept
    except OutOfTimeError as error:
        proof.warnings.append(f"{error}; --all-presses checks every run")
    except NoEquilibriumError as error:
        proof.failure = str(error)
    return proof


def _write_files(rig: Rig, engine: Engine, findings: Findings, following: Sequence[NextPress], folder: Path) -> None:
    from softdot.diagnosis.improved import improved_text

    improved = improved_text(rig, engine, findings)
    if improved is not None:
        (folder / "improved.toml").write_text(improved, "utf-8")
    for number, press in enumerate(following):
        columns = np.column_stack([press.run.time_s, press.run.drive_values])
        header = f"time_s,{press.run.drive}"
        np.savetxt(folder / waveform_file(number), columns, "%.9g", ",", header=header, comments="")


def _report_to(progress: Progress) -> Report:
    """A function that passes the progress of long work on."""

    def report(what: str, done: int, count: int) -> None:
        progress.step(done, count, what)

    return report
