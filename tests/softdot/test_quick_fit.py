"""softdot fit --only readout: R and C of made-up amplifiers from their voltages, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from diagnose.engines.readout_alone import ReadoutEngine
from diagnose.signals.recording import Recording, Run
from softdot.cli import main
from softdot.quick_fit.folder import table_text, warnings
from softdot.quick_fit.readout import fit_engine
from solve.model import Readout
from solve.physics import Physics
from tests.cases import for_each

TIME_S = np.arange(0.0, 6.0, 0.01)
DEPTHS_MM = 0.2, 0.3
WIDTHS = {"gain": 0.03, "offset_V": 0.5, "lag_s": 0.005}
GAIN, OFFSET_V, NOISE_V = 1.02, 0.3, 0.05


def pressed(depth_mm, rise_s=0.3):
    """Depth (t,) of a press from rest, held for a second, and back to rest."""
    corners = np.array([2.0, 2.0 + rise_s, 3.0 + rise_s, 3.0 + 2.0 * rise_s])
    return np.interp(TIME_S, corners, [-0.1, depth_mm, depth_mm, -0.1])


def engine_of(true, stated, moved=0.0):
    """Charges of 5 nC at 0.3 mm behind a true amplifier, recorded with noise; an engine that believes another one."""
    random, charge = np.random.default_rng(3), []
    runs = []
    for number, depth in enumerate(DEPTHS_MM):
        drive = pressed(depth)
        charge.append(5e-9 * np.clip(drive / 0.3, 0.0, None)[:, None] ** 1.5)
        good = np.ones(len(TIME_S), dtype=bool)
        same = {"displacement_mm": good, "voltage_V": good}
        runs.append(Run(
            f"press {number}", f"{number}.csv", TIME_S, "displacement_mm",
            {"displacement_mm": drive, "voltage_V": np.zeros(len(TIME_S))}, same, {k: ~v for k, v in same.items()},
            nuisance=WIDTHS,
        ))  # fmt: skip
    engine = ReadoutEngine(Recording(tuple(runs)), tuple(charge), np.array([1e-10]), true, Physics(), 0.0)
    for number, run in enumerate(runs):
        voltage = engine.predict(number, ())["voltage_V"] * (1.0 + moved * pressed(0.3) / 0.3)
        voltage = GAIN * voltage + OFFSET_V + NOISE_V * random.standard_normal(len(TIME_S))
        runs[number] = replace(run, channels={**run.channels, "voltage_V": voltage})
    return replace(engine, recording=Recording(tuple(runs)), readout=stated)


@pytest.mark.press
@for_each(
    ("true", "stated"),
    [
        ({"input_resistance_MOhm": 3e3, "input_capacitance_pF": 150.0},
         {"input_resistance_MOhm": 1e4, "input_capacitance_pF": 100.0}),
        ({"input_resistance_MOhm": 2e4, "input_capacitance_pF": 100.0}, {"input_capacitance_pF": 100.0}),
        ({"mode": "charge", "feedback_pF": 300.0, "feedback_MOhm": 4e3},
         {"mode": "charge", "feedback_pF": 220.0, "feedback_MOhm": 1e4}),
    ],
)  # fmt: skip
def test_resistance_and_capacitance_are_found_with_their_intervals(true, stated):
    engine = engine_of(Readout(**true), Readout(**stated))
    fit = fit_engine(engine, lambda *_: None)
    for key in engine.keys:
        interval = fit.intervals[key]
        assert interval.low < true[key] < interval.high
        assert fit.sigmas[fit.names.index(key)] == pytest.approx((interval.high - interval.low) / 3.29, rel=0.2)
    assert fit.misfit == pytest.approx(1.0, abs=0.1)
    assert warnings(fit) == []
    offset = fit.names.index("offset_V of press 0")
    assert abs(fit.values[offset] - OFFSET_V) < 4.0 * fit.sigmas[offset]
    # charge over capacitance tells a gain from a capacitance only as far as the gain is known
    assert abs(fit.correlation[1, fit.names.index("gain of press 0")]) > 0.5
    text = table_text(fit)
    assert all(f"{name}:" in text for name in fit.names)
    assert f"C({engine.keys[0]}, {engine.keys[1]})" in text


def test_what_an_amplifier_does_not_explain_is_told():
    stated = Readout(input_resistance_MOhm=1e4, input_capacitance_pF=100.0)
    fit = fit_engine(engine_of(stated, stated, moved=0.5), lambda *_: None)
    assert any("something else than the read-out" in one for one in warnings(fit))


RIG = 'format = "softdot-recording/1"\ngeometry = "unknown"\n[[runs]]\nfile = "press.csv"\ndrive = "force_N"\n'


def test_a_rig_without_a_segment_is_refused_by_name(tmp_path, capsys):
    rows = "\n".join(f"{0.01 * n},{0.1 * n},{0.2 * n}" for n in range(60))
    (tmp_path / "rig.toml").write_text(RIG, "utf-8")
    (tmp_path / "press.csv").write_text(f"time_s,force_N,voltage_V\n{rows}\n", "utf-8")
    assert main(["fit", str(tmp_path), "--only", "readout", "-o", str(tmp_path / "out")]) == 2
    assert "geometry = 'unknown': --only readout needs the charges" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
