"""The example recording, from the 3D model to the verdict, as the document says it goes."""

import json

import numpy as np
import pytest

from examples.recordings.leaky_amplifier import LEAK_MOHM, make, motion
from softdot.cli import main
from softdot.config.loading import load_config
from softdot.config.rig import load_rig
from softdot.diagnosis import folder as engines
from tests.diagnose.verdict.test_verdict import SHAPE, require


def test_the_motion_is_the_one_that_is_asked_for():
    time = np.arange(0.0, 6.0, 0.01)
    depth = motion(time, 0.3, 0.5, 1.0)
    assert (depth[0], depth[-1]) == (-0.1, -0.1)
    assert time[depth >= 0.3 - 1e-9] == pytest.approx(np.arange(2.0, 3.005, 0.01))
    assert np.interp(1.5, time, depth) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.evidence
def test_the_leak_is_named_with_its_resistance(tmp_path, monkeypatch):
    """Among the candidates of the amplifier, which need no press of the 3D model but the baseline's."""
    engine_for = engines.engine_for

    def of_the_amplifier(rig, report, executor):
        engine = engine_for(rig, report, executor)
        engine.candidates = tuple(one for one in engine.candidates if one.component == "readout")
        return engine

    monkeypatch.setattr(engines, "engine_for", of_the_amplifier)
    make(tmp_path / "leaky")
    assert load_rig(tmp_path / "leaky").recording.warnings == ()
    assert main(["diagnose", str(tmp_path / "leaky"), "-o", str(tmp_path / "out")]) == 0
    verdict = json.loads((tmp_path / "out" / "verdict.json").read_text("utf-8"))
    require(verdict, SHAPE)
    (missing,) = verdict["missing_physics"]
    assert (missing["mechanism"], missing["component"]) == ("charge-leakage", "readout")
    resistance = missing["parameters"]["resistance_MOhm"]
    assert resistance["low"] <= LEAK_MOHM <= resistance["high"]
    assert resistance["high"] < 1.3 * resistance["low"]
    held_out = verdict["fit"]["held_out"]
    assert held_out["nrmse_after"] < 1.2 * held_out["noise_floor_nrmse"]
    assert [one["engine"] for one in verdict["fit"]["resimulated"]] == ["3D FEM", "3D FEM"]
    assert load_config(tmp_path / "out" / "improved.toml").mechanisms[0].name == "charge-leakage"
