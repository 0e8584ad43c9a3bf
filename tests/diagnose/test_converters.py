"""Files of instruments become recordings."""

import os
import runpy
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from diagnose.noise.autoregression import fit_autoregression
from diagnose.noise.estimate import noise_models
from diagnose.noise.model import NoiseModel
from diagnose.signals.recording import LARGEST_RELATIVE
from foundation.errors import InputError
from softdot.config.rig import load_rig
from softdot.convert import read_mat, read_sheet, white_noise, write_recording
from tests.diagnose.rigs import HEAD, RUN, SEGMENT, samples

RECORDINGS = os.environ.get("SOFTDOT_RECORDINGS", "")
EXAMPLES = Path(__file__).parents[2] / "examples" / "recordings"


def test_what_the_examples_state_of_a_modulus_is_accepted():
    for script in EXAMPLES.glob("*.py"):
        stated = runpy.run_path(str(script), run_name="read").get("MODULUS")
        assert stated is None or stated <= LARGEST_RELATIVE["modulus.specimen"], script.name


def test_matlab(tmp_path):
    savemat(tmp_path / "a.mat", {"m": np.eye(2), "t": np.arange(5.0)[:, None], "daq": {"mV": 1000.0 * np.arange(5.0)}})
    found = read_mat(tmp_path / "a.mat", {"time_s": "t", "voltage_V": "daq.mV"}, {"voltage_V": 1e-3})
    assert found["time_s"] == pytest.approx(np.arange(5.0))
    assert found["voltage_V"] == pytest.approx(np.arange(5.0))
    with pytest.raises(InputError, match=r"a.mat': has no variable 'daq.V'; "):
        read_mat(tmp_path / "a.mat", {"voltage_V": "daq.V"})
    with pytest.raises(InputError, match=r"a.mat': variable 'm' has shape \(2, 2\), one column"):
        read_mat(tmp_path / "a.mat", {"voltage_V": "m"})


def test_a_mat_file_of_the_hdf5_kind_is_told_how_to_save_it(tmp_path):
    (tmp_path / "a.mat").write_bytes(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM" + bytes(384))
    with pytest.raises(InputError, match=r"a.mat': is a version 7.3 file; save it again in MATLAB with save"):
        read_mat(tmp_path / "a.mat", {"time_s": "t"})


def test_a_sheet(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (["time", "force"], [0.0, 1.5], [1, None]):
        book.active.append(row)
    book.save(tmp_path / "a.xlsx")
    assert np.array_equal(read_sheet(tmp_path / "a.xlsx", 1), [[0.0, 1.5], [1.0, np.nan]], equal_nan=True)


def test_white_noise_of_a_smooth_curve():
    values = np.sin(np.arange(5000) / 500.0) + 0.01 * np.random.default_rng(1).standard_normal(5000)
    assert white_noise(values) == pytest.approx(0.01, rel=0.1)


def test_what_is_written_is_read(tmp_path):
    write_recording(tmp_path / "out", HEAD + SEGMENT + RUN, {"press.csv": samples()})
    (run,) = load_rig(tmp_path / "out").recording.runs
    assert run.channels["voltage_V"] == pytest.approx(samples()["voltage_V"], rel=1e-8)


def test_nothing_is_written_that_is_no_recording(tmp_path):
    with pytest.raises(InputError, match="runs is missing"):
        write_recording(tmp_path / "out", HEAD + SEGMENT, {"press.csv": samples()})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "name", ["../press.csv", "/tmp/press.csv", "a/press.csv", "C:\\press.csv", "..", "rig.toml", ""]
)
def test_nothing_is_written_outside_the_folder(name, tmp_path):
    with pytest.raises(InputError, match="must be the name of a file in the folder of the recording"):
        write_recording(tmp_path / "deep" / "out", HEAD + SEGMENT + RUN, {name: samples()})
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_overwritten(tmp_path):
    (tmp_path / "mine.txt").write_text("", "utf-8")
    with pytest.raises(InputError, match="exists already; name a new or empty folder"):
        write_recording(tmp_path, HEAD + SEGMENT + RUN, {"press.csv": samples()})


needs_recordings = pytest.mark.skipif(
    not RECORDINGS,
    reason="licences forbid copies of these recordings here; SOFTDOT_RECORDINGS names the folder that holds them",
)
SETS = {
    "pvdf_presses": "pvdf-presses",
    "vhb_relaxation": "vhb-relaxation",
    "adhesive_shear": "adhesive-shear",
    "silicones_tensile": "silicones-tensile",
    "rubber_treloar": "rubber-treloar",
}


@pytest.mark.evidence
@needs_recordings
@pytest.mark.parametrize("script", SETS)
def test_real_recordings(script, tmp_path):
    data = Path(RECORDINGS) / SETS[script]
    runpy.run_path(str(EXAMPLES / f"{script}.py"))["convert"](data, tmp_path / "out")
    folders = [file.parent for file in (tmp_path / "out").rglob("rig.toml")]
    assert folders
    for folder in folders:
        recording = load_rig(folder).recording
        assert [len(found.presses) for found in recording.phases] == [1] * len(recording.runs)
        assert all(noise.rms > 0.0 for noise in noise_models(recording).values())


@pytest.mark.evidence
@needs_recordings
def test_noise_of_real_presses_whitens_a_trial_that_it_has_not_seen():
    files = sorted((Path(RECORDINGS) / "pvdf-presses").glob("*Sp300*.npz"))[:2]
    read = runpy.run_path(str(EXAMPLES / "pvdf_presses.py"))["read"]
    known, fresh = (read(file)[0][:4000] for file in files)  # 2 s before the touch
    model = NoiseModel(fit_autoregression([known - known.mean()]), 1.0 / 2000.0, "rest", len(known))
    white = model.whiten(fresh - fresh.mean())
    assert white.var() == pytest.approx(1.0, abs=0.1)
    assert np.abs([np.mean(white[k:] * white[:-k]) for k in range(1, 6)]).max() < 0.06


@pytest.mark.evidence
@needs_recordings
def test_a_trial_whose_streams_are_not_of_one_press_is_left_out(tmp_path, capsys):
    """The first at speed 150 holds its force for 1.8 s and its voltage for 1.5 s."""
    data = Path(RECORDINGS) / "pvdf-presses"
    runpy.run_path(str(EXAMPLES / "pvdf_presses.py"))["convert"](data, tmp_path / "out")
    labels = [run.label for run in load_rig(tmp_path / "out").recording.runs]
    assert len(labels) == len(list(data.glob("*.npz"))) - 1
    assert "cube 10, sequence 1, speed 150, trial 1" not in labels
    assert "Cube10_Seq1_Sp150_t01 is left out" in capsys.readouterr().err


@pytest.mark.evidence
@needs_recordings
def test_pulls_of_the_adhesive_are_as_fast_as_their_files_say(tmp_path):
    runpy.run_path(str(EXAMPLES / "adhesive_shear.py"))["convert"](
        Path(RECORDINGS) / "adhesive-shear", tmp_path / "out"
    )
    pulls = [run for run in load_rig(tmp_path / "out").recording.runs if run.label.startswith("monotonic")]
    rates = {run.label: np.polyfit(run.time_s, run.channels["displacement_mm"], 1)[0] for run in pulls}
    assert rates == pytest.approx({f"monotonic shear {rate:g}": rate for rate in (0.01, 0.05, 0.1, 1.0)}, rel=0.01)
