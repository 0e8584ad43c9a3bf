"""softdot read at the command line: what it writes, and what it refuses."""

import json
from dataclasses import replace

import numpy as np
import pytest

from softdot.cli import main

TEXT = "soft dots"


@pytest.fixture(scope="module")
def written(kernel_folder, tmp_path_factory):
    out = tmp_path_factory.mktemp("read") / "out"
    command = ["read", TEXT, "--kernel", str(kernel_folder), "--speed-mm-per-s", "30", "-q", "-o", str(out)]
    assert main([*command, "--decoders", "model,threshold"]) == 0
    return out


@pytest.mark.press
def test_a_folder_says_what_was_read(written):
    told = json.loads((written / "reading.json").read_text("utf-8"))
    assert told["format"] == "softdot-reading/1"
    assert told["text_true"] == told["text_read"] == TEXT
    assert told["character_accuracy"]["value"] == 1.0
    assert told["words_per_minute"] == pytest.approx(2 / (9 * 6.0 / 30.0) * 60.0)
    assert told["cells_per_s"] == pytest.approx(30.0 / 6.0)
    assert set(told["decoders"]) == {"model", "threshold"}
    assert told["conditions"]["noise_mV"] == 1.0
    assert told["is_certain"]
    assert told["conditions"]["readout_input_resistance_MOhm"] == 10.0
    assert (written / "signals.png").stat().st_size > 10_000
    with np.load(written / "signals.npz") as file:
        arrays = dict(file)
    assert arrays["voltage_V"].shape == (len(arrays["time_s"]), 6)
    np.testing.assert_array_equal(arrays["cell_true"], arrays["cell_read"])
    place = np.interp(arrays["read_time_s"], arrays["time_s"], arrays["position_mm"])
    np.testing.assert_allclose(place, arrays["x_mm"], atol=0.02)


def recording_of(written, path, channels=6, damage=None):
    with np.load(written / "signals.npz") as file:
        table = np.column_stack([file["time_s"], file["voltage_V"][:, :channels]])
    if damage is not None:
        table[damage] = np.nan
    head = ",".join(["time_s", *(f"voltage_{number}_V" for number in range(1, channels + 1))])
    np.savetxt(path, table, delimiter=",", header=head, comments="")
    return path


@pytest.mark.press
def test_a_recording_is_read_as_the_simulation_was(written, kernel_folder, tmp_path, capfd):
    path = recording_of(written, tmp_path / "heard.csv")
    command = ["read", "--recording", str(path), "--kernel", str(kernel_folder), "--decoders", "model"]
    assert main([*command, "-q", "--json", "-o", str(tmp_path / "out")]) == 0
    told = json.loads(capfd.readouterr().out)
    assert told["text_read"] == TEXT
    assert told["text_true"] is None
    assert told["track"]["speed_mm_per_s"] == pytest.approx(30.0, rel=0.03)
    assert "What the line says is not known." in (tmp_path / "out" / "report.html").read_text("utf-8")


def refused(arguments, out, capfd):
    assert main(["read", *arguments, "-o", str(out)]) == 2
    said = capfd.readouterr().err
    assert said.startswith("softdot: "), said
    assert said.count("softdot: ") == 1
    assert not out.exists()
    return said


def test_bad_recordings_are_one_sentence(written, kernel_folder, tmp_path, capfd):
    kernel = ["--kernel", str(kernel_folder), "-q"]
    few = recording_of(written, tmp_path / "few.csv", channels=5)
    said = refused(["--recording", str(few), *kernel], tmp_path / "out", capfd)
    assert "has 5 channels, the kernel has 6 segments; voltage_6_V is missing" in said
    damaged = recording_of(written, tmp_path / "damaged.csv", damage=(10, 2))
    said = refused(["--recording", str(damaged), *kernel], tmp_path / "out", capfd)
    assert "voltage_2_V is not finite in line 12" in said
    assert "heard.csv" in refused(["--recording", str(tmp_path / "heard.csv"), *kernel], tmp_path / "out", capfd)


def test_bad_requests_are_one_sentence(kernel_folder, tmp_path, capfd):
    kernel = ["--kernel", str(kernel_folder), "-q"]
    for arguments, sentence in {
        ("touché",): "text: 'é' (U+00E9",
        (): "text: is empty",
        ("a", "--depth-mm", "0.9"): "--depth-mm = 0.9: with scatter",
        ("a", "--decoders", "oracle"): "--decoders = 'oracle': 'oracle' is none of model, threshold, learned, hand",
        ("a", "--calibration", "c.json"): "--calibration = 'c.json': acts only with --recording",
        ("a", "--calibration", "c.json", "--study"): "--calibration = 'c.json': acts only with --recording",
        ("a", "--calibrate", "k.csv", "--study"): "--study: has no part in --calibrate",
        ("a", "--calibrate", "k.csv", "--decoders", "hand"): "--decoders: has no part in --calibrate",
        ("a", "--calibrate", "k.csv", "--noise-mV", "2"): "--noise-mV = 2.0: acts only on voltages",
        ("a", "--text", "b"): "--text = 'b': the text stands before the options already",
        ("a", "--calibrate", "none.csv"): "recording 'none.csv'",
        ("a", "--dead-channel", "1.5"): "--dead-channel = 1.5: must be a whole number",
        ("a", "--dead-channel", "7"): "--dead-channel = 7: the array has 6 channels",
        ("a", "--hum-Hz", "60"): "--hum-Hz = 60.0: acts only with --hum-mV above 0",
        ("a", "--force-N", "1", "--contact-losses", "1"): "--contact-losses = 1: a held force keeps contact",
        ("a", "--standard", "nls"): "--standard = 'nls': its dots are 2.34 mm apart",
        ("a", "examples/dome.toml"): f"kernel '{kernel_folder}': config_hash",
    }.items():
        assert refused([*arguments, *kernel], tmp_path / "out", capfd).startswith(f"softdot: {sentence}")


def test_bad_kernels_are_one_sentence(kernel, tmp_path, capfd):
    charge = kernel.charge_pC.copy()
    charge[3, 3, 3, 3] = np.nan
    rows = {**kernel.about, "centres_mm": [[x, 0.0] for x, _ in kernel.about["centres_mm"]]}
    for number, (damaged, sentence) in enumerate(
        [
            (replace(kernel, charge_pC=charge), "charge_pC holds a number that is not finite"),
            (replace(kernel, about={**kernel.about, "softdot_version": "9.9"}), "softdot_version = '9.9': this is"),
            (replace(kernel, about={**kernel.about, "format": "other/1"}), "format = 'other/1': must be"),
            (replace(kernel, about=rows), "has no segment over row 1 of a cell"),
        ]
    ):
        folder = tmp_path / f"kernel{number}"
        folder.mkdir()
        damaged.save(folder)
        said = refused(["a", "--kernel", str(folder), "-q"], tmp_path / "out", capfd)
        assert sentence in said
    assert "kernel.json" in refused(["a", "--kernel", str(tmp_path), "-q"], tmp_path / "out", capfd)


@pytest.mark.press
def test_a_line_that_is_not_believed_has_no_text_and_a_status(kernel_folder, tmp_path, capfd):
    """Two channels are exchanged, each of another row and column."""
    out = tmp_path / "out"
    command = ["read", "touch and read", "--kernel", str(kernel_folder), "--speed-mm-per-s", "40", "-o", str(out)]
    assert main([*command, "--swapped-channel", "2", "--decoders", "hand"]) == 3
    assert "another order" in capfd.readouterr().err
    told = json.loads((out / "reading.json").read_text("utf-8"))
    assert set(told["text_read"]) == {"?"}
    assert not told["is_certain"]


@pytest.mark.press
def test_the_configuration_of_the_kernel_may_bring_its_readout(kernel_folder, tmp_path):
    """Another read-out makes no other design."""
    command = ["read", TEXT, "examples/array-cell.toml", "--set", "readout.input_resistance_MOhm=50"]
    out = tmp_path / "out"
    assert main([*command, "--kernel", str(kernel_folder), "--decoders", "model", "-q", "-o", str(out)]) == 0
    told = json.loads((out / "reading.json").read_text("utf-8"))
    assert told["conditions"]["readout_input_resistance_MOhm"] == 50.0
    assert told["text_read"] == TEXT
