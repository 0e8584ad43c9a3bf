"""p as a product, its range, and the inputs that give a wanted p, from made-up presses."""

import numpy as np
import pytest

from softdot.studies.paper.calibration import contours
from softdot.studies.paper.calibration.answers import answers
from softdot.studies.paper.calibration.claims import claims, lost_more
from softdot.studies.paper.calibration.factor import BEAM, DIMENSION, FILTER, LEAKAGE, SPONGE, factor, factors
from softdot.studies.paper.calibration.inputs import INPUTS, assumed_inputs
from softdot.studies.paper.calibration.ranges import quantiles, ranges
from softdot.studies.paper.published import published_numbers
from tests.studies.paper.stand_in_rig import rig, solved

FEW = 6
"""2^6 samples are enough here."""
OPEN_CIRCUIT = assumed_inputs(resistance_MOhm=1e7, capacitance_pF=0.0)


@pytest.fixture(scope="module")
def spread():
    return ranges(rig(), FEW)


def test_the_pieces_are_what_each_step_takes_away_and_p_is_their_product():
    found = factor(solved(voltages=(40.0, 20.0, 10.0)), OPEN_CIRCUIT)
    assert found.pieces[DIMENSION] == pytest.approx(2.0)
    assert found.pieces[SPONGE] == pytest.approx(2.0)
    assert found.pieces[BEAM] == pytest.approx(1.0)
    assert found.pieces[LEAKAGE] == pytest.approx(1.0, rel=1e-3)
    assert found.pieces[FILTER] == pytest.approx(1.0, rel=1e-3)
    assert found.p == pytest.approx(4.0, rel=2e-3)
    assert sum(found.shares.values()) == pytest.approx(1.0)


def test_leakage_goes_with_press_time_over_resistance():
    slow, fast, tenfold = (
        factor(solved(), assumed_inputs(press_time_s=t, resistance_MOhm=r)).pieces[LEAKAGE]
        for t, r in ((0.4, 1.0), (0.2, 1.0), (0.4, 0.1))
    )
    assert slow == pytest.approx(2.0 * fast, rel=0.01)
    assert tenfold == pytest.approx(10.0 * slow, rel=0.01)


def test_maximum_minus_minimum_spans_press_and_release():
    """Peak R pi Q / 2 T in each direction, against Q / C at open circuit."""
    found = factor(solved(), assumed_inputs(press_time_s=0.4, resistance_MOhm=0.1))
    assert found.pieces[LEAKAGE] == pytest.approx(0.4 / (np.pi * 0.1e6 * 1000e-12), rel=0.01)


def test_the_search_gives_exactly_the_wanted_p():
    resistance = contours.resistance_for(solved(), 300.0, 0.3)
    found = factor(solved(), assumed_inputs(resistance_MOhm=resistance, press_time_s=0.3))
    assert found.p == pytest.approx(300.0, rel=1e-3)
    time = contours.time_for(solved(), 300.0, resistance)
    assert time == pytest.approx(0.3, rel=1e-3)
    assert contours.resistance_for(solved(), 1e7, 0.3) is None
    assert contours.time_for(solved(), 1e7, 1.0) is None


def test_the_range_covers_the_assumed_p_and_resistance_drives_it(spread):
    for case, found in factors(rig(), assumed_inputs()).items():
        p = spread.p(case)
        assert p.min() < found.p < p.max()
        drivers = spread.drivers(case)
        assert max(drivers, key=drivers.__getitem__) == "resistance_MOhm"
        assert sum(drivers.values()) == pytest.approx(1.0, abs=0.15)


def test_read_out_and_time_cancel_between_the_cases(spread):
    """Both cases share them: what is left is the twofold loss to the third dimension."""
    low, middle, high = quantiles(spread.ratio())
    assert middle == pytest.approx(2.0, rel=0.05)
    assert high / low < 1.6


def test_an_input_that_doubles_the_round_dot_voltage_halves_the_first_piece():
    one = solved(response=2.0)
    low, high = (factor(one, OPEN_CIRCUIT | {"foam_poisson_ratio": INPUTS["foam_poisson_ratio"].at(s)}) for s in (0, 1))
    assert high.pieces[SPONGE] == pytest.approx(low.pieces[SPONGE] / 2.0)


def test_a_smaller_film_loses_more_by_the_ratio_of_areas():
    assert lost_more(solved(), 40.0) == pytest.approx(6.4, rel=0.02)
    assert lost_more(solved(), 6.25) == pytest.approx(40.96, rel=0.02)


def test_every_number_of_section_two_has_an_answer_and_p_is_a_prediction():
    found = answers(factors(rig(), assumed_inputs()))
    keys = {k for k in published_numbers() if k.startswith(("table1.", "section2.p", "section2.h2", "section2.E2"))}
    assert set(found) == keys
    assert found["table1.I.p"].ours != published_numbers()["table1.I.p"].value


def test_the_claims_follow_the_numbers(spread):
    order, transfer, trend = claims(rig(), spread)
    assert order.holds is True
    assert transfer.holds is False
    assert trend.holds is True
    reversed_order = claims({"I": solved("I"), "II": solved("II", (400.0, 200.0, 100.0))}, spread)[0]
    assert reversed_order.holds is False
