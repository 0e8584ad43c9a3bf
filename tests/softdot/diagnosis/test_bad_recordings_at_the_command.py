"""Every bad recording: one sentence, exit 2, no work begun, nothing written."""

import os

import numpy as np
import pytest

from softdot.cli import main
from softdot.diagnosis import folder as engines
from tests.diagnose.rigs import COUPON, HEAD, RUN, SEGMENT, csv_text, samples, write_rig

GOOD = HEAD + SEGMENT + RUN
FILTER = "[[mechanisms]]\nname = 'low-pass'\ncomponent = 'readout'\nparameters.cutoff_Hz = 60.0\n"


def changed(**new):
    return csv_text(samples() | new)


def without(name):
    return csv_text({key: values for key, values in samples().items() if key != name})


def blocked(name, first, last):
    columns = samples()
    columns[name][first:last] = np.nan
    return csv_text(columns)


def backwards():
    time = samples()["time_s"]
    return changed(time_s=np.where(np.arange(len(time)) == 50, time[48], time))


def without_rest():
    """Pressed from the first sample to the last, so that nothing shows the noise."""
    columns = {name: values[105:165] for name, values in samples().items()}
    return csv_text(columns | {"displacement_mm": 0.1 + 0.2 * np.linspace(0.0, 1.0, 60)})


FILES = {
    "missing column": (without("displacement_mm"), "column displacement_mm is missing, which drive names"),
    "nothing to explain": (without("voltage_V"), "a column of voltage or force is needed too"),
    "another unit": (
        without("voltage_V").replace("displacement_mm", "displacement_um"),
        "did you mean 'displacement_mm'",
    ),
    "time goes back": (backwards(), "row 52, column time_s = 0.48: follows 0.49, time must increase"),
    "NaN block in the drive": (blocked("displacement_mm", 100, 350), "the drive is missing in 250 of 400 rows"),
    "NaN throughout": (blocked("voltage_V", 0, 400), "column voltage_V: every sample is missing"),
    "one sample": ("time_s,displacement_mm,voltage_V\n0,0.1,1\n", "has 1 sample, at least 8 are needed"),
    "all zeros": (changed(voltage_V=np.zeros(400)), "is 0 in every row, nothing was connected"),
    "constant drive": (changed(displacement_mm=np.full(400, 0.3)), "is 0.3 in every row, nothing was pressed"),
    "never touches": (changed(displacement_mm=samples()["displacement_mm"] - 1.0), "this run never touches"),
    "noise not known": (without_rest(), "its noise is not known; record at least 50 samples before the touch"),
    "empty": ("", "empty, needs a header row"),
}
RIGS = {
    "no format": (SEGMENT + RUN, "format is missing"),
    "no runs": (HEAD + SEGMENT, "runs is missing"),
    "unknown key": (GOOD + "lable = 'a'", "runs[0].lable is not a key; did you mean 'label'?"),
    "no such file": (GOOD.replace("press.csv", "pres.csv"), "pres.csv': there is no such file"),
    "no thickness": (HEAD + RUN, "segment.medium1.thickness_mm is missing"),
    "two voltages for one electrode": (GOOD, None),
    "no such material": (HEAD + RUN + COUPON.replace("rubber", "ruber"), "did you mean 'rubber'?"),
    "sampled too slowly": (
        HEAD + SEGMENT + FILTER + RUN,
        "100 samples per second are too slow for low-pass, which acts up to 60 Hz and needs 240",
    ),
    "not TOML": ("[[runs", "not valid TOML"),
    "no readout of that mode": (
        GOOD + "[runs.readout]\nmode = 'charge'", "mode = 'charge' needs it",
    ),
}  # fmt: skip


@pytest.fixture
def refusal(monkeypatch, tmp_path, capfd):
    """The one sentence with which a folder is refused."""
    monkeypatch.setattr(engines, "engine_for", lambda *_: pytest.fail("work began"))

    def refused(folder):
        assert main(["diagnose", str(folder), "-o", str(tmp_path / "out"), "--json"]) == 2
        said = capfd.readouterr()
        assert said.out == ""
        assert said.err.startswith(("softdot: recording '", "softdot: configuration '"))
        assert said.err.count("\n") == 1
        assert not (tmp_path / "out").exists()
        return said.err

    return refused


@pytest.mark.parametrize(("text", "expected"), FILES.values(), ids=FILES)
def test_samples(text, expected, tmp_path, refusal):
    assert expected in refusal(write_rig(tmp_path / "rig", press=text))


@pytest.mark.parametrize(("rig", "expected"), RIGS.values(), ids=RIGS)
def test_rig_files(rig, expected, tmp_path, refusal):
    columns = samples()
    if expected is None:
        columns = {"voltage_1_V": columns.pop("voltage_V"), **columns}
        columns["voltage_2_V"] = columns["voltage_1_V"]
        expected = "has 2 columns of voltage, but segment.film.electrodes"
    assert expected in refusal(write_rig(tmp_path / "rig", rig, press=columns))


def test_a_file_of_ten_gigabytes_is_refused_unread(tmp_path, refusal):
    folder = write_rig(tmp_path / "rig")
    os.truncate(folder / "press.csv", 10_000_000_000)  # sparse: it takes no room
    assert "at most 500 MB are read" in refusal(folder)


def test_no_folder(tmp_path, refusal):
    assert "there is no such folder" in refusal(tmp_path / "rig")


@pytest.mark.press
def test_millivolts_under_the_name_of_volts_are_a_warning(tmp_path, diagnosed):
    volts = 0.1 * samples()["voltage_V"]
    told = []
    for factor in (1.0, 1e3):
        _, verdict, _ = diagnosed(write_rig(tmp_path / f"rig-{factor:g}", press=changed(voltage_V=factor * volts)))
        told.append([warning for warning in verdict["warnings"] if "are these millivolts?" in warning])
    assert told[0] == []
    assert len(told[1]) == 1
