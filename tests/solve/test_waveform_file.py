"""The file of a waveform: a table of finite numbers, or a sentence."""

import numpy as np
import pytest

from foundation.errors import InputError
from solve.solution.schedule import duration_s, fraction
from solve.waveform import Waveform

GOOD = "time_s,fraction\n0,0\n1,0.5\n2,1\n"


def waveform(tmp_path, text, encoding="utf-8"):
    file = tmp_path / "wave.csv"
    file.write_text(text, encoding)
    return Waveform(shape="file", file=str(file))


@pytest.mark.parametrize(
    "bad",
    [
        "time_s,fraction\n0,0\n1,nan\n2,1\n",
        "time_s,fraction\n0,0\n1,1\nnan,nan\n",
        "time_s,fraction\n0,0\ninf,1\n",
        "time_s,fraction\n0,0\n1e300,1\n",
        "time_s,fraction\n0,0\n1,inf\n",
        "time_s,fraction\n0,0\n1," + "9" * 200_000 + "\n",
        "time_s,fraction\n0,0\n1," + "x" * 200_000 + "\n",
        "time_s,fraction\n0,0\n1\n",
        "time_s,fraction\n",
        "",
        "time_s,fraction,fraction\n0,0,0\n1,1,1\n",
        "time_s,fraction\n0,0\n0,5,1\n",
        "time_s,fraction\n0,0\n1_0,1\n",
        "time_s;fraction\n0;0\n1;1\n",
        "time_ms,fraction\n0,0\n1,1\n",
    ],
)
def test_what_is_no_finite_number_is_refused(tmp_path, bad):
    with pytest.raises(InputError, match=r"press\.waveform\.file") as caught:
        duration_s(waveform(tmp_path, bad))
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("text", [GOOD, GOOD.replace("n\n0", "n\n\n0"), GOOD + "\n\n", GOOD.replace("\n", "\r\n")])
def test_what_spreadsheets_write_is_read(tmp_path, text, encoding):
    np.testing.assert_allclose(fraction(waveform(tmp_path, text, encoding), np.array([0.5, 1.5])), [0.25, 0.75])


def test_an_edited_file_is_read_again(tmp_path):
    assert duration_s(waveform(tmp_path, GOOD)) == 2.0
    assert duration_s(waveform(tmp_path, GOOD + "3,1\n")) == 3.0
