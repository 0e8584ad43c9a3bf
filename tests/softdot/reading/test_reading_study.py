"""How far conditions may go."""

import csv
import json

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.cli import main
from softdot.reading.conditions import ReadingConditions
from softdot.reading.study import ReadingStudy, load_study, repeats_of, study_points, with_condition
from softdot.reading.study_limits import Readings, limits_of
from softdot.reading.study_task import StudyTask, kernel_hash, read_task, store_record, stored_record
from tests.softdot.reading.lines import READOUT


def found_limits(study, is_read):
    """The limits when a condition is read or not as a function says."""
    readings, wanted = Readings(), study_points(study)
    for _ in range(20):
        for one in wanted:
            for each in repeats_of(study, one):
                readings.records[each] = {"status": "read", "right": 100 if is_read(one) else 90, "of": 100}
        limits = dict(limits_of(study, readings))
        following = {name: one.following for name, one in limits.items() if one.following is not None}
        wanted = [with_condition(study.base, name, value) for name, value in following.items()]
        if not wanted:
            return limits
    raise AssertionError


def test_a_limit_is_bracketed_and_halved():
    """Read up to a noise of 7.3 mV, to an offset of 3.1 mm beyond the axis, and down to a height of 0.41 mm."""
    axes = {"noise_mV": (1.0, 5.0, 10.0), "offset_mm": (0.0, 0.5, 1.0), "height_mm": (0.5, 0.45, 0.35)}
    study = ReadingStudy(ReadingConditions(), axes, repeats=1)
    limits = found_limits(
        study, lambda one: one.noise_mV <= 7.3 and one.offset_mm <= 3.1 and (one.height_mm or 0.5) >= 0.41
    )
    for name, true, width in (("noise_mV", 7.3, 0.4), ("offset_mm", 3.1, 0.3), ("height_mm", 0.41, 0.007)):
        ends = sorted((limits[name].good, limits[name].bad))
        assert ends[0] <= true <= ends[1]
        assert ends[1] - ends[0] < width


def test_without_limit_the_last_value_is_told():
    study = ReadingStudy(ReadingConditions(), {"worn": (0.0, 0.5, 1.0)}, repeats=1)
    limit = found_limits(study, lambda _: True)["worn"]
    assert (limit.good, limit.bad) == (1.0, None)
    assert found_limits(study, lambda _: False)["worn"].good is None


def test_combined_axes_give_every_combination():
    study = ReadingStudy(ReadingConditions(), {"noise_mV": (1.0, 2.0), "yaw_deg": (0.0, 3.0, 6.0)}, combine=True)
    assert len(study_points(study)) == 6


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("repeat = 3", "repeat is not a key; did you mean 'repeats'"),
        ("[axes]\ncolour = [1]", "axes.colour is no condition with a number"),
        ("[axes]\nnoise_mV = [-1]", "--noise-mV = -1: must be from 0"),
        ('decoder = "oracle"', "'oracle' is none of model"),
        ("accuracy = 2.0", "accuracy = 2: must be at most 1"),
        ("[base]\nspeed = 3", "base.speed is not a key; did you mean"),
        ("[base]\nspeed_mm_per_s = 'fast'", "base.speed_mm_per_s = 'fast': must be a plain number"),
        ("base = 3", "base = 3: must be"),
        ("axes = 'noise_mV'", "axes = 'noise_mV': must be"),
        ("axes = { noise_mV = 'loud' }", "axes.noise_mV = 'loud': must be"),
        ("text = 5", "text = 5: must be"),
        ("combine = 'yes'", "combine = 'yes': must be true or false"),
        (
            "repeats = 100\n[axes]\nnoise_mV = [1, 2, 3]\nyaw_deg = [1, 2, 3]\ntremor_um = " + str(list(range(160))),
            "cells",
        ),
    ],
)
def test_bad_studies_are_one_sentence(kernel, tmp_path, text, said):
    path = tmp_path / "conditions.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=said):
        load_study(path, kernel, ReadingConditions())


@pytest.mark.press
def test_a_reading_is_kept_by_all_it_depends_on(kernel_folder, tmp_path):
    conditions = ReadingConditions()
    task = StudyTask(str(kernel_folder), READOUT.model_dump_json(), conditions, "dots", None, "model")
    other = StudyTask(str(kernel_folder), READOUT.model_dump_json(), conditions, "dot", None, "model")
    name = kernel_hash(kernel_folder)
    assert task.hash_key(name) != other.hash_key(name)
    record = read_task(task)
    assert (record["status"], record["right"], record["of"]) == ("read", 4, 4)
    store_record(tmp_path, task.hash_key(name), task, record)
    assert stored_record(tmp_path, task.hash_key(name))["text_read"] == "dots"
    assert stored_record(tmp_path, other.hash_key(name)) is None


@pytest.mark.press
def test_several_decoders_read_the_same_voltages(kernel_folder):
    """The first one is what decides; what each of them makes of the voltages is what it makes of them alone."""
    both, alone = (
        read_task(
            StudyTask(str(kernel_folder), READOUT.model_dump_json(), ReadingConditions(), "dots read", None, names)
        )
        for names in ("threshold,model", "model")
    )
    assert list(both["decoders"]) == ["threshold", "model"]
    assert both["decoders"]["model"] == alone["decoders"]["model"]
    assert (both["right"], both["of"]) == (both["decoders"]["threshold"]["right"], 9)


def test_where_no_dot_is_found_no_decoder_read_anything(kernel_folder):
    conditions = ReadingConditions(noise_mV=1e6)
    task = StudyTask(str(kernel_folder), READOUT.model_dump_json(), conditions, "dots", None, "model,threshold")
    record = read_task(task)
    assert (record["status"], record["of"]) == ("read", 4)
    assert [one["right"] for one in record["decoders"].values()] == [record["right"], record["right"]]


def test_what_is_refused_says_why(kernel_folder):
    conditions = ReadingConditions(depth_mm=0.9)
    task = StudyTask(str(kernel_folder), READOUT.model_dump_json(), conditions, "dots", None, "model")
    assert read_task(task)["reason"].startswith("--depth-mm = 0.9")


@pytest.mark.press
def test_a_study_gives_its_folder_and_goes_on(kernel_folder, tmp_path):
    path, out = tmp_path / "conditions.toml", tmp_path / "out"
    path.write_text('text = "soft dots"\nrepeats = 1\n[axes]\nnoise_mV = [1, 40]\n', "utf-8")
    command = ["read", "--kernel", str(kernel_folder), "--conditions", str(path), "-q", "-o", str(out)]
    assert main([*command, "--workers", "1"]) == 0
    told = json.loads((out / "reading_study.json").read_text("utf-8"))
    limit = told["limits"]["noise_mV"]
    assert 1.0 <= limit["read_up_to"] < limit["fails_at"] < 40.0
    count = len(list((out / "conditions").iterdir()))
    with (out / "reading_study.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(told["readings"]) == count
    assert np.isfinite([float(row["character_accuracy"]) for row in rows]).all()
    assert main([*command, "--workers", "1"]) == 0
    assert json.loads((out / "reading_study.json").read_text("utf-8")) == told
