"""The diagnosis' table and the hidden world, two codes with nothing in common, on the same presses."""

import numpy as np
import pytest

from diagnose.prove.folder import files
from diagnose.prove.world.bench import BENCHES
from diagnose.prove.world.reality import baseline, record
from diagnose.prove.world.stack import Stack
from softdot.diagnosis.engines import engine_for
from softdot.rig_file import load_rig

SHARES = np.array([0.1, 0.25, 0.5, 0.75, 1.0])


def hidden(bench, depths_mm):
    """Force in N and charge in C of the hidden world."""
    stack, found = Stack(bench.made), []
    state = stack.rest()
    for depth in depths_mm:
        state = stack.press(state, float(depth), 1.0)
        answer = stack.answer(state)
        found.append((answer.force_N, 1e-12 * answer.charge_pC))
    return np.array(found)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ridge-clamped", "ridge-free", "dot-clamped"])
def test_force_and_charge_of_a_press_agree(name, tmp_path):
    bench = BENCHES[name]
    for file, text in files(bench, record(baseline(bench), bench)).items():
        (tmp_path / file).write_text(text, "utf-8")
    told = engine_for(load_rig(tmp_path), lambda *_: None)
    depths = SHARES * bench.deepest_mm
    table, of = told.prepared.fit.table[:, 0], np.linspace(0.0, told.prepared.depth_mm, len(told.prepared.fit.table))
    mine = np.column_stack([np.interp(depths, of, table[:, n]) for n in (0, 2)])
    true = hidden(bench, depths)
    allowed = [3.0 * told.accuracy[channel] for channel in ("force_N", "voltage_V")]
    assert np.all(np.abs(mine / true - 1.0) < allowed)
