"""The whole course of a press stands in its table, its plot and its summary: a hold and a release too."""

import numpy as np
import pytest

from softdot import Case
from softdot.summary import course_part

TAU_S = 0.1
TABLES = {
    "segment": {
        "section": "plane-strain", "boundary": "free",
        "medium1": {"thickness_mm": 0.5}, "film": {"thickness_um": 28.0}, "medium2": {"thickness_mm": 1.0},
    },
    "dot": {"shape": "ridge", "radius_mm": 1.15},
    "press": {
        "indentation_mm": 0.1, "load_steps": 2,
        "waveform": {"shape": "trapezoid", "rise_s": 0.2, "hold_s": 1.0, "fall_s": 0.2},
    },
    "readout": {"mode": "charge", "feedback_pF": 1000.0, "feedback_MOhm": 100.0},
    "mesh": {"mesher": "layered", "element_size_mm": 2.0, "film_element_size_mm": 2.0, "contact_element_size_mm": 0.5},
}  # fmt: skip


@pytest.fixture(scope="module")
def pressed():
    with pytest.warns(match="the read-out may be off by"):
        return Case(**TABLES).press()


def curves(pressed):
    """Times and read-outs as the table, the plot and the summary have them."""
    table = pressed.to_dataframe()
    line = pressed.plot().axes[-1].lines[0]
    part = course_part(pressed.case.model, pressed.result, pressed.course)
    return (
        (table["time_s"].to_numpy(), table["readout_V_film"].to_numpy()),
        (line.get_xdata(), line.get_ydata()),
        (part["time_s"], part["readout_V"]["film"]),
    )


def test_a_charge_amplifier_decays_in_the_hold_and_swings_over_in_the_release(pressed):
    """V = V(0.2 s) exp(-t / tau) while the dot rests; what comes back is of the other sign, and as it was by 1.4 s."""
    for time, voltage in curves(pressed):
        assert time[[0, -1]] == pytest.approx([0.0, 1.4])
        at = dict(zip(np.round(time, 9), voltage, strict=True))
        hold = (time >= 0.2) & (time <= 1.2)
        assert hold.sum() > 10
        expected = at[0.2] * np.exp(-(time[hold] - 0.2) / TAU_S)
        np.testing.assert_allclose(voltage[hold], expected, rtol=0, atol=1e-3 * abs(at[0.2]))
        released = voltage[time > 1.2]
        back = released[np.abs(released).argmax()]
        assert back * at[0.2] < 0.0
        assert abs(back) > 0.5 * abs(at[0.2])
