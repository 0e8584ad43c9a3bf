"""Real coupons of other laboratories with their forces shuffled: nothing is left to find."""

import os
import runpy
from dataclasses import replace
from pathlib import Path

import pytest

from diagnose.inference.diagnose import diagnose
from softdot.diagnosis.engines import engine_for
from softdot.rig_file import load_rig

RECORDINGS = os.environ.get("SOFTDOT_RECORDINGS", "")
EXAMPLES = Path(__file__).parents[3] / "examples" / "recordings"
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not RECORDINGS, reason="licences forbid copies here; SOFTDOT_RECORDINGS names their folder"),
]


def silent(*_):
    """A report that nobody reads."""


@pytest.mark.parametrize("data", ["silicones-tensile", "rubber-treloar", "vhb-relaxation", "adhesive-shear"])
def test_forces_of_other_pulls_name_nothing(data, tmp_path):
    runpy.run_path(str(EXAMPLES / f"{data.replace('-', '_')}.py"))["convert"](Path(RECORDINGS) / data, tmp_path / "out")
    shuffled = runpy.run_path(str(EXAMPLES / "controls.py"))["shuffled"]
    for rig_file in sorted((tmp_path / "out").rglob("rig.toml")):
        rig = load_rig(rig_file.parent)
        rig = replace(rig, recording=shuffled(rig.recording))
        found = diagnose(rig.recording, engine_for(rig, silent), 0, silent)
        assert found.mismatch
        assert found.best is None, rig_file.parent.name
