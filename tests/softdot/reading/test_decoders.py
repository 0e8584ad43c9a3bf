"""What decoders read from the voltages alone."""

import numpy as np
import pytest

from softdot.reading.cells import cells_of, text_of
from softdot.reading.decoders import learned
from softdot.reading.decoders.onset import NoDotError
from softdot.reading.decoders.track import track_slide
from softdot.reading.line import DotLine
from softdot.reading.voltages import Voltages
from solve.model import Readout
from tests.cases import for_each
from tests.softdot.reading.lines import NOMINAL, read, share, simulated

EVERY = np.concatenate([np.random.default_rng(1).permutation(np.arange(1, 64)), [0, 1]])
"""All 64 cells; a blank at an end would not be seen."""
TEXT = "soft dots, read by touch"


@pytest.mark.press
@for_each(("speed", "offset"), [(5.0, 0.3), (17.0, 0.0), (50.0, -0.4)])
def test_every_cell_is_read_at_any_speed_and_offset(kernel, speed, offset):
    """Nominal dots, no noise; speed and offset are not told."""
    reader, heard = simulated(kernel, EVERY, speed_mm_per_s=speed, offset_mm=offset, **NOMINAL)
    np.testing.assert_array_equal(read(reader, heard), EVERY)


def test_speed_and_yaw_are_found(kernel):
    reader, heard = simulated(kernel, EVERY[:30], speed_mm_per_s=12.5, yaw_deg=4.0)
    track = track_slide(reader, heard)
    assert track.posture.speed_mm_per_s == pytest.approx(12.5, rel=5e-3)
    assert track.posture.yaw_deg == pytest.approx(4.0, abs=1.6)
    np.testing.assert_allclose(np.diff(track.passed_s), 6.0 / 12.5, rtol=0.02)


@pytest.mark.press
@for_each(
    "readout",
    [Readout(), Readout(mode="charge", feedback_pF=100.0, feedback_MOhm=1000.0, low_pass_Hz=80.0)],
)
def test_other_amplifiers_are_read_too(kernel, readout):
    reader, heard = simulated(kernel, EVERY[:40], readout=readout)
    np.testing.assert_array_equal(read(reader, heard), EVERY[:40])


def test_the_gain_does_not_matter(kernel):
    cells = cells_of(TEXT)
    reader, heard = simulated(kernel, cells)
    assert text_of(read(reader, Voltages(heard.time_s + 100.0, 3.7 * heard.voltage_V))) == TEXT


@pytest.mark.press
def test_less_is_read_the_louder_the_noise(kernel):
    cells = cells_of(TEXT)
    found = []
    for noise in (1.0, 25.0):
        reader, heard = simulated(kernel, cells, noise_mV=noise)
        try:
            found.append(share(cells, read(reader, heard)))
        except NoDotError:
            found.append(0.0)
    assert found[0] == 1.0
    assert found[1] < 0.9


def test_a_missing_dot_is_read_as_missing(kernel):
    """Dot 6 of the second of three full cells."""

    def without_one(line):
        kept = ~((np.abs(line.x_mm - 7.25) < 0.2) & (line.y_mm > 2.0))
        assert kept.sum() == len(kept) - 1
        return DotLine(line.x_mm[kept], line.y_mm[kept], line.extra_mm[kept])

    reader, heard = simulated(kernel, np.array([63, 63, 63, 27]), change=without_one)
    assert read(reader, heard).tolist() == [63, 31, 63, 27]


@pytest.mark.press
def test_worn_dots_and_hum_are_read_through(kernel):
    """A third of the dots a tenth of a millimetre lower, and a hum ten times the noise."""
    cells = cells_of(TEXT)
    reader, heard = simulated(kernel, cells, worn=0.3, hum_mV=10.0)
    assert share(cells, read(reader, heard)) > 0.95


@pytest.mark.press
def test_a_line_with_dots_in_one_column_is_read_as_its_left_one(kernel):
    """Nothing tells the columns apart."""
    reader, heard = simulated(kernel, cells_of("label".replace("e", "k")))
    assert text_of(read(reader, heard)) == "labkl"


@pytest.mark.press
@pytest.mark.parametrize("name", ["threshold", "learned"])
def test_the_other_decoders_read_a_plain_line(kernel, name, monkeypatch):
    monkeypatch.setattr(learned, "TRAINING_CELLS", 320)
    cells = cells_of(TEXT)
    reader, heard = simulated(kernel, cells, noise_mV=0.5)
    assert share(cells, read(reader, heard, name)) > 0.9


@pytest.mark.press
@for_each("name", ["model", "threshold"])
def test_every_cell_is_read_by_pressing(kernel, name):
    reader, heard = simulated(kernel, EVERY, mode="press", noise_mV=0.2, offset_mm=0.2)
    np.testing.assert_array_equal(read(reader, heard, name), EVERY)


def test_silence_is_no_text(kernel):
    reader, heard = simulated(kernel, np.array([1]))
    noise = 1e-3 * np.random.default_rng(0).standard_normal(heard.voltage_V.shape)
    with pytest.raises(NoDotError, match="nothing stands out of their noise"):
        track_slide(reader, Voltages(heard.time_s, noise))
