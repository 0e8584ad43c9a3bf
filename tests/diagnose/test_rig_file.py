"""A good recording comes out as it was written."""

import re
from pathlib import Path

import numpy as np
import pytest

from diagnose.signals.recording import NUISANCES
from softdot.config.rig import load_rig
from tests.diagnose.rigs import COUPON, HEAD, RUN, SEGMENT, csv_text, samples, write_rig

FULL = """format = "softdot-recording/1"
[readout]
input_resistance_MOhm = 10.0
low_pass_Hz = 60.0
[segment.medium1]
thickness_mm = 0.5
[segment.film]
thickness_um = 28.0
[segment.medium2]
thickness_mm = 2.0
material = "own"
[materials.own]
youngs_modulus_MPa = 0.7
[[runs]]
file = "press.csv"
label = "1 Hz, 0.3 mm"
dot_offset_mm = [0.1, -0.2]
temperature_C = 23.0
[runs.readout]
input_resistance_MOhm = 1.0
[runs.nuisance]
gain = 0.05
modulus.medium1 = 0.1
"thickness.medium2" = 0.02
[runs.noise]
voltage_V = 0.002
"""


def test_all_that_is_believed(tmp_path):
    rig = load_rig(write_rig(tmp_path / "rig", FULL))
    (run,) = rig.recording.runs
    assert rig.config.segment.film.thickness_um == 28.0
    assert rig.materials["own"].youngs_modulus_MPa == 0.7
    assert (run.label, run.drive, run.dot_offset_mm, run.temperature_C) == (
        "1 Hz, 0.3 mm", "displacement_mm", (0.1, -0.2), 23.0,
    )  # fmt: skip
    assert run.nuisance == {"gain": 0.05, "modulus.medium1": 0.1, "thickness.medium2": 0.02}
    assert run.noise == {"voltage_V": 0.002}
    assert (rig.config.readout.input_resistance_MOhm, run.readout.input_resistance_MOhm) == (10.0, 1.0)
    assert run.readout.low_pass_Hz == 60.0
    assert rig.recording.warnings == ()


def test_samples_as_written(tmp_path):
    columns = samples()
    (run,) = load_rig(write_rig(tmp_path / "rig", press=columns)).recording.runs
    assert run.label == "press"
    assert run.answers == ("voltage_V",)
    assert run.time_s == pytest.approx(columns["time_s"])
    assert run.channels["voltage_V"] == pytest.approx(columns["voltage_V"], rel=1e-8)
    assert run.usable("voltage_V").all()


def test_empty_cells_are_missing_samples(tmp_path):
    text = csv_text(samples()).splitlines()
    text[5] = text[5].rpartition(",")[0] + ","
    (run,) = load_rig(write_rig(tmp_path / "rig", press="\n".join(text))).recording.runs
    assert np.flatnonzero(~run.valid["voltage_V"]).tolist() == [4]


def test_where_the_drive_is_missing_nothing_is_used(tmp_path):
    columns = samples()
    columns["displacement_mm"][130:135] = np.nan
    (run,) = load_rig(write_rig(tmp_path / "rig", press=columns)).recording.runs
    assert np.flatnonzero(~run.usable("voltage_V")).tolist() == [*range(130, 135)]
    assert run.drive_values[132] == pytest.approx(samples()["displacement_mm"][132])


def test_channels_come_in_the_order_of_the_electrodes(tmp_path):
    columns = samples()
    columns |= {f"voltage_{n}_V": columns["voltage_V"] for n in (10, 2, 1)}
    del columns["voltage_V"]
    rig = HEAD + "geometry = 'unknown'\n" + RUN
    (run,) = load_rig(write_rig(tmp_path / "rig", rig, press=columns)).recording.runs
    assert run.voltages == ("voltage_1_V", "voltage_2_V", "voltage_10_V")


def test_a_geometry_that_is_not_known_needs_no_segment(tmp_path):
    rig = load_rig(write_rig(tmp_path / "rig", HEAD + "geometry = 'unknown'\n[readout]\nlow_pass_Hz = 50.0\n" + RUN))
    assert rig.config is None
    assert rig.recording.runs[0].readout.low_pass_Hz == 50.0


def test_a_coupon(tmp_path):
    columns = {"time_s": np.arange(20.0), "displacement_mm": np.arange(20.0), "force_N": 0.1 * np.arange(20.0)}
    recording = load_rig(write_rig(tmp_path / "rig", HEAD + RUN + COUPON, press=columns)).recording
    assert (recording.specimen.gauge_mm, recording.specimen.area_mm2) == (20.0, 10.0)


def test_a_run_of_another_name_than_its_segment(tmp_path):
    rig = load_rig(write_rig(tmp_path / "rig", HEAD + SEGMENT + RUN))
    assert rig.recording.run("press").file == "press.csv"


def documented():
    """The files rig.toml that the document shows."""
    text = (Path(__file__).parents[2] / "docs" / "recordings.md").read_text("utf-8")
    return re.findall(r"```\n(format = .*?)```", text, re.DOTALL)


def test_the_segment_of_the_document_is_read(tmp_path):
    files = {"press-01": samples(), "press-02": samples(seed=1)}
    rig = load_rig(write_rig(tmp_path / "rig", documented()[0], **files))
    assert [run.readout.input_resistance_MOhm for run in rig.recording.runs] == [10.0, 1.0]


def test_the_coupon_of_the_document_is_read(tmp_path):
    columns = {"time_s": np.arange(20.0), "displacement_mm": np.arange(20.0), "force_N": 0.1 * np.arange(20.0)}
    assert load_rig(write_rig(tmp_path / "rig", documented()[1], strip=columns)).recording.specimen.kind == "tension"


def test_every_nuisance_is_documented():
    text = (Path(__file__).parents[2] / "docs" / "recordings.md").read_text("utf-8")
    assert [name for name in NUISANCES if f"`{name.partition('.')[0]}" not in text] == []
