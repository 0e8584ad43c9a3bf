"""The diagnosis' table and the hidden world, two codes with nothing in common, on the same presses."""

from dataclasses import replace

import numpy as np
import pytest

from diagnose.engines.segment.presses import DEPTH_SHARES as SHARES_OF_CHANGES
from diagnose.forward import Setting
from softdot.config.rig import load_rig
from softdot.diagnosis.engine import engine_for
from softdot.studies.proof.recording_folder import files
from softdot.studies.proof.world.effects import apply_effects
from softdot.studies.proof.world.reality import baseline, record
from softdot.studies.proof.world.rigs import BENCHES
from softdot.studies.proof.world.stack import Stack

SHARES = np.array([0.1, 0.25, 0.5, 0.75, 1.0])


def hidden(made, depths_mm):
    """Force in N and charge in C of the hidden world."""
    stack, found = Stack(made), []
    state = stack.rest()
    for depth in depths_mm:
        state = stack.press(state, float(depth), 1.0)
        answer = stack.answer(state)
        found.append((answer.force_N, 1e-12 * answer.charge_pC))
    return np.array(found)


def silent(*_):
    """A report that nobody reads."""


def engine_of(bench, folder):
    """The diagnosis' model of a bench."""
    for file, text in files(bench, record(baseline(bench), bench)).items():
        (folder / file).write_text(text, "utf-8")
    return engine_for(load_rig(folder), silent)


@pytest.mark.evidence
@pytest.mark.parametrize("name", ["ridge-clamped", "ridge-free", "dot-clamped", "thick-clamped", "thick-free"])
def test_force_and_charge_of_a_press_agree(name, tmp_path):
    """From a tenth of the depth on; of thick layers from a quarter, as a tenth makes 0.2 % of the charge."""
    bench = BENCHES[name]
    told = engine_of(bench, tmp_path)
    depths = (SHARES[1:] if name.startswith("thick") else SHARES) * bench.deepest_mm
    table, of = (
        told.first_presses.fit.table[:, 0],
        np.linspace(0.0, told.first_presses.depth_mm, len(told.first_presses.fit.table)),
    )
    mine = np.column_stack([np.interp(depths, of, table[:, n]) for n in (0, 2)])
    true = hidden(bench.made, depths)
    allowed = [3.0 * told.accuracy[channel] for channel in ("force_N", "voltage_V")]
    assert np.all(np.abs(mine / true - 1.0) < allowed)


@pytest.mark.evidence
def test_a_medium_of_twice_the_modulus_changes_force_and_charge_alike(tmp_path):
    bench = BENCHES["ridge-free"]
    told = engine_of(bench, tmp_path)
    stiffer = next(one for one in told.candidates if one.name == ("property-error", "medium2"))
    told.prepare([stiffer], silent)
    twice = Setting(stiffer, tuple(np.log(2.0) if one.name == "modulus" else 0.0 for one in stiffer.coordinates))
    assert stiffer.parameters(twice.values)["modulus_factor"] == pytest.approx(2.0)
    mine = told.first_presses.table_change((0.0, 0.0), [twice])[:, [0, 2]]
    depths = np.array(SHARES_OF_CHANGES) * told.first_presses.depth_mm
    twice_as_stiff = apply_effects(baseline(bench), bench, {"modulus-medium2": 20.0}).made
    before, after = hidden(bench.made, depths), hidden(twice_as_stiff, depths)
    true = np.column_stack([np.log(after[:, 0] / before[:, 0]), (after[:, 1] - before[:, 1]) / before[:, 0]])
    assert np.all(np.abs(mine / true - 1.0) < 0.04)  # the diagnosis mesh itself would be 5 % off at the first depth


@pytest.mark.evidence
@pytest.mark.parametrize("name", ["ridge-clamped", "ridge-free"])
def test_a_base_that_has_come_apart_from_its_rims_changes_force_and_charge_alike(name, tmp_path):
    bench = BENCHES[name]
    told = engine_of(bench, tmp_path)
    loose = next(one for one in told.candidates if one.name == ("delamination", "bond-base"))
    setting = Setting(loose, tuple(0.5 if one.name == "rim" else 0.0 for one in loose.coordinates))
    told.prepare([loose], silent)
    told.refine([setting], silent)
    mine = told.first_presses.table_change((0.0, 0.0), [setting])[:, [0, 2]]
    depths = np.array(SHARES_OF_CHANGES) * told.first_presses.depth_mm
    half_loose = apply_effects(baseline(bench), bench, {"loose-base": 10.0}).made
    before, after = hidden(bench.made, depths), hidden(half_loose, depths)
    true = np.column_stack([np.log(after[:, 0] / before[:, 0]), (after[:, 1] - before[:, 1]) / before[:, 0]])
    assert np.all(np.abs(mine - true) < 0.05 * np.abs(true).max(axis=0))


@pytest.mark.evidence
@pytest.mark.parametrize("place_mm", sorted({run.place_mm for run in BENCHES["row-free"].runs}))
def test_force_and_every_charge_of_several_electrodes_agree_wherever_the_dot_stands(place_mm, tmp_path):
    """Charges within the stated error of the largest of them, as the model's error is one of the film."""
    bench = BENCHES["row-free"]
    told = engine_of(bench, tmp_path)
    prepared, _ = told.dot_positions.presses_at((place_mm, 0.0))
    depths = SHARES * bench.deepest_mm
    table, of = prepared.fit.table[:, 0], np.linspace(0.0, prepared.depth_mm, len(prepared.fit.table))
    mine = np.column_stack([np.interp(depths, of, table[:, n]) for n in (0, 2, 3, 4)])
    stack = Stack(replace(bench.made, offset_mm=place_mm))
    state, true = stack.rest(), []
    for depth in depths:
        state = stack.press(state, float(depth), 1.0)
        answer = stack.answer(state)
        true.append((answer.force_N, *(1e-12 * charge for charge in answer.charges_pC)))
    true = np.array(true)
    allowed = 3.0 * np.array([told.accuracy["force_N"], *3 * [told.accuracy["voltage_V"]]])
    size = np.column_stack([true[:, 0], *3 * [np.abs(true[:, 1:]).max(axis=1)]])
    assert np.all(np.abs(mine - true) < allowed * size)
