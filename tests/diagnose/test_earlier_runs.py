"""What softens or yields remembers how far it went: a run is answered as the end of one long run would be."""

from dataclasses import replace

import numpy as np
import pytest

from diagnose.engines.coupon.engine import coupon_engine
from diagnose.engines.proportional.engine import proportional_engine
from diagnose.forward import Setting
from diagnose.signals.recording import Recording, Run, with_earlier_drives
from softdot.config.rig import load_rig
from tests.cases import for_each
from tests.diagnose.coupon.coupons import RUBBER, silent, specimen
from tests.diagnose.rigs import COUPON, HEAD, SEGMENT, csv_text, samples, trapezoid, write_rig
from tests.diagnose.segment import rigs

STEP_S = 0.02
HALF = np.arange(0.0, 4.0, STEP_S)
TIME = rigs.run().time_s
QUICK = {"touch_s": 0.1, "rise_s": 0.2, "hold_s": 0.1}


def pull(largest):
    """In and out within 4 s."""
    return largest * np.interp(HALF, [0.5, 1.5, 2.5, 3.5], [0.0, 1.0, 1.0, 0.0])


def run(drive, values, answer):
    """One with an answer that is made up."""
    channels = {drive: values, answer: 0.2 * values}
    there = {name: np.ones(len(values), dtype=bool) for name in channels}
    none = {name: ~flags for name, flags in there.items()}
    return Run("run", "run.csv", STEP_S * np.arange(len(values)), drive, channels, there, none)


def whole_and_parts(drive, answer, first, second, coupon=None):
    """A recording of one long run, and one of its halves, the second after the first."""
    halves = pull(first), pull(second)
    one, other = (run(drive, half, answer) for half in halves)
    parts = with_earlier_drives([one, replace(other, virgin=False)])
    return Recording((run(drive, np.concatenate(halves), answer),), coupon), Recording(tuple(parts), coupon)


def softened(of):
    """A third of the stress is lost."""
    candidate = next(one for one in of.candidates if one.mechanism == "stress-softening")
    return [Setting(candidate, (0.3, *[0.0] * (len(candidate.coordinates) - 1)))]


def second_half(whole, parts, answer):
    """What both say of it, in terms of its peak, and what a virgin specimen would do."""
    expected = whole.predict(0, softened(whole))[answer][len(HALF) :]
    virgin = parts.imagine(replace(parts.recording.runs[1], largest_before={}), softened(parts))[answer]
    told = parts.predict(1, softened(parts))[answer]
    return (signal / np.abs(expected).max() for signal in (expected, told, virgin))


@for_each("drive", ["displacement_mm", "force_N"])
@for_each("second", [3.0, 7.0])
def test_a_coupon_that_was_pulled_before_is_softer_up_to_there(drive, second):
    answer = "force_N" if drive == "displacement_mm" else "displacement_mm"
    recordings = whole_and_parts(drive, answer, 5.0, second, specimen())
    expected, told, virgin = second_half(*(coupon_engine(one, {"mine": RUBBER}, silent) for one in recordings), answer)
    np.testing.assert_allclose(told, expected, atol=1e-6)
    assert np.abs(virgin - expected).max() > 0.02


def test_a_sensor_of_unknown_geometry_that_was_pressed_before_is_softer():
    recordings = whole_and_parts("force_N", "voltage_V", 3.0, 2.0)
    expected, told, virgin = second_half(*(proportional_engine(one, silent) for one in recordings), "voltage_V")
    np.testing.assert_allclose(told, expected, atol=1e-6)
    assert np.abs(virgin - expected).max() > 0.02


@pytest.mark.press
def test_a_segment_that_was_pressed_deeper_before_is_softer():
    """As the 3D model that was pressed deeper first."""
    deep, shallow = (rigs.run(values=rigs.press(TIME, depth, **QUICK), label=f"{depth}") for depth in (0.25, 0.18))
    of = rigs.engine(*with_earlier_drives([deep, replace(shallow, virgin=False)]))
    (setting,) = softened(of)
    of.prepare([setting.candidate], silent)
    told, true = of.predict(1, [setting]), of.solve(1, [setting.candidate.as_mechanism(setting.values)], silent)
    virgin = of.imagine(shallow, [setting])
    for name, signal in true.items():
        peak = np.abs(signal).max()
        assert np.abs(told[name] - signal).max() < 0.03 * peak
        assert np.abs(virgin[name] - signal).max() > 0.2 * peak


@pytest.mark.parametrize(
    ("body", "virgin", "before"),
    [(SEGMENT, "", {"displacement_mm": 0.3}), (SEGMENT, "virgin = true", {}), (COUPON, "", {})],
)
def test_the_runs_of_a_segment_follow_each_other_and_a_coupon_is_new_in_each(tmp_path, body, virgin, before):
    columns = {**samples(), "force_N": samples()["voltage_V"]}
    if body is COUPON:
        del columns["voltage_V"]
    text = f'{HEAD}{body}[[runs]]\nfile = "a.csv"\n[[runs]]\nfile = "b.csv"\n{virgin}\n'
    recording = load_rig(write_rig(tmp_path / "rig", text, a=columns, b=columns)).recording
    assert [dict(run.largest_before) for run in recording.runs] == [{}, pytest.approx(before)]


def test_a_run_at_another_place_presses_what_is_new(tmp_path):
    text = f"{HEAD}{SEGMENT}" + "".join(
        f'[[runs]]\nfile = "{name}.csv"\ndot_offset_mm = [{x}, 0.0]\n'
        for name, x in (("a", 0.0), ("b", 0.3), ("c", 0.0))
    )
    deep = {**samples(), "displacement_mm": trapezoid(samples()["time_s"], 0.4)}
    folder = write_rig(tmp_path / "rig", text, a=csv_text(deep), b=samples(), c=samples())
    recording = load_rig(folder).recording
    assert [run.largest_before for run in recording.runs] == [{}, {}, {"displacement_mm": pytest.approx(0.4)}]
    new = recording.as_next_run(recording.runs[1])
    assert new.largest_before == {"displacement_mm": pytest.approx(0.3)}


def test_the_next_press_of_a_coupon_is_made_on_a_new_one():
    recording = whole_and_parts("displacement_mm", "force_N", 5.0, 3.0, specimen())[1]
    assert recording.as_next_run(recording.runs[1]).largest_before == {}
