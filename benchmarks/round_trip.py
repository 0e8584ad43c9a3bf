"""improved.toml of every mechanism, diagnosed again on the recording from which it was made.

    python -m benchmarks.round_trip OUT.json [MECHANISM…]

A slice is pressed twice (other depths, speeds and holds) behind an amplifier. Each candidate in turn acts, its strength
well within its bounds; the signals get 1 % of white noise; the improved.toml that a verdict with this one name would
write becomes the belief, and whether the recording agrees with it is counted. Rows that the file has are not measured
again.
"""

import json
import sys
import tempfile
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import tomlkit

from benchmarks.timing import file_argument
from diagnose.engines.segment.engine import SegmentEngine
from diagnose.forward import Candidate, Setting
from diagnose.inference.diagnose import diagnose
from diagnose.signals.recording import Recording, Run, with_earlier_drives
from diagnose.verdict.names import short_name
from softdot.config.loading import config_from
from softdot.config.rig import RIG_FILE, Bench, Rig
from softdot.diagnosis.engine import engine_for
from softdot.diagnosis.improved import improved_text
from solve.model import Readout

READOUT = {"input_resistance_MOhm": 1000.0, "input_capacitance_pF": 100.0}
TABLES: dict[str, Any] = {
    "segment": {
        "section": "plane-strain",
        "effector": {"height_mm": 1.0},
        "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 28.0},
        "medium2": {"thickness_mm": 2.0},
    },
    "dot": {"shape": "ridge"},
    "materials": {"vnr": {"model": "neo-hookean", "youngs_modulus_MPa": 5.0}},
    "mesh": {"element_size_mm": 0.6, "contact_element_size_mm": 0.2},
    "readout": READOUT,
}
NOISE, SHARE, PATCH = 0.01, 0.7, 0.6
"""Noise in parts of the largest signal, strength in parts of the largest start of a fit, a delaminated patch."""


def silent(*_: object) -> None:
    """No progress."""


def run(label: str, depth_mm: float, rise_s: float, hold_s: float) -> Run:
    """Touch, press, hold, release; answers are zero."""
    time = np.arange(0.0, 1.0 + 2.0 * rise_s + hold_s, 0.002)
    ends = np.cumsum([0.3, rise_s, hold_s, rise_s])
    reach = rise_s * 0.05 / depth_mm
    drive = np.interp(time, [ends[0] - reach, ends[1], ends[2], ends[3] + reach], [-0.05, depth_mm, depth_mm, -0.05])
    channels = {"displacement_mm": drive, "force_N": np.zeros(len(time)), "voltage_V": np.zeros(len(time))}
    there = {name: np.ones(len(time), bool) for name in channels}
    nowhere = {name: np.zeros(len(time), bool) for name in channels}
    return Run(label, f"{label}.csv", time, "displacement_mm", channels, there, nowhere, readout=Readout(**READOUT))


RUNS = tuple(with_earlier_drives([run("deep", 0.25, 0.2, 0.4), replace(run("shallow", 0.15, 0.1, 0.6), virgin=False)]))


def rig_of(folder: Path, tables: dict[str, Any], recording: Recording) -> Rig:
    """The rig that these tables describe, with a recording."""
    (folder / RIG_FILE).write_text(tomlkit.dumps(tables), "utf-8")
    return Rig(folder, tables, config_from(tables), Bench(), recording)


def strength(candidate: Candidate) -> Setting:
    """Well within the bounds."""
    values = [SHARE * coordinate.starts[-1] for coordinate in candidate.coordinates]
    if candidate.mechanism == "delamination":  # one of two that share the same place
        values = [values[0], 0.0] if values[0] else [0.0, PATCH]
    return Setting(candidate, tuple(values))


@dataclass(frozen=True)
class Trip:
    """effect, error : of the mechanism, and of what improved.toml gives, in parts of the largest signal."""

    name: str
    values: list[float]
    effect: float
    error: float
    agrees: bool
    p_value: float


def trip(believed: SegmentEngine, folder: Path, candidate: Candidate) -> Trip:
    """One mechanism there and back."""
    found = strength(candidate)
    believed.prepare([candidate], silent)
    believed.refine([found], silent)
    plain, signals = ([believed.predict(n, on) for n in range(len(RUNS))] for on in ([], [found]))
    recording = Recording(tuple(noisy(run, own, plain) for run, own in zip(RUNS, signals, strict=True)))
    rig = rig_of(folder, TABLES, recording)
    text = improved_text(rig, believed, SimpleNamespace(best=SimpleNamespace(settings=(found,))))  # type: ignore[arg-type]
    tables = tomllib.loads(text or "")
    del tables["press"]
    again = engine_for(rig_of(folder, tables, recording), silent)
    stated = [again.predict(n, []) for n in range(len(RUNS))]
    findings = diagnose(recording, again.with_candidates(()), 1, silent)
    return Trip(
        short_name([candidate]),
        [float(value) for value in found.values],
        largest(signals, plain, plain),
        largest(stated, signals, plain),
        not findings.mismatch,
        findings.detection.p_value,
    )


def largest(one: Sequence[Any], other: Sequence[Any], plain: Sequence[Any]) -> float:
    """The largest difference of any signal, in parts of the largest value of that signal."""
    return max(
        float(np.abs(a[name] - b[name]).max() / np.abs(p[name]).max())
        for a, b, p in zip(one, other, plain, strict=True)
        for name in p
    )


def noisy(run: Run, signals: Any, plain: Sequence[Any]) -> Run:
    """The run with these signals and noise."""
    random = np.random.default_rng(len(run.label))
    added = {
        name: signal + NOISE * max(np.abs(one[name]).max() for one in plain) * random.standard_normal(len(signal))
        for name, signal in signals.items()
    }
    return replace(run, channels={**run.channels, **added})


def main(out: Path, only: Sequence[str]) -> None:
    """Every candidate that has no row yet."""
    rows = json.loads(out.read_text("utf-8")) if out.exists() else []
    folder = Path(tempfile.mkdtemp())
    believed = engine_for(rig_of(folder, TABLES, Recording(RUNS)), silent)
    for candidate in believed.candidates:
        done = any(row["name"] == short_name([candidate]) for row in rows)
        if done or (only and candidate.mechanism not in only):
            continue
        rows.append(vars(trip(believed, folder, candidate)))
        out.write_text(json.dumps(rows, indent=1), "utf-8")
        print(rows[-1], flush=True)


if __name__ == "__main__":
    main(file_argument(), sys.argv[2:])
