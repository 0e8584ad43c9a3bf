"""Stated against true errors of the read-out of random designs:

    python -m benchmarks.course_in_time JSONL [FIRST COUNT]

The true error is that against the same press with twenty times the load steps, the largest of the course, of the
largest value. Designs are drawn anew from their number, plane-strain slices on coarse meshes; each that is done is a
line of the file, and those that the file has are not pressed again. What is stated was chosen on designs from 1000
on, and its factor after 0 to 57, so that only 58 to 199 are unseen.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.timing import file_argument
from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.case import Case
from solve.readout.course import PressCourse
from solve.result import PressResult
from solve.waveform import Waveform

TIMES_AS_MANY = 20
MEDIA = ("vnr", "vnr-soft", "ecoflex-00-30", "ecoflex-00-50", "dragon-skin-30", "rtv615")
MESH = {"mesher": "layered", "element_size_mm": 2.0, "film_element_size_mm": 2.0}
SHAPES = ("ramp", "half-sine", "raised-cosine", "trapezoid", "trapezoid")


class Draw:
    """Random choices of one design, with few digits."""

    def __init__(self, number: int) -> None:
        self.random = np.random.default_rng([2026, number])

    def between(self, low: float, high: float) -> float:
        """From low to high."""
        return float(f"{self.random.uniform(low, high):.3g}")

    def log(self, low: float, high: float) -> float:
        """Positive, its logarithm even from low to high."""
        return float(f"{np.exp(self.random.uniform(np.log(low), np.log(high))):.3g}")

    def among(self, *things: Any) -> Any:
        """One of them."""
        return things[int(self.random.integers(len(things)))]

    def perhaps(self, share: float) -> bool:
        """True in this share of cases."""
        return bool(self.random.random() < share)


def design(number: int) -> dict[str, Any]:
    """Tables of a random design."""
    draw = Draw(number)
    segment, dot = _segment(draw), _dot(draw)
    rise_s = draw.log(1e-3, 100.0)
    tables = {
        "segment": segment,
        "dot": dot,
        "press": _press(draw, segment, dot, rise_s),
        "mesh": {**MESH, "contact_element_size_mm": draw.between(0.25, 0.5)},
        "mechanisms": _mechanisms(draw, rise_s),
    }
    tables["press"]["load_steps"] = int(draw.random.integers(2, 6 if tables["mechanisms"] else 13))
    if dot["shape"] == "plate":
        segment["boundary"] = "free"  # it would meet a held rim
    return {**tables, "readout": _readout(draw, rise_s)} if draw.perhaps(0.9) else tables


def _segment(draw: Draw) -> dict[str, Any]:
    length = draw.between(2.0, 4.0)
    table = {
        "section": "plane-strain",
        "length_mm": length,
        "width_mm": draw.between(2.0, 4.0),
        "boundary": draw.among("clamped", "clamped", "free"),
        "medium1": {"thickness_mm": draw.between(0.3, 1.2), "material": draw.among(*MEDIA)},
        "medium2": {"thickness_mm": draw.between(0.8, 2.5), "material": draw.among(*MEDIA)},
        "film": {"thickness_um": draw.among(28.0, 52.0, 110.0)},
    }
    if draw.perhaps(0.5):
        table["effector"] = {"height_mm": draw.between(0.4, 1.0), "material": draw.among(*MEDIA)}
    if draw.perhaps(0.3):
        half = {"size_mm": [round(0.45 * length, 3), table["width_mm"]]}
        table["film"]["electrodes"] = [
            {"name": name, "center_mm": [round(side * 0.25 * length, 3), 0.0], **half}
            for name, side in (("left", -1), ("right", 1))
        ]
    return table


def _dot(draw: Draw) -> dict[str, Any]:
    offset = {"offset_mm": [draw.between(0.0, 0.4), 0.0], "gap_mm": draw.among(0.0, 0.0, 0.0, draw.log(0.01, 0.1))}
    if draw.perhaps(0.15):
        return {"shape": "plate", **offset, "tilt_deg": [0.0, draw.between(1.0, 4.0)]}
    return {"shape": "ridge", "radius_mm": draw.between(0.5, 2.0), **offset}


def _press(draw: Draw, segment: dict[str, Any], dot: dict[str, Any], rise_s: float) -> dict[str, Any]:
    soft_mm = segment["medium1"]["thickness_mm"] + segment["medium2"]["thickness_mm"]
    table: dict[str, Any] = {}
    if draw.perhaps(0.8):
        table["indentation_mm"] = round(dot["gap_mm"] + draw.log(0.03, 0.15) * soft_mm, 4)
    else:
        table["force_N"] = draw.log(0.05, 0.5)
    times = {"rise_s": rise_s, "hold_s": rise_s * draw.log(0.1, 10.0), "fall_s": rise_s * draw.log(0.3, 3.0)}
    return {**table, "waveform": Waveform.override_keys({"shape": draw.among(*SHAPES), **times}, {})}


def _readout(draw: Draw, rise_s: float) -> dict[str, Any]:
    table: dict[str, Any] = {}
    if draw.perhaps(0.65):
        table |= {"input_resistance_MOhm": draw.log(0.1, 1e5), "input_capacitance_pF": draw.log(1.0, 1000.0)}
    else:
        table |= {"mode": "charge", "feedback_pF": draw.log(10.0, 1e4), "feedback_MOhm": draw.log(1.0, 1e4)}
    if draw.perhaps(0.3):
        table["low_pass_Hz"] = draw.log(0.3, 100.0) / rise_s
    if draw.perhaps(0.3):
        table["high_pass_Hz"] = draw.log(0.001, 0.3) / rise_s
    if draw.perhaps(0.2):
        table["limit_V"] = draw.log(0.01, 10.0)
    return table


def _mechanisms(draw: Draw, rise_s: float) -> list[dict[str, Any]]:
    made = []
    if draw.perhaps(0.35):
        series = {
            "relative_moduli": [draw.between(0.05, 0.4)],
            "relaxation_times_s": [rise_s * draw.log(0.1, 10.0)],
        }
        made.append(("viscoelasticity", draw.among("medium1", "medium2"), series))
    if draw.perhaps(0.1):
        softening = {"loss_ratio": draw.between(0.1, 0.5), "energy_MPa": draw.log(1e-4, 1e-2), "beta": 0.2}
        made.append(("stress-softening", "medium2", softening))
    if draw.perhaps(0.1):
        heat = {"temperature_step_K": draw.between(0.01, 0.2), "time_constant_s": rise_s * draw.log(0.3, 10.0)}
        made.append(("pyroelectric-drift", "film", heat))
    if draw.perhaps(0.1):
        made.append(("rig-compliance", "rig", {"compliance_mm_per_N": draw.log(1e-3, 0.1)}))
    if draw.perhaps(0.1):
        made.append(("friction", "dot", {"coefficient": draw.between(0.1, 0.8)}))
    return [{"name": name, "component": where, "parameters": values} for name, where, values in made]


def pressed(case: Case, times_as_many: int = 1) -> PressResult:
    """The press of a case with so many times its load steps. InputError, MeshingError."""
    press = case.config.press
    steps = press.model_copy(update={"load_steps": times_as_many * press.load_steps})
    return Case(case.config.model_copy(update={"press": steps})).solve(tet_mesh=case.solved_mesh)


def true_error(own: PressCourse, fine: PressCourse) -> float:
    """How far what is read of each channel and of all is from that of a fine press, of its largest value."""
    return max(_off(own.time_s, one, fine.time_s, other) for one, other in zip(_read(own), _read(fine), strict=True))


def _read(along: PressCourse) -> list[Floats]:
    if along.together_V is None or along.channels_V is None:
        return list(along.voltage_V.T)
    return [*along.channels_V.T, along.together_V]


def _off(time_s: Floats, own: Floats, fine_s: Floats, fine: Floats) -> float:
    times = np.union1d(time_s, fine_s)
    off = np.interp(times, time_s, own) - np.interp(times, fine_s, fine)
    return float(np.abs(off).max() / max(np.abs(own).max(), 1e-300))


def compared(number: int) -> dict[str, Any]:
    """One line of the file."""
    start = time.process_time()
    try:
        case = Case(**design(number))
        results = [pressed(case, times) for times in (1, TIMES_AS_MANY)]
    except InputError as error:  # parts that meet, for instance
        return {"design": number, "stopped": str(error)}
    row = {"design": number, "load_steps": case.config.press.load_steps, "follows_time": case.model.follows_time}
    failures = [result.failure for result in results if result.failure is not None]
    if failures:
        return {**row, "stopped": failures[0]}
    own, fine = (case.course(result) for result in results)
    return {
        **row,
        "stated_percent": own.readout_error_percent,
        "true_percent": 100.0 * true_error(own, fine),
        "processor_s": round(time.process_time() - start, 1),
    }


def counted(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """In how many designs the true error is within the stated one, and how many times that is too large."""
    told = [row for row in rows if "true_percent" in row]
    stated, true = np.array([(row["stated_percent"], row["true_percent"]) for row in told]).T
    worst = told[int(np.argmax(true / stated))]
    return {
        "designs": len(told),
        "stopped": len(rows) - len(told),
        "within what is stated, %": round(100.0 * float(np.mean(true <= stated)), 1),
        "median of stated over true": round(float(np.median(stated / true)), 2),
        "worst": worst,
    }


def main(path: Path, first: int = 0, count: int = 200) -> None:
    """Press what the file has not."""
    rows = [json.loads(line) for line in path.read_text("utf-8").splitlines()] if path.exists() else []
    done = {row["design"] for row in rows}
    with path.open("a", encoding="utf-8") as file:
        for number in sorted(set(range(first, first + count)) - done):
            rows.append(compared(number))
            file.write(json.dumps(rows[-1]) + "\n")
            file.flush()
    for name, value in counted([row for row in rows if first <= row["design"] < first + count]).items():
        print(f"{name}: {value}")


if __name__ == "__main__":
    main(file_argument(), *(int(one) for one in sys.argv[2:4]))
