"""A recording of an array whose layers run through is one of a wide segment with several electrodes."""

import pytest

from foundation.errors import InputError
from softdot.config.rig import load_rig
from tests.diagnose.rigs import HEAD, samples, write_rig

SEGMENT = """[segment]
length_mm = 2.3
width_mm = 2.3
boundary = "free"
[segment.medium1]
thickness_mm = 0.5
[segment.film]
thickness_um = 28.0
[segment.medium2]
thickness_mm = 2.0
"""
ARRAY = '[array]\ncolumns = 3\nrows = 1\npitch_mm = 2.5\nshared = ["film", "medium1", "medium2"]\n'
OVER = '[[runs]]\nfile = "press.csv"\nover = [1, 3]\ndot_offset_mm = [0.1, 0.0]\n'


def three_channels():
    columns = samples()
    voltage = columns.pop("voltage_V")
    return {**columns, **{f"voltage_{n}_V": voltage for n in (1, 2, 3)}}


def rig(folder, array=ARRAY, run=OVER):
    return load_rig(write_rig(folder / "rig", HEAD + SEGMENT + array + run, press=three_channels()))


def test_each_segment_has_an_electrode_and_a_run_presses_over_one(tmp_path):
    found = rig(tmp_path)
    assert found.config.array is None
    assert found.config.segment.length_mm == pytest.approx(7.3)
    assert [round(one.center_mm[0], 6) for one in found.config.segment.film.electrodes] == [-2.5, 0.0, 2.5]
    assert found.recording.runs[0].dot_offset_mm == pytest.approx((2.6, 0.0))
    assert "array" in found.tables  # improved.toml stays that of the array


@pytest.mark.parametrize(
    ("array", "run", "sentence"),
    [
        (ARRAY, OVER.replace("3]", "4]"), r"over = \[1, 4\]: must be a row from 1 to 1 and a column from 1 to 3"),
        ("", OVER, r"runs\[0\].over = \[1, 3\]: there is no \[array\]"),
        (ARRAY.replace(', "medium2"', ""), OVER, "array.shared: leaves out 'medium2'"),
        (
            ARRAY + '[[array.grooves]]\nlayer = "medium2"\nwidth_mm = 0.1\ndepth_mm = 0.5\n',
            OVER,
            "array.grooves: a diagnosis takes arrays",
        ),
    ],
)
def test_what_is_no_wide_segment_is_refused(tmp_path, array, run, sentence):
    with pytest.raises(InputError, match=sentence):
        rig(tmp_path, array, run)
