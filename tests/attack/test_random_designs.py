"""300 random designs over every key and all mechanisms: a right result, one sentence, or a stop that is named.

Eight blocks, so that two workers share them; the counts of all are judged by whoever ends last.
"""

import json
import os
import re
import subprocess
import sys
from collections import Counter
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from foundation.errors import InputError
from mesh.types import MeshingError
from softdot.checks import design_warnings, result_warnings
from softdot.config.loading import config_from
from softdot.config.schema import Config
from softdot.json_files import plain
from softdot.summary import mesh_part, press_part
from solve.mechanisms import MECHANISMS
from solve.solution.newton import ROUNDED_TOLERANCE
from tests.attack.random_designs import design, keys_of_schema, keys_set
from tests.cases import for_each
from tests.softdot.press_checks import solved, wrong
from tests.softdot.toml_text import toml_text

DESIGNS, BLOCKS = 300, 8
EACH, MOST_STOPPED, MOST_REFUSED = 20, 0.12, 0.05
NAMED = re.compile(r"step \d+ of \d+.*(stopped at|has no equilibrium).*(x = |loses contact|prestretched)")
PLACED = re.compile(r"mesh\.accuracy_percent = \S+: a press to choose the sizes failed: .*x = ")
NOT_HERE = {
    "Waveform.file",
    "MeshOptions.file",
    "Dot.profile_csv",
}  # need a second file; see test_bad_configurations.py, test_mesh_files.py
MONOTONE = {"low-pass", "saturation", "mains-hum", "charge-leakage", "parasitic-capacitance", "pyroelectric-drift",
            "contact-electrification", "hyperelastic-stiffening", "elastic-sides", "dot-offset", "contact-gap",
            "crosstalk", "property-error"}  # fmt: skip


@pytest.fixture(scope="session")
def ledger(tmp_path_factory, worker_id):
    """A folder that all workers of this session share."""
    base = tmp_path_factory.getbasetemp()
    folder = (base if worker_id == "master" else base.parent) / "random-designs"
    folder.mkdir(exist_ok=True)
    return folder


def test_the_random_designs_set_every_key_of_the_configuration():
    drawn = set()
    for number in range(DESIGNS):
        with suppress(InputError):
            drawn |= keys_set(config_from(design(number)))
    assert keys_of_schema(Config) - drawn - NOT_HERE == set()


@pytest.mark.evidence
@for_each("block", range(BLOCKS))
def test_a_random_design_gives_a_right_result_or_says_in_one_sentence_why_not(block, ledger):
    seen = [outcome(number) for number in range(block, DESIGNS, BLOCKS)]
    assert [one for one in seen if one["faults"]] == []
    (ledger / f"{block}.partial").write_text(json.dumps(seen), "utf-8")
    os.replace(ledger / f"{block}.partial", ledger / f"{block}.json")
    if len(list(ledger.glob("*.json"))) == BLOCKS:
        judge([one for path in ledger.glob("*.json") for one in json.loads(path.read_text(encoding="utf-8"))])


def outcome(number: int) -> dict:
    """What became of one design: kind, what was said, what contradicts it."""
    tables = design(number)
    told = {"number": number, "mechanisms": [one["name"] for one in tables["mechanisms"]], "said": "", "faults": []}
    try:
        pressed = solved(tables)
    except InputError as error:
        return {**told, "kind": "refused", "said": str(error), "faults": _sentence(str(error))}
    except MeshingError as error:  # sizes for an accuracy are found by presses of their own, which may stop
        placed = [] if PLACED.search(str(error)) else ["the stop has no place"]
        return {**told, "kind": "stopped", "said": str(error), "faults": _sentence(str(error)) + placed}
    result = pressed.result
    if not result.converged:
        named = [] if NAMED.search(result.failure) else ["the stop has no place"]
        return {**told, "kind": "stopped", "said": result.failure, "faults": _sentence(result.failure) + named}
    faults = [*wrong(pressed), *_summary(pressed), *_charges(pressed), *_monotone(pressed, tables)]
    kind = "converged" if result.trace.contact_area_m2.max() > 0.0 else "untouched"
    return {**told, "kind": kind, "faults": [*faults, toml_text(tables)] if faults else []}


def _sentence(said):
    return [] if "\n" not in said and 10 < len(said) < 700 and "nan" not in said.split() else [f"no sentence: {said}"]


def _summary(pressed):
    """Every number of the summary is finite, none is missing, and the residual is within its bound."""
    model, result = pressed.model, pressed.result
    readout, channels = pressed.voltage or (None, None)
    numbers = plain({"mesh": mesh_part({}, result.unknowns), **press_part(model.readout, result, readout, channels)})
    json.dumps(numbers, allow_nan=False)
    warnings = [*design_warnings(model), *result_warnings(model, pressed.dot, result)]
    if any("nan" in text.split() or "\n" in text for text in warnings):
        yield f"a warning is no sentence: {warnings}"
    yield from (f"{where} is not a number" for where in _missing(numbers) if where not in ALLOWED_TO_MISS)
    if result.max_relative_residual > ROUNDED_TOLERANCE:
        yield f"a residual of {result.max_relative_residual:.1e}"
    if result.trace.contact_area_m2.max() == 0.0 and not any("never touched" in text for text in warnings):
        yield "the dot never touched, and nothing says so"


ALLOWED_TO_MISS = {"solver.failure", "sensitivity.least_detectable_indentation_um"}  # none: it never reaches the noise


def _missing(value, where=""):
    if value is None:
        yield where
    for key, one in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield from _missing(one, f"{where}.{key}".lstrip("."))


def _charges(pressed):
    """Two electrodes that cover the film share the area, and their charges the whole."""
    result = pressed.result
    if len(result.electrode_names) != 2:
        return
    area = result.capacitance_F / result.capacitance_F.sum()
    if not np.allclose(area, 0.5, atol=1e-9):
        yield f"the halves have {area} of the capacitance"


def _monotone(pressed, tables):
    """Elastic and frictionless, going down only: the force never falls."""
    press, segment = pressed.model.press, pressed.model.segment
    shape = press.waveform.shape if press.waveform is not None else "ramp"
    elastic = not pressed.result.follows_time and shape in ("ramp", "raised-cosine") and not press.path_xy_mm
    if not elastic or segment.bonds or any(one["name"] not in MONOTONE for one in tables["mechanisms"]):
        return
    if any(material.model == "linear" for material in pressed.model.materials.values()):
        return  # softens in compression
    force = pressed.result.trace.contact_force_N[:, 2]
    if (np.diff(force) < -1e-9 * max(force.max(), 1e-12)).any():
        yield f"the force falls on the way down: {force}"


def judge(seen):
    """What holds of all designs together."""
    kinds = Counter(one["kind"] for one in seen)
    per_mechanism = Counter(name for one in seen if one["kind"] == "converged" for name in one["mechanisms"])
    report = {"kinds": kinds, "mechanisms": dict(sorted(per_mechanism.items())),
              "stopped": [(one["number"], one["said"]) for one in seen if one["kind"] == "stopped"],
              "refused": [(one["number"], one["said"]) for one in seen if one["kind"] == "refused"]}  # fmt: skip
    print(json.dumps(report, indent=1), file=sys.stderr)
    if "SOFTDOT_ATTACK_REPORT" in os.environ:
        Path(os.environ["SOFTDOT_ATTACK_REPORT"]).write_text(json.dumps(report, indent=1), "utf-8")
    assert len(seen) == DESIGNS
    assert kinds["stopped"] <= MOST_STOPPED * DESIGNS
    assert kinds["refused"] + kinds["untouched"] <= MOST_REFUSED * DESIGNS
    assert {name: per_mechanism[name] for name in MECHANISMS if per_mechanism[name] < EACH} == {}


@pytest.mark.evidence
@pytest.mark.parametrize("number", [3, 28, 75])
def test_the_command_gives_a_random_design_its_folder(number, tmp_path):
    path, out = tmp_path / "design.toml", tmp_path / "out"
    path.write_text(toml_text(design(number)), "utf-8")
    ended = subprocess.run(
        [sys.executable, "-m", "softdot.cli", "run", str(path), "-o", str(out)], capture_output=True, encoding="utf-8"
    )
    assert ended.returncode in (0, 3), ended.stderr  # 3: stopped, and told where
    summary = json.loads((out / "summary.json").read_text("utf-8"), parse_constant=pytest.fail)
    assert summary["solver"]["converged"] == (ended.returncode == 0)
    assert bool(summary["solver"]["failure"]) == (ended.returncode == 3)
    assert (out / "report.html").is_file()
