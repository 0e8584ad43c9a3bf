"""Every mistake in a recording: one sentence that names file and key, or file, row and column."""

import os
import re

import numpy as np
import pytest

from diagnose.signals import columns
from diagnose.signals.run_checks import refuse_slow_sampling
from foundation.errors import InputError
from softdot.config.rig import load_rig
from tests.diagnose.rigs import COUPON, HEAD, RUN, SEGMENT, csv_text, samples, write_rig

GOOD = HEAD + SEGMENT + RUN
NUMBER = "must be a plain number; its unit is part of the key"
RIGS = {
    # the table of the runs
    SEGMENT + RUN: "format is missing: format of this file",
    GOOD.replace("recording/1", "recording/9"): "format = 'softdot-recording/9': must be 'softdot-recording/1'",
    HEAD + SEGMENT: "runs is missing: one table per file",
    "runs = []\n" + HEAD + SEGMENT: "runs = []: must hold at least one table",
    GOOD + "drive = 'voltage_V'": "runs[0].drive = 'voltage_V': must be 'displacement_mm' or 'force_N'",
    GOOD + "lable = 'a'": "runs[0].lable is not a key; did you mean 'label'?",
    GOOD + "temperature_C = '23 C'": f"runs[0].temperature_C = '23 C': {NUMBER}",
    GOOD + "virgin = 'yes'": "runs[0].virgin = 'yes': must be true or false, without quotes",
    GOOD + "dot_offset_mm = [0.0]": "runs[0].dot_offset_mm[1] is missing",
    GOOD + "[runs.nuisance]\ngian = 0.1": "runs[0].nuisance: 'gian' is not a nuisance parameter; did you mean 'gain'?",
    GOOD + "[runs.nuisance]\nmodulus.medium3 = 0.1": (
        "runs[0].nuisance: 'modulus.medium3' is not a nuisance parameter; did you mean 'modulus.medium2'?"
    ),
    GOOD + "[runs.nuisance]\ngain = 0.0": "runs[0].nuisance.gain = 0: must be above 0",
    GOOD + "[runs.nuisance]\ngain = 5": (
        "runs[0].nuisance: gain = 5 is relative, and must be at most 1; 0.05 is five percent"
    ),
    GOOD + "[runs.nuisance]\nmodulus.specimen = 11": (
        "runs[0].nuisance: modulus.specimen = 11 is relative, and must be at most 10; 0.05 is five percent"
    ),
    GOOD + "[runs.noise]\nvoltage_V = 2.0": (
        "noise.voltage_V = 2 of the run 'press' is more than its whole range, 0.306; is it in another unit?"
    ),
    GOOD + "temperature_C = 296.0": "runs[0].temperature_C = 296: must be at most 150",
    GOOD + "dot_offset_mm = [0.0, -9.0]": (
        "dot_offset_mm = [0.0, -9.0] of the run 'press' is beside the segment of 2.5 mm x 2.5 mm"
    ),
    GOOD + "[runs.noise]\nvolts = 0.1": "noise.volts of the run 'press' names no column of 'press.csv'",
    GOOD + "[runs.readout]\ninput_resistance_MOhm = -1.0": (
        "runs[0].readout.input_resistance_MOhm = -1: must be above 0"
    ),
    GOOD + "[runs.readout]\nmode = 'charge'": ("runs[0].readout.feedback_pF is missing: mode = 'charge' needs it"),
    # the configuration
    HEAD + RUN: "segment.medium1.thickness_mm is missing: thickness in z",
    GOOD + "[dott]": "dott is not a key; did you mean 'dot'?",
    GOOD + COUPON: "segment and specimen exclude each other: leave one of them out",
    "geometry = 'unknown'\n" + GOOD: "segment and geometry = 'unknown' exclude each other: leave one of them out",
    HEAD + RUN + COUPON.replace("rubber", "ruber"): (
        "specimen.material = 'ruber': no such material; did you mean 'rubber'?"
    ),
    HEAD + RUN + COUPON.replace("tension", "torsion"): (
        "specimen.kind = 'torsion': must be 'tension', 'compression' or 'shear'"
    ),
    HEAD + RUN + COUPON.replace("20.0", "-20.0"): "specimen.length_mm = -20: must be above 0",
}


def refusal(folder):
    """The one sentence with which a folder is refused."""
    with pytest.raises(InputError) as caught:
        load_rig(folder)
    said = str(caught.value)
    assert "\n" not in said
    return said


@pytest.mark.parametrize(("rig", "expected"), RIGS.items(), ids=range(len(RIGS)))
def test_rig_file(rig, expected, tmp_path):
    folder = write_rig(tmp_path / "rig", rig)
    assert refusal(folder).startswith(f"recording '{folder / 'rig.toml'}': {expected}")


def edited(row, column, text):
    """A good file with one cell replaced; row 1 is the header."""
    lines = csv_text(samples()).splitlines()
    cells = lines[row - 1].split(",")
    cells[column] = text
    lines[row - 1] = ",".join(cells)
    return "\n".join(lines) + "\n"


def without(name):
    return csv_text({key: values for key, values in samples().items() if key != name})


def changed(**new):
    return csv_text(samples() | new)


def blocked(name, first, last):
    """A good file with a block of NaN."""
    columns = samples()
    columns[name][first:last] = np.nan
    return csv_text(columns)


ALWAYS_CLEAR = samples()["displacement_mm"] - 1.0
FILES = {
    # header
    "": ": empty, needs a header row such as 'time_s,force_N,voltage_V'",
    "time_s,displacement_mm,voltage_V\n": ": there is no sample below the header",
    "time_s;voltage_V\n0;1\n": " row 1: is one column, separate columns by commas",
    edited(1, 2, "voltage_mV"): " row 1: column 'voltage_mV' is not known; did you mean 'voltage_V'? (mind the unit)",
    edited(1, 1, "displacement_um"): (
        " row 1: column 'displacement_um' is not known; did you mean 'displacement_mm'? (mind the unit)"
    ),
    edited(1, 1, "voltage_V"): " row 1: column 'voltage_V' appears twice",
    without("time_s"): ": column time_s is missing",
    without("displacement_mm"): None,
    without("voltage_V"): ": only displacement_mm was recorded; a column of voltage or force is needed too",
    changed(voltage_1_V=samples()["voltage_V"]): ": has both voltage_V and voltage_1_V; number all of them or none",
    # cells
    edited(12, 2, "abc"): " row 12, column voltage_V = 'abc': must be a number, or nan if missing",
    edited(12, 2, "inf"): " row 12, column voltage_V = inf: must be at most 1e+12 in size, or nan if missing",
    edited(12, 2, "1e200"): " row 12, column voltage_V = 1e+200: must be at most 1e+12 in size, or nan if missing",
    edited(12, 2, "1,5"): " row 12: has 4 values but the header has 3 columns",
    edited(12, 0, "nan"): " row 12, column time_s = nan: every sample needs its time",
    edited(12, 0, "0.09"): " row 12, column time_s = 0.09: follows 0.09, time must increase",
    edited(12, 0, "0.05"): " row 12, column time_s = 0.05: follows 0.09, time must increase",
    # too little
    "time_s,displacement_mm,voltage_V\n0,0.1,1\n": ": has 1 sample, at least 8 are needed",
    csv_text(samples(rows=5)): ": has 5 samples, at least 8 are needed",
    changed(voltage_V=np.zeros(400)): ", column voltage_V: is 0 in every row, nothing was connected",
    changed(displacement_mm=np.full(400, 0.3)): ", column displacement_mm: is 0.3 in every row, nothing was pressed",
    changed(displacement_mm=ALWAYS_CLEAR): (
        ", column displacement_mm: never rises out of its noise above -0.7, this run never touches"
    ),
    blocked("voltage_V", 0, 400): ", column voltage_V: every sample is missing",
    blocked("displacement_mm", 100, 350): (
        " row 102, column displacement_mm = nan: the drive is missing in 250 of 400 rows, at most half can be bridged"
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), FILES.items(), ids=range(len(FILES)))
def test_samples(text, expected, tmp_path):
    folder = write_rig(tmp_path / "rig", press=text)
    expected = expected or ": column displacement_mm is missing, which drive names in rig.toml"
    assert refusal(folder) == f"recording '{folder / 'press.csv'}'{expected}"


def test_columns_and_electrodes_agree(tmp_path):
    columns = samples()
    columns = {**{k: columns[k] for k in ("time_s", "displacement_mm")}, "voltage_1_V": columns["voltage_V"]}
    folder = write_rig(tmp_path / "rig", press=columns | {"voltage_2_V": columns["voltage_1_V"]})
    assert refusal(folder).endswith(
        "press.csv' row 1: has 2 columns of voltage, but segment.film.electrodes of rig.toml makes 1 of them"
    )


def test_a_column_of_an_electrode_that_is_not_there_is_refused(tmp_path):
    columns = samples()
    columns["voltage_2_V"] = columns.pop("voltage_V")
    folder = write_rig(tmp_path / "rig", press=columns)
    assert refusal(folder).endswith("has voltage_2_V; electrodes are numbered from 1, so voltage_1_V")


def test_a_copy_of_a_run_is_told(tmp_path):
    rig = GOOD + RUN.replace("press", "b")
    (said,) = load_rig(write_rig(tmp_path / "copy", rig, press=samples(), b=samples())).recording.warnings
    assert said.endswith("a copy is no repeat")
    assert load_rig(write_rig(tmp_path / "repeat", rig, press=samples(), b=samples(seed=1))).recording.warnings == ()


def test_a_file_of_ten_gigabytes_is_refused_unread(tmp_path):
    folder = write_rig(tmp_path / "rig")
    os.truncate(folder / "press.csv", 10_000_000_000)  # sparse: it takes no room
    assert re.search(r"press.csv': 10000 MB make 10000 MB of samples .* at most 500 MB are read", refusal(folder))


def test_many_files_are_counted_together(tmp_path, monkeypatch):
    monkeypatch.setattr(columns, "LARGEST_FILES_MB", 1.5e-6 * len(csv_text(samples())))
    rig = HEAD + SEGMENT + RUN + '[[runs]]\nfile = "b.csv"\n'
    folder = write_rig(tmp_path / "rig", rig, press=samples(), b=samples())
    assert f"recording '{folder / 'b.csv'}'" in refusal(folder)


@pytest.mark.parametrize(
    ("make", "expected"),
    [
        (lambda _: None, ": there is no such folder"),
        (lambda folder: folder.write_text("", "utf-8"), ": this is a file, a folder is needed"),
        (lambda folder: folder.mkdir(), ": has no rig.toml, which states what was built and measured"),
    ],
)
def test_folder(make, expected, tmp_path):
    make(tmp_path / "rig")
    assert refusal(tmp_path / "rig") == f"recording '{tmp_path / 'rig'}'{expected}"


def test_a_file_that_is_not_there(tmp_path):
    folder = write_rig(tmp_path / "rig", GOOD.replace("press.csv", "pres.csv"))
    assert refusal(folder) == f"recording '{folder / 'pres.csv'}': there is no such file"


def test_a_file_that_is_no_text(tmp_path):
    folder = write_rig(tmp_path / "rig")
    (folder / "press.csv").write_bytes("time_s,…".encode("utf-16"))
    assert refusal(folder) == f"recording '{folder / 'press.csv'}': not UTF-8 text (byte 0), save it as UTF-8"


def test_sampling_too_slow_for_what_is_asked(tmp_path):
    (run,) = load_rig(write_rig(tmp_path / "rig")).recording.runs
    refuse_slow_sampling(run, 20.0, "viscoelasticity")
    with pytest.raises(InputError, match="time_s: 100 samples per second are too slow for low-pass"):
        refuse_slow_sampling(run, 60.0, "low-pass")


def warnings(tmp_path, text):
    return load_rig(write_rig(tmp_path / "rig", press=text)).recording.warnings


def test_no_voltage_is_suspicious_by_itself(tmp_path):
    """A film between stiff layers gives hundreds of volts: only the model of the rig can say what is too much."""
    assert warnings(tmp_path, changed(voltage_V=1000.0 * samples()["voltage_V"])) == ()


def test_missing_samples_are_counted_and_not_used(tmp_path):
    (said,) = warnings(tmp_path, blocked("voltage_V", 100, 150))
    assert said.endswith("row 102, column voltage_V: not measured; 50 of 400 samples are missing")


def test_a_limit_is_seen_and_not_used(tmp_path):
    columns = samples()
    columns["voltage_V"] = np.minimum(columns["voltage_V"], 0.2)
    (said,) = warnings(tmp_path, csv_text(columns))
    assert re.search(r"column voltage_V = 0.2: at the limit of the amplifier; \d\d such samples are not used", said)


def test_a_coarse_converter_is_no_limit(tmp_path):
    columns = samples()
    columns["voltage_V"] = np.round(columns["displacement_mm"].clip(0.0) * 20.0 + 0.01) / 20.0
    assert warnings(tmp_path, csv_text(columns)) == ()


def test_gaps_and_other_rates_are_named(tmp_path):
    columns = samples()
    columns["time_s"][200:] += 0.5
    (said,) = warnings(tmp_path, csv_text(columns))
    assert said.endswith("row 202, column time_s: time jumps (jumps in all: 1)")


def test_a_force_that_is_only_noise_never_touches(tmp_path):
    force = 0.01 * np.random.default_rng(3).standard_normal(400)
    folder = write_rig(tmp_path / "rig", GOOD + "drive = 'force_N'", press=changed(force_N=force))
    assert re.search(r"press.csv', column force_N: never rises out of its noise .* never touches", refusal(folder))


@pytest.mark.parametrize("name", ["/etc/hostname", "../press.csv", "a/../../press.csv", "C:\\\\secret.csv", ""])
def test_a_run_lies_in_the_folder_of_its_recording(name, tmp_path):
    rig = GOOD.replace("press.csv", name)
    said = refusal(write_rig(tmp_path / "rig", rig))
    assert "must be the name of a file in the folder of rig.toml" in said
