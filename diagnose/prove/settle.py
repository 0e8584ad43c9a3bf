"""The press that a verdict asks for, made in the hidden world, and whether the longer recording settles the name."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from diagnose.prove.world.bench import BENCHES, Bench
from diagnose.prove.world.cases import Case, pressed_again
from diagnose.prove.world.programme import Run, traced
from diagnose.prove.world.reality import Signals

SHAPE = frozenset({"speed_factor", "hold_s", "displacement_mm", "cycles"})
"""Changes that the waveform holds already."""
RESISTOR, CAPACITANCE = "input_resistance_MOhm", "input_capacitance_pF"


def asked_run(bench: Bench, experiment: Mapping[str, Any], wave: str) -> Run | None:
    """The run of next_experiment, its waveform as CSV text; None where this world cannot change what is asked."""
    changes = experiment["changes"]
    if not changes.keys() <= SHAPE | {RESISTOR, CAPACITANCE}:
        return None
    like = next(run for run in bench.runs if run.label == experiment["as_in"])
    time_s, path_mm = np.loadtxt(wave.splitlines(), delimiter=",", skiprows=1, unpack=True)
    added_pF = changes.get(CAPACITANCE, bench.amplifier.capacitance_pF) - bench.amplifier.capacitance_pF
    return traced("as asked for", time_s, path_mm, changes.get(RESISTOR, like.resistance_MOhm), added_pF)


def with_asked(
    case: Case, runs: Sequence[Signals], experiment: Mapping[str, Any], wave: str
) -> tuple[Bench, list[Signals]] | None:
    """Bench and recording with one more run; None where it cannot be made here."""
    bench = BENCHES[case.bench]
    run = asked_run(bench, experiment, wave)
    if run is None:
        return None
    try:
        more = pressed_again(case, run)
    except (RuntimeError, FloatingPointError):  # no equilibrium that deep
        return None
    return replace(bench, runs=(*bench.runs, run)), [*runs, more]
