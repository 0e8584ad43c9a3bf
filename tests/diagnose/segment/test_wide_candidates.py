"""Candidates that reach far have an equilibrium as far as they reach."""

from functools import cache

import numpy as np
import pytest

from diagnose.engines.segment.drive import model_drive
from diagnose.engines.segment.presses import Presses
from diagnose.engines.segment.response import FilmPlate, Mechanics, channel_signals
from diagnose.signals.recording import Recording
from diagnose.signals.time_scales import TimeScales
from diagnose.vocabulary.base import candidates_of_segment
from diagnose.vocabulary.scene import Scene
from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Readout
from solve.tables.rig_mesh import rig_mesh
from solve.tables.workers import run_all
from tests.diagnose.segment.rigs import COARSE, TABLES, model, run, silent

DEPTH_MM = 0.2
COMPLIANT = {"compliance_mm_per_N": 0.05}
SIDES, DOT = ("elastic-sides", "sides"), ("dot-offset", "dot")


@cache
def force(boundary, name=None, share=0.0):
    """Largest force of a segment with these sides, with a candidate at a share of what it may reach."""
    of = model(segment={**TABLES["segment"], "boundary": boundary})
    if name is not None:
        scene = Scene(of, (Readout(),), DEPTH_MM, 2.0, 0.5, TimeScales(0.2, 1e-3, 10.0))
        one = next(c for c in candidates_of_segment(scene) if c.name == name)
        changed = with_mechanisms(of, [one.as_mechanism((share * one.coordinates[0].high,))])
    mesh, options = rig_mesh(of, COARSE)
    presses = Presses(of, mesh, options, DEPTH_MM)
    (found,) = run_all([presses.press_job(of if name is None else changed)], silent)
    assert len(found), f"{name} at {share} has no equilibrium"
    return float(found[-1, 0])


def test_under_a_force_the_sensor_sees_the_rig_give_way_too():
    """The recorded path is that of the dot and the force times the compliance; without one that of the dot."""
    pushed = run("force_N", np.interp(run().time_s, [0.3, 0.5, 0.9, 1.1], [0.0, 2.0, 2.0, 0.0]))
    drive = model_drive(pushed, Recording((pushed,)).phases[0])
    path = 0.1 * np.sqrt(drive.values / 2.0)
    found = Mechanics(path, drive.values, drive.values, drive.values[:, None])
    plain = model()
    soft = with_mechanisms(plain, [Mechanism(name="rig-compliance", component="rig", parameters=COMPLIANT)])
    film = FilmPlate(np.ones((1, 2)), 0.0)
    rigid, gives = (
        channel_signals(pushed, ["displacement_mm"], drive, drive.values, found, film, on)["displacement_mm"]
        for on in (plain, soft)
    )
    np.testing.assert_allclose((gives - rigid)[drive.touching], 0.05 * drive.values[drive.touching], atol=1e-12)


@pytest.mark.press
def test_free_sides_may_lean_on_anything_from_nothing_to_a_wall():
    forces = [force("free"), *(force("free", SIDES, share) for share in (0.2, 0.5, 1.0)), force("clamped")]
    assert np.all(np.diff(forces) > 0.0)
    assert force("free", SIDES, 0.2) < 1.05 * force("free")
    assert force("free", SIDES, 1.0) > 0.9 * force("clamped")


@pytest.mark.press
@pytest.mark.parametrize("boundary", ["free", "clamped"])
def test_a_dot_stands_as_far_aside_as_it_is_sought(boundary):
    """At the side of a free segment less resists it, at that of a clamped one more."""
    sign = -1.0 if boundary == "free" else 1.0
    assert sign * (force(boundary, DOT, 1.0) - force(boundary)) > 0.02 * force(boundary)
