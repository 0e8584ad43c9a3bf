"""The reader of a line that slides by: what must hold of it whatever the line."""

import json
from dataclasses import replace
from functools import cache
from itertools import permutations

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.braille_standards import standard
from softdot.reading.calibration import calibrate
from softdot.reading.calibration_file import load_calibration, widened
from softdot.reading.cells import cells_of, text_of
from softdot.reading.conditions import HAND
from softdot.reading.decoders.hand import decode, track_hand
from softdot.reading.decoders.onset import NoDotError
from softdot.reading.lead_order import likelier_order
from softdot.reading.line_filter.charge import ChargeBlocks
from softdot.reading.line_filter.line_reader import LineReader
from softdot.reading.line_filter.mains import hum_frequency_Hz, hum_state, without_hum
from softdot.reading.line_filter.table import OFFSETS_MM, YAWS_DEG, line_table
from softdot.reading.told_line import track_warnings
from softdot.reading.voltages import Reader, Voltages
from tests.cases import for_each
from tests.softdot.reading.lines import READOUT, simulated
from tests.softdot.reading.made_kernel import made_kernel

pytestmark = pytest.mark.press

TEXT = "read by touch"
MARBURG = standard("marburg-medium")
FAST = {"speed_mm_per_s": 50.0, "seed": 3}


@cache
def shared_kernel():
    return made_kernel()


@cache
def line(**changed):
    """The reader and the voltages of the text."""
    return simulated(shared_kernel(), cells_of(TEXT), **{**FAST, **changed})


@cache
def track_of(**changed):
    return track_hand(*line(**changed))


def in_parts(voltage, length):
    """The cells of voltages that come in parts, and how many were given out before the last part."""
    reader = LineReader(shared_kernel(), MARBURG, READOUT, 500.0)
    found = []
    for begin in range(0, len(voltage), length):
        found += reader.push(voltage[begin : begin + length])
    early = len(found)
    return found + reader.finish(), early


def test_parts_of_any_length_give_the_same_cells():
    """To the last bit, and most of them before the end."""
    voltage = line()[1].voltage_V
    whole, _ = in_parts(voltage, len(voltage))
    assert text_of([one.cell for one in whole]) == TEXT
    parts, early = in_parts(voltage, 37)
    assert parts == whole
    assert early >= len(whole) - 5


def test_what_comes_later_changes_no_cell_that_was_given_out():
    voltage = line()[1].voltage_V
    cut = len(voltage) * 3 // 4
    other = np.concatenate([voltage[:cut], np.random.default_rng(0).normal(0.0, 0.05, (400, 6))])
    readers = [LineReader(shared_kernel(), MARBURG, READOUT, 500.0) for _ in range(2)]
    early = [reader.push(whole[:cut]) for reader, whole in zip(readers, (voltage, other), strict=True)]
    assert early[0] == early[1]
    assert len(early[0]) >= 3


@for_each(
    "changed",
    [
        {"leftward": True, "reversed_all": True, "dead_channel": 3.0},
        {"hum_mV": 20.0, "hum_Hz": 47.3, "hum_third": 0.2, "gain_scatter": 0.2},
        {"speed_cv": 0.2, "pauses": 1.0, "ways_back": 1.0},
    ],
)
def test_what_a_hand_does_is_read_through(changed):
    assert text_of(track_of(**changed).cells) == TEXT


def test_what_was_found_of_the_line_is_told():
    report = track_of(leftward=True, reversed_all=True, dead_channel=3.0).report
    assert report.leftward
    assert report.dead == (3,)
    assert (np.delete(report.gain, 2) < 0.0).all()
    humming = track_of(hum_mV=20.0, hum_Hz=47.3, hum_third=0.2, gain_scatter=0.2).report
    assert humming.hum_Hz == pytest.approx(47.3, abs=0.05)


def test_resting_voltages_that_drift_are_not_taken_for_gains():
    """By 60 mV in some 10 s, each channel in its own way; all gains are 1."""
    track = track_of(drift_mV=60.0, speed_mm_per_s=30.0)
    assert text_of(track.cells) == TEXT
    np.testing.assert_allclose(track.report.gain, 1.0, atol=0.35)


def test_a_constant_factor_changes_nothing():
    """Charges are compared with those of the first seconds."""
    voltage = line()[1].voltage_V
    many, one = (in_parts(factor * voltage, 500)[0] for factor in (-4.0, 1.0))
    assert [cell.cell for cell in many] == [cell.cell for cell in one]


@for_each(("factor", "told"), [(0.5, "gain: the charges are 0."), (1.0, None), (2.0, "gain: the charges are ")])
def test_charges_that_are_far_from_those_of_the_kernel_are_told(factor, told):
    """What is read is the same; half and twice the charges are of another gain, array or depth."""
    reader, heard = line()
    track = track_hand(reader, Voltages(heard.time_s, factor * heard.voltage_V))
    assert text_of(track.cells) == TEXT
    gains = [one for one in track_warnings(track, reader.kernel.about["labels"]) if one.startswith("gain: ")]
    assert len(gains) == (told is not None)
    assert all(one.startswith(told) for one in gains)


@for_each("hum_mV", [0.0, 20.0])
def test_silence_is_no_text(hum_mV):
    reader, heard = line()
    noise = 1e-3 * np.random.default_rng(0).standard_normal(heard.voltage_V.shape)
    hum = 1e-3 * hum_mV * np.sin(2.0 * np.pi * 51.0 * heard.time_s)[:, None]
    with pytest.raises(NoDotError, match="nothing stands out of their noise"):
        track_hand(reader, Voltages(heard.time_s, noise + hum))


def test_what_is_no_braille_is_not_certain():
    """Channels that have nothing to do with each other: each is later than the one before by an eighth of a second."""
    reader, heard = line()
    apart = np.stack([np.roll(one, 62 * j) for j, one in enumerate(heard.voltage_V.T)], axis=1)
    track = track_hand(reader, Voltages(heard.time_s, apart))
    assert not track.is_braille
    assert not track.is_whole


def test_bad_voltages_are_one_sentence():
    reader = LineReader(shared_kernel(), MARBURG, READOUT, 500.0)
    with pytest.raises(InputError, match=r"voltages: have the size \(3, 5\), the kernel has 6 segments"):
        reader.push(np.zeros((3, 5)))
    with pytest.raises(InputError, match="not finite"):
        reader.push(np.full((3, 6), np.nan))


def test_the_table_holds_the_charges_of_the_kernel():
    """Dots of two columns at the places that the table is for, single ones turned too."""
    kernel = shared_kernel()
    table = line_table(kernel, MARBURG, is_mirrored=False)
    depth = 0.75 * kernel.depth_mm[-1]
    random = np.random.default_rng(2)
    for row in random.integers(0, len(table.within), 20):
        place = (row + 0.5) * table.step_mm + 0.5 * table.cell_pitch_mm  # of the array's middle
        columns = np.array([0.0, 2.5, 6.0, 8.5, 12.0])
        x = np.sort(columns[columns > place - 3.0])[:2] - place
        pattern, offset = int(random.integers(1, 64)), int(random.integers(0, len(OFFSETS_MM)))
        there = [(x[dot // 3], 2.5 * (dot % 3 - 1) - OFFSETS_MM[offset]) for dot in range(6) if pattern >> dot & 1]
        at = np.array(there).T[:, None, :]
        exact = kernel.of_many(at[0], at[1], np.full(at[0].shape, depth))[0][0]
        dots = [dot for dot in range(6) if pattern >> dot & 1]
        found = table.lone[len(YAWS_DEG) // 2, row, offset, dots].sum(axis=0) + table.beside[row, offset, pattern]
        np.testing.assert_allclose(found, exact, atol=0.03 * table.largest_pC)


def test_blocks_of_charge_are_the_integral():
    """A constant 1 V on 20 pF and 10 MOhm: 20 pC, and 100 nC a second."""
    blocks = ChargeBlocks(np.full(1, 20e-12), np.full(1, 1e7), np.zeros(1), 5, 1e-3)
    charge = blocks.add(np.ones((10, 1)))[:, 0]
    np.testing.assert_allclose(charge, 20.0 + 100.0 * (np.array([3.0, 8.0]) - 0.5))


def test_a_drifting_hum_is_followed():
    """From 57.2 Hz on by 0.1 Hz in 10 s, with a third harmonic: a twentieth is left."""
    time = np.arange(5000) / 500.0
    phase = 2.0 * np.pi * (57.2 * time + 0.005 * time**2)
    hum = np.stack([np.sin(phase) + 0.2 * np.sin(3.0 * phase), -0.5 * np.sin(phase)], axis=1)
    frequency = hum_frequency_Hz(hum[:1000], 500.0)
    state, amplitude = hum_state(hum[:1000], 500.0, frequency)
    rest = without_hum(hum, state, amplitude, 2.0 * np.pi * 0.5 / 500.0)
    assert np.abs(rest[1000:]).max() < 0.05 * 1.2
    assert state[0] * 500.0 / (2.0 * np.pi) == pytest.approx(57.3, abs=0.02)


def test_the_preset_of_a_hand_is_read():
    track = track_hand(*line(**HAND, seed=5))
    assert text_of(track.cells) == TEXT


def test_rows_and_columns_of_leads_that_are_exchanged_are_told_by_the_cells():
    """Whichever of them; text as it is and cells at random are left alone."""
    cells = cells_of("what a hand reads it need not read with its eyes")
    assert likelier_order(cells) is None
    assert likelier_order(np.random.default_rng(3).integers(1, 64, 60)) is None
    bits = (cells[:, None] >> np.arange(6)) & 1
    for rows in permutations(range(3)):
        for columns in ((0, 1), (1, 0)):
            dots = [3 * column + row for column in columns for row in rows]
            if dots != list(range(6)):
                assert likelier_order(bits[:, dots] @ (1 << np.arange(6))) is not None, dots


@for_each(
    "wiring", ["two leads of two rows", "shifted by one", "order reversed", "columns", "one reversed", "row dead"]
)
def test_a_wrong_wiring_is_never_silent(wiring):
    """A sentence is told, and no text but the right one is given out."""
    reader, heard = line(speed_cv=0.1)
    orders = {"two leads of two rows": [5, 1, 2, 3, 4, 0], "shifted by one": [1, 2, 3, 4, 5, 0],
              "order reversed": [5, 4, 3, 2, 1, 0], "columns": [1, 0, 3, 2, 5, 4]}  # fmt: skip
    voltage = heard.voltage_V[:, orders.get(wiring, [0, 1, 2, 3, 4, 5])]
    voltage[:, 2] *= -1.0 if wiring == "one reversed" else 1.0
    if wiring == "row dead":
        voltage[:, 2:4] = 1e-3 * np.random.default_rng(0).standard_normal((len(voltage), 2))
    track = track_hand(reader, Voltages(heard.time_s, voltage))
    assert track_warnings(track, reader.kernel.about["labels"])
    assert text_of(decode(track).cells) == TEXT or not track.is_whole


def test_a_known_line_tells_leads_gains_and_width(tmp_path):
    """Of a sensor with 0.8 of the charges over places 5 % wider, whose leads are mixed up and turned."""
    order, text = [3, 4, 2, 6, 5, 1], "touch and read by hand"
    kernel = shared_kernel()
    wide = widened(replace(kernel, charge_pC=0.8 * kernel.charge_pC), 1.05)
    _, heard = simulated(wide, cells_of(text), speed_cv=0.1, **FAST)
    assert track_hand(Reader(kernel, MARBURG, READOUT), heard).report.width == pytest.approx(1.05, abs=0.03)
    mixed = np.empty_like(heard.voltage_V)
    mixed[:, np.array(order) - 1] = -heard.voltage_V
    found = calibrate(Reader(kernel, MARBURG, READOUT), Voltages(heard.time_s, mixed), cells_of(text))
    assert found.order == order
    assert found.polarity == [-1] * 6
    assert found.scale.low < 0.8 < found.scale.high
    assert found.width == pytest.approx(1.05, abs=0.03)
    np.testing.assert_allclose([one.value for one in found.gain], 0.8, rtol=0.08)
    (tmp_path / "calibration.json").write_text(json.dumps({"format": "softdot-calibration/1", **found.model_dump()}))
    assert load_calibration(tmp_path, kernel) == found
    other = replace(kernel, about={**kernel.about, "config_hash": "0" * 64})
    with pytest.raises(InputError, match="is of another design"):
        load_calibration(tmp_path / "calibration.json", other)
    with pytest.raises(InputError, match="has 2 cells, at least 8 are needed"):
        calibrate(Reader(kernel, MARBURG, READOUT), heard, cells_of("ab"))
