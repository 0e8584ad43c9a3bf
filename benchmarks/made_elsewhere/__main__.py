"""Ten recordings of another code, with their truth: python -m benchmarks.made_elsewhere FOLDER [SEED [NAME...]].

Nothing of the project is imported: NGSolve presses a slice in plane strain, SciPy does the rest. FOLDER receives e01 to
e10, each with rig.toml and five CSV files, and truth.json. Rigs, laws and sizes stand in rigs.py and cases.py; the seed
draws paths, jitter, noise and the errors of gain, lag and zeros, which stay within 1.3 of the declared widths.

`multiple_of_visible` is the projected signal-to-noise ratio over 4, where gain, lag and zeros of each run (declared
widths), hum of a fifth of the noise, and an inter-code floor (0.5 % of force and voltage, 0.5 um of displacement zero)
may absorb the effect. `kind` is none, single, or ambiguous below the visible size, where `acceptable` lists what may be
said. Faint hum is in all of them. Takes five to ten minutes; names after the seed make these alone.
"""

import json
import sys
from dataclasses import asdict
from pathlib import Path as Place
from typing import Any

import numpy as np

from benchmarks.made_elsewhere.answers import pair
from benchmarks.made_elsewhere.cases import CASES, Hidden
from benchmarks.made_elsewhere.chain import columns, drawn
from benchmarks.made_elsewhere.drives import programme
from benchmarks.made_elsewhere.rigs import head, run_table
from benchmarks.made_elsewhere.visible import multiple

SEED = 20261201
HEADER = "time_s,displacement_mm,force_N,voltage_V\n"


def shortened(value: Any) -> Any:
    """Five digits."""
    if isinstance(value, dict):
        return {name: shortened(one) for name, one in value.items()}
    return float(f"{value:.5g}") if isinstance(value, float) else value


def made(place: Place, case: Hidden, rng: np.random.Generator) -> dict[str, Any]:
    """Write one recording; its entry in truth.json."""
    place.mkdir(parents=True, exist_ok=True)
    presses = programme(case.stated.depth, float(rng.uniform(0.02, 0.03)), rng)
    pairs = [pair(case.stated, case.true, press) for press in presses]
    force, volts = (max(float(np.abs(one.stated[k]).max()) for one in pairs) for k in range(2))
    noise, widths, errors = drawn(force, volts, case.loudness, rng)
    text = head(case.stated)
    for number, (press, signals) in enumerate(zip(presses, pairs, strict=True), 1):
        file = f"press-{number:02d}.csv"
        text += run_table(file, press.label, asdict(widths))
        table = columns(press, *signals.true, noise, errors, rng)
        rows = [f"{t:.3f},{d:.5f},{f:.4f},{v:.6g}" for t, d, f, v in zip(*table, strict=True)]
        (place / file).write_text(HEADER + "\n".join(rows) + "\n", encoding="utf-8")
    (place / "rig.toml").write_text(text, encoding="utf-8")
    one = {"mechanism": case.mechanism, "component": case.component, "parameters": case.parameters}
    return {
        "kind": "none" if case.mechanism is None else "ambiguous" if case.below else "single",
        "truths": [] if case.mechanism is None else [one],
        "acceptable": [case.mechanism, None] if case.below else None,
        "multiple_of_visible": multiple(pairs, noise, widths),
        "noise": asdict(noise),
        "nuisance": asdict(errors),
        "notes": case.notes,
        "rig": case.rig,
    }


def main(folder: Place, seed: int, only: list[str]) -> None:
    """Make all, or those that are named."""
    truth = {}
    for number, (name, case) in enumerate(CASES.items()):
        if only and name not in only:
            continue
        truth[name] = shortened(made(folder / name, case, np.random.default_rng([seed, number])))
        print(name, truth[name]["multiple_of_visible"], flush=True)
        (folder / "truth.json").write_text(json.dumps(truth, indent=1), encoding="utf-8")


if __name__ == "__main__":
    words = sys.argv[2:]
    main(Place(sys.argv[1]), int(words[0]) if words else SEED, words[1:])
