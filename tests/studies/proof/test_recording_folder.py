"""What the generator hands over is an ordinary recording."""

import numpy as np
import pytest

from softdot.config.rig import load_rig
from softdot.studies.proof.recording_folder import files, rig_text
from softdot.studies.proof.world.reality import channels
from softdot.studies.proof.world.rigs import BENCHES, CLAMPED


def silent(bench):
    """The programme of a bench with answers that follow the depth."""
    for run in bench.runs:
        time = run.times(bench.rate_Hz)
        depth = run.depth(time)
        yield {"time_s": time, "displacement_mm": depth, **dict.fromkeys(channels(bench), depth + 0.04)}


@pytest.mark.parametrize("name", BENCHES)
def test_a_recording_is_read_as_it_was_meant(name, tmp_path):
    bench = BENCHES[name]
    for file, text in files(bench, list(silent(bench))).items():
        (tmp_path / file).write_text(text, "utf-8")
    rig = load_rig(tmp_path)
    assert [len(one.presses) for one in rig.recording.phases] == [run.count for run in bench.runs]
    repeats = "has the samples of"  # without noise two presses of one programme are the same to the last digit
    assert not [told for told in rig.recording.warnings if repeats not in told]
    assert rig.config.segment.length_mm == bench.made.length_mm
    assert rig.recording.runs[0].answers == channels(bench)
    assert rig.config.segment.boundary == ("free" if name.endswith("-free") else "clamped")
    width, thickness = bench.made.width_mm, 1e3 * bench.made.film.thickness_mm
    assert (rig.config.segment.width_mm, rig.config.segment.film.thickness_um) == (width, thickness)


def test_a_folder_has_the_same_names_whatever_is_hidden():
    runs = list(silent(CLAMPED))
    louder = [{**run, "voltage_V": 2.0 * run["voltage_V"]} for run in runs]
    one, other = files(CLAMPED, runs), files(CLAMPED, louder)
    assert list(one) == list(other) == ["rig.toml", *(f"press-{n:02d}.csv" for n in range(1, 7))]
    assert one["rig.toml"] == other["rig.toml"] == rig_text(CLAMPED)


def test_samples_keep_seven_digits():
    runs = list(silent(CLAMPED))
    text = files(CLAMPED, runs)["press-01.csv"]
    read = np.loadtxt(text.splitlines(), delimiter=",", skiprows=1)
    np.testing.assert_allclose(read[:, 1], runs[0]["displacement_mm"], rtol=1e-6, atol=1e-9)
