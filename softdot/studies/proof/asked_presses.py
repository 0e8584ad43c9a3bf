"""The presses that a verdict asks for, made in the hidden world, and whether the longer recording settles the name."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.cases import Case, press_again
from softdot.studies.proof.world.reality import Signals
from softdot.studies.proof.world.rigs import BENCHES
from softdot.studies.proof.world.runs import Run, traced_run

SHAPE = frozenset({"speed_factor", "hold_s", "displacement_mm", "cycles"})
"""Changes that the waveform holds already."""
RESISTOR, CAPACITANCE, RECORDS = "input_resistance_MOhm", "input_capacitance_pF", "records"


def asked_run(bench: Bench, experiment: Mapping[str, Any], wave: str) -> Run | None:
    """A run that a verdict asks for, its waveform as CSV text; None where this world cannot change what is asked."""
    changes = experiment["changes"]
    if not changes.keys() <= SHAPE | {RESISTOR, CAPACITANCE, RECORDS}:
        return None
    like = next(run for run in bench.runs if run.label == experiment["as_in"])
    time_s, path_mm = np.loadtxt(wave.splitlines(), delimiter=",", skiprows=1, unpack=True)
    added_pF = changes.get(CAPACITANCE, bench.amplifier.capacitance_pF) - bench.amplifier.capacitance_pF
    resistance = changes.get(RESISTOR, like.resistance_MOhm)
    label = f"as asked for, {experiment['waveform'].removesuffix('.csv')}"
    return traced_run(label, time_s, path_mm, resistance, added_pF, like.place_mm, RECORDS in changes)


def with_asked(
    case: Case, runs: Sequence[Signals], experiment: Mapping[str, Any], waves: Mapping[str, str]
) -> tuple[Bench, list[Signals]] | None:
    """Bench and recording with all runs of next_experiment that can be made here; None without any.

    waves : file -> text of each waveform.
    """
    bench, signals = BENCHES[case.bench], list(runs)
    for number, asked in enumerate([experiment, *experiment["then"]]):
        run = asked_run(BENCHES[case.bench], asked, waves[asked["waveform"]])
        if run is None:
            continue
        try:
            more = press_again(case, run, number)
        except (RuntimeError, FloatingPointError):  # no equilibrium that deep
            continue
        bench, signals = replace(bench, runs=(*bench.runs, run)), [*signals, more]
    return (bench, signals) if len(signals) > len(runs) else None
