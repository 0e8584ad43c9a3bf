"""Several electrodes, pressed one after the other: every place of the dot has tables of its own."""

from dataclasses import replace

import numpy as np
import pytest

from diagnose.forward import Setting
from tests.diagnose.segment.rigs import TABLES, candidate, engine, press, run, without_memory

HALVES = [{"name": name, "center_mm": [x, 0.0], "size_mm": [1.2, 2.5]} for name, x in (("left", -0.6), ("right", 0.6))]
SEGMENT = {**TABLES["segment"], "film": {"thickness_um": 28.0, "electrodes": HALVES}}


def over(place_mm):
    """A run of two channels, with the dot beside the middle."""
    one = run(label=f"{place_mm:g}", values=press(np.arange(0.0, 1.6, 0.002), 0.15), dot_offset_mm=(place_mm, 0.0))
    parts = {}
    for name in ("channels", "valid", "saturated"):
        own = dict(getattr(one, name))
        voltage = own.pop("voltage_V")
        parts[name] = {**own, "voltage_1_V": voltage, "voltage_2_V": voltage}
    return replace(one, **parts)


@pytest.fixture(scope="module")
def rig():
    with without_memory():
        return engine(over(0.5), over(-0.5), segment=SEGMENT)


@pytest.mark.press
def test_a_press_on_the_left_is_the_image_of_one_on_the_right(rig):
    right, left = (rig.predict(number, []) for number in (0, 1))
    np.testing.assert_allclose(left["force_N"], right["force_N"], atol=0.01 * right["force_N"].max())
    largest = np.abs(right["voltage_2_V"]).max()
    for one, other in (("voltage_1_V", "voltage_2_V"), ("voltage_2_V", "voltage_1_V")):
        np.testing.assert_allclose(left[one], right[other], atol=0.02 * largest)
    assert np.abs(right["voltage_1_V"] - right["voltage_2_V"]).max() > 0.2 * largest


@pytest.mark.press
def test_a_capacitance_between_channels_brings_them_closer_whichever_is_pressed(rig):
    """By C / (C + 2 C_m) = 0.71 at once, by less while the input, which the pair slows down, loses charge."""
    tied = candidate(rig, "crosstalk", "channel-1-channel-2")
    setting = Setting(tied, (tied.coordinates[0].starts[-1],))
    for number in (0, 1):
        apart, together = rig.predict(number, []), rig.predict(number, [setting])
        np.testing.assert_array_equal(together["force_N"], apart["force_N"])
        before, after = (np.ptp(one["voltage_1_V"] - one["voltage_2_V"]) for one in (apart, together))
        assert 0.71 * before < after < 0.9 * before


@pytest.mark.press
def test_a_place_at_which_no_run_pressed_is_refused(rig):
    with pytest.raises(ValueError, match="was not prepared"):
        rig.imagine(over(0.2), [])
