"""A drive of the wrong sign, zero or size is told in one sentence, before noise is asked for."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from diagnose.other_units import other_units
from foundation.errors import InputError
from softdot.config.rig import load_rig
from tests.diagnose.rigs import COUPON, HEAD, RUN, SEGMENT, samples, write_rig


def pressed(shift_mm=0.0, factor=1.0, turn=1.0, drift_N=0.0):
    """A press with a force like that of a sphere."""
    found = samples()
    depth = found["displacement_mm"]
    force = np.clip(depth, 0.0, None) ** 1.5 + 1e-4 * np.random.default_rng(1).standard_normal(len(depth))
    force += np.linspace(0.0, drift_N, len(force))
    return {**found, "displacement_mm": factor * depth + shift_mm, "force_N": turn * force}


BAD = {
    "sign of the displacement": (
        pressed(factor=-1.0),
        r"displacement_mm: runs against force_N \(correlation -0\.\d+\)",
    ),
    "sign of the force": (pressed(turn=-1.0), r"displacement_mm: runs against force_N"),
    "both signs": (pressed(factor=-1.0, turn=-1.0), r"force_N: goes down to -0\.16\d N and up to 0"),
    "another zero": (pressed(shift_mm=12.3), r"reaches 12\.6 mm, the segment is \d"),
    "a zero within the stack": (pressed(shift_mm=0.6), r"is 0\.4 mm where force_N has not begun to rise"),
    "nanoseconds": (
        pressed() | {"time_s": 1e-9 * samples()["time_s"]},
        "time_s: displacement_mm goes 0.5 mm in .* s by it, which is no press",
    ),
    "micrometres": (pressed(factor=1e3), r"its zero or its unit is off"),
}


@pytest.mark.parametrize(("columns", "said"), BAD.values(), ids=BAD)
def test_a_drive_that_cannot_be_is_refused(columns, said, tmp_path):
    folder = write_rig(tmp_path / "rig", press=columns)
    with pytest.raises(InputError, match=rf"^recording '.*press.csv', column .*{said}"):
        load_rig(folder)


def test_a_good_drive_and_a_preload_are_read(tmp_path):
    assert load_rig(write_rig(tmp_path / "good", press=pressed())).recording.warnings == ()
    loaded = {name: values[115:180] for name, values in pressed().items()}  # never clear, and its force follows at once
    warnings = load_rig(write_rig(tmp_path / "loaded", press=loaded)).recording.warnings
    assert all("noise" not in sentence for sentence in warnings)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        (pressed(factor=1e-3), "column displacement_mm: reaches 0.0003 mm only, .*is it in millimetres"),
        (pressed() | {"force_N": pressed()["force_N"] + 5.0}, "column force_N: is 5 N while nothing touches"),
        (pressed() | {"force_N": pressed()["force_N"] - 5.0}, "column force_N: is -5 N while nothing touches"),
    ],
)
def test_another_unit_or_zero_is_told(columns, said, tmp_path):
    (sentence,) = load_rig(write_rig(tmp_path / "rig", press=columns)).recording.warnings
    assert re.search(said, sentence)


def test_a_dot_that_sticks_as_it_is_let_go_is_no_wrong_sign(tmp_path):
    """It pulls with as much force as it was pressed; and a force that was lost while the dot moved says nothing."""
    columns = pressed()
    depth, time = columns["displacement_mm"], columns["time_s"]
    sticks = columns["force_N"] - 0.16 * np.exp(-(((time - 1.95) / 0.05) ** 2))
    assert load_rig(write_rig(tmp_path / "sticks", press={**columns, "force_N": sticks})).recording.runs
    held = {name: values[130:] for name, values in columns.items()}  # begins under load
    assert load_rig(write_rig(tmp_path / "held", press=held)).recording.runs
    lost = np.where(depth > -0.199, np.nan, np.where(time > 3.0, 0.1, 0.0))
    still = np.where(depth > -0.199, depth, -0.25)
    at_rest = {**columns, "displacement_mm": still, "force_N": lost}
    assert load_rig(write_rig(tmp_path / "lost", press=at_rest)).recording.runs


def test_drift_and_a_rest_inside_are_told(tmp_path):
    tared = {name: values + (0.05 if name == "force_N" else 0.0) for name, values in pressed().items()}
    assert load_rig(write_rig(tmp_path / "tared", press=tared)).recording.warnings == ()
    (said,) = load_rig(write_rig(tmp_path / "rig", press=pressed(drift_N=0.1))).recording.warnings
    assert "column force_N: drifts from" in said
    voltage_alone = {name: values for name, values in pressed(factor=-1.0).items() if name != "force_N"}
    assert any(
        "is 0.2 mm before it moves, which is inside the segment" in sentence
        for sentence in load_rig(write_rig(tmp_path / "turned", press=voltage_alone)).recording.warnings
    )


def test_a_coupon_counts_positive_along_its_test(tmp_path):
    time = np.linspace(0.0, 1.0, 40)
    pulled = {"time_s": time, "displacement_mm": -5.0 * time - 0.1, "force_N": -2.0 * time}
    rig = HEAD + COUPON.replace("tension", "{}") + RUN
    with pytest.raises(InputError, match=r"displacement_mm: goes down to -5\.1 .* in a compression test"):
        load_rig(write_rig(tmp_path / "rig", rig.format("compression"), press=pulled))
    assert load_rig(write_rig(tmp_path / "sheared", rig.format("shear"), press=pulled)).recording.runs


def test_repeats_may_have_one_label(tmp_path):
    rig = HEAD + SEGMENT + (RUN + "label = 'slow'\n") * 2 + RUN + "label = 'slow (2)'\n"
    runs = load_rig(write_rig(tmp_path / "rig", rig)).recording.runs
    assert [run.label for run in runs] == ["slow", "slow (3)", "slow (2)"]


@pytest.mark.parametrize(("factor", "meant"), [(1e3, "millinewtons"), (1e-3, "kilonewtons"), (3.0, None), (0.1, None)])
def test_a_force_of_another_unit_is_told(factor, meant):
    force = np.linspace(0.0, 0.5, 20)
    run = SimpleNamespace(
        file="a.csv", answers=("force_N",), usable=lambda _: slice(None), channels={"force_N": factor * force}
    )
    said = other_units(SimpleNamespace(runs=[run]), SimpleNamespace(predict=lambda *_: {"force_N": force}))
    assert [sentence.rpartition("are these ")[2] for sentence in said] == ([f"{meant}?"] if meant else [])
