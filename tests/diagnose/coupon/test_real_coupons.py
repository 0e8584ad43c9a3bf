"""Real coupons of other laboratories with their forces shuffled: nothing is left to find."""

from dataclasses import replace

import pytest

from diagnose.inference.diagnose import diagnose
from softdot.commands.diagnose import engine_for
from softdot.config.rig import load_rig
from tests.diagnose.real import NEEDED, control, converted, silent

pytestmark = NEEDED


@pytest.mark.parametrize("data", ["silicones-tensile", "rubber-treloar", "vhb-relaxation", "adhesive-shear"])
def test_forces_of_other_pulls_name_nothing(data, tmp_path):
    converted(data, tmp_path / "out")
    for rig_file in sorted((tmp_path / "out").rglob("rig.toml")):
        rig = load_rig(rig_file.parent)
        rig = replace(rig, recording=control("shuffled")(rig.recording))
        found = diagnose(rig.recording, engine_for(rig, silent), 0, silent)
        assert found.mismatch
        assert found.best is None, rig_file.parent.name
