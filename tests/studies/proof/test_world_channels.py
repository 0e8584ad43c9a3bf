"""The hidden circuit of several channels against closed forms, and the rig that has them."""

from dataclasses import replace

import numpy as np
import pytest

from softdot.studies.proof.world.amplifier import Amplifier
from softdot.studies.proof.world.cases import SINGLE, plan
from softdot.studies.proof.world.channels import Stray, Wiring, voltages
from softdot.studies.proof.world.effects import EFFECTS, apply_effects, fits
from softdot.studies.proof.world.made import Film, Layer, Made
from softdot.studies.proof.world.march import table
from softdot.studies.proof.world.reality import baseline, keys
from softdot.studies.proof.world.rigs import CLAMPED, ROW
from softdot.studies.proof.world.stack import Stack

TIME = np.arange(0.0, 3.0, 0.004)
AMPLIFIER = Amplifier(5000.0, 40.0)
TOUCH_S = 0.2
SHORT = Made(
    (Layer("medium2", 1.0, 0.5), Film(), Layer("medium1", 0.5, 2.0)), 4.0, 10.0, "ridge", 1.15, fine=0.25,
    electrodes=((-1.9, -0.1), (0.1, 1.9)),
)  # fmt: skip


def tied(stray, amplifier=AMPLIFIER):
    """Two channels of 100 pF, with 5 GOhm unless said otherwise; 500 pC come smoothly to the first within 40 ms."""
    rise = np.clip((TIME - TOUCH_S) / 0.04, 0.0, 1.0)
    charge = np.column_stack([500.0 * rise**2 * (3.0 - 2.0 * rise), 0.0 * TIME])
    return voltages(amplifier, Wiring((stray,)), TIME, charge, (60.0, 60.0), 0.0).T


def test_two_tied_channels_decay_together_and_apart_with_their_own_times():
    one, other = tied(Stray((0, 1), 25.0, passes_Hz=1e5))  # no resistance to speak of
    later = TIME > TOUCH_S + 0.1
    since = TIME[later] - TOUCH_S - 0.02
    np.testing.assert_allclose((one + other)[later], 5.0 * np.exp(-since / 0.5), rtol=5e-3)
    np.testing.assert_allclose((one - other)[later], 500.0 / 150.0 * np.exp(-since / 0.75), rtol=5e-3)


def test_the_resistance_of_a_stray_keeps_it_from_acting_at_once():
    slow, fast = (tied(Stray((0, 1), 25.0, passes_Hz=hertz), Amplifier(None, 40.0))[1] for hertz in (2.0, 1e5))
    early = np.searchsorted(TIME, TOUCH_S + 0.05)
    assert slow[early] < 0.7 * fast[early]
    # at last the charges are those of the capacitances alone: 500 pC C_m / (C (C + 2 C_m))
    assert slow[-1] == pytest.approx(fast[-1], rel=1e-3)
    assert fast[-1] == pytest.approx(500.0 * 25.0 / (100.0 * 150.0), rel=1e-3)


def test_channels_that_nothing_ties_are_as_alone():
    charge = np.column_stack([np.sin(3.0 * TIME) ** 2, np.sin(2.0 * TIME) ** 2])
    together = voltages(AMPLIFIER, Wiring(leak_MOhm={1: 5000.0}), TIME, charge, (60.0, 80.0), 0.0)
    np.testing.assert_allclose(together[:, 0], AMPLIFIER.voltage(TIME, charge[:, 0], 60.0, 0.0))
    leaking = Amplifier(2500.0, 40.0)
    np.testing.assert_allclose(together[:, 1], leaking.voltage(TIME, charge[:, 1], 80.0, 0.0))


@pytest.mark.press
def test_electrodes_share_the_charge_of_one_electrode_all_over():
    whole = replace(SHORT, electrodes=((-2.0, 0.0), (0.0, 2.0)))
    charges = pressed(whole, 0.5).charges_pC
    assert len(charges) == 2
    assert charges[1] > charges[0]
    assert sum(charges) == pytest.approx(pressed(replace(whole, electrodes=((-2.0, 2.0),)), 0.5).charge_pC, rel=0.02)


@pytest.mark.press
def test_a_press_on_the_other_side_is_the_image_of_the_first():
    right, left = (table(replace(SHORT, offset_mm=place), 0.1).course for place in (1.0, -1.0))
    np.testing.assert_allclose(left.charge_pC, right.charge_pC[:, ::-1])
    other = pressed(replace(SHORT, offset_mm=-1.0), 0.0, 0.1)
    assert left.charge_pC[-1] == pytest.approx(other.charges_pC, rel=1e-2)
    assert left.force_N[-1] == pytest.approx(other.force_N, rel=1e-2)


def pressed(made, offset_mm, depth_mm=0.05):
    stack = Stack(replace(made, offset_mm=made.offset_mm + offset_mm))
    state = stack.press(stack.press(stack.rest(), 0.5 * depth_mm, 1.0), depth_mm, 1.0)
    return stack.answer(state)


def test_only_a_rig_with_channels_can_have_crosstalk():
    assert fits("crosstalk-1-3", ROW)
    assert not fits("crosstalk-1-3", CLAMPED)
    belief = baseline(ROW)
    (stray,) = apply_effects(belief, ROW, {"crosstalk-1-3": 2.0}).wiring.strays
    assert stray.between == (0, 2)
    assert EFFECTS["crosstalk-1-3"].truth(ROW, 2.0)["capacitance_pF"] == pytest.approx(stray.capacitance_pF)


def test_every_channel_has_gain_lag_and_offset_of_its_own():
    assert len(keys("gain", ROW)) == len(ROW.runs) * 3
    assert keys("force_gain", ROW) == [("force_gain", run) for run in range(len(ROW.runs))]
    assert keys("gain", CLAMPED) == [("gain", run) for run in range(len(CLAMPED.runs))]


def test_a_plan_of_one_mechanism_hides_nothing_else_and_every_pair_in_turn():
    cases = plan(9, 0, (ROW.name,), staged=False, kinds=(SINGLE,), mechanisms=("crosstalk",))
    assert [case.effects[0] for case in cases[:3]] == ["crosstalk-1-2", "crosstalk-2-3", "crosstalk-1-3"]
    assert {EFFECTS[case.effects[0]].mechanism for case in cases} == {"crosstalk"}
    assert [case.size for case in cases[::3]] == [5.0, 10.0, 2.0]


def test_rigs_without_channels_hide_what_they_hid_before():
    cases = plan(400, 0, (CLAMPED.name,), staged=False, kinds=(SINGLE,))
    assert not any(EFFECTS[name].channels for case in cases for name in case.effects)
