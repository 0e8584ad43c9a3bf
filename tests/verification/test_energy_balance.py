"""Work put in = stored + dissipated, within 1e-3 of the largest work, over a press and its release."""

from itertools import pairwise

import numpy as np
import pytest

from solve.materials.film_yield import Yield
from solve.materials.mullins import Softening
from solve.materials.parameters import Linear
from solve.materials.prony import Prony
from solve.physics import Physics
from solve.solution.schedule import Target
from solve.system import Load
from solve.terms.friction import DotFriction
from tests.cases import for_each
from tests.solve.segments import materials
from tests.verification.energies import follow
from tests.verification.slices import DEPTH_MM, setup_of, waved

TOLERANCE = 1e-3


def hookean():
    """Media of the linear law, in which a viscous branch has an energy of its own."""
    soft = {name: Linear(youngs_modulus_MPa=1.0, poisson_ratio=0.45) for name in ("effector", "medium1", "medium2")}
    return materials() | soft


def cycle(physics, own=None, steps=24, depth_mm=DEPTH_MM, **times):
    """Down and up again along a raised cosine and its mirror, which is a half-sine in speed."""
    press = waved("half-sine", steps, depth_mm, rise_s=0.3, **times)
    setup = setup_of(press, physics, own)
    return follow(setup, setup.targets(True))


@pytest.mark.press
def test_an_elastic_press_stores_all_work_and_gives_it_back():
    balance = cycle(Physics())
    assert balance.error < TOLERANCE
    assert abs(balance.work[-1]) < TOLERANCE * max(balance.work)
    assert balance.dissipated[-1] == 0.0


@pytest.mark.press
def test_viscosity(monkeypatch):
    monkeypatch.setattr("solve.solution.march.TIME_TOLERANCE", np.inf)
    series = Prony((0.3, 0.2), (0.05, 0.5))
    balance = cycle(Physics(inelastic={"medium2": (series,), "effector": (series,)}), hookean(), 60, 0.1)
    assert balance.loss > 0.02
    assert balance.error < TOLERANCE


@pytest.mark.press
def test_stress_softening():
    law = Softening(0.4, 0.0, 0.3)
    balance = cycle(Physics(inelastic={"medium2": (law,), "effector": (law,)}), steps=40)
    assert balance.loss > 0.02
    assert balance.error < TOLERANCE


@pytest.mark.press
@for_each("hardening_MPa", [0.0, 200.0])
def test_film_yield(hardening_MPa):
    balance = cycle(Physics(inelastic={"film": (Yield(3.0, hardening_MPa),)}), steps=40)
    assert balance.loss > 0.02
    assert balance.error < TOLERANCE


@pytest.mark.press
def test_friction():
    """Down 0.2 mm, 0.1 mm aside, back and up."""
    setup = setup_of(waved("ramp"), Physics(terms=(DotFriction(0.4),)))
    corners = [(0.0, 0.0), (0.0, 1.0), (0.1, 1.0), (0.0, 1.0), (0.0, 0.0)]
    legs, unit = [], 1e-3 / setup.system.units.length
    for k, (a, b) in enumerate(pairwise(corners)):
        for s in np.linspace(0.0, 1.0, 31)[0 if k == 0 else 1 :]:
            x, depth = (1.0 - s) * np.array(a) + s * np.array(b)
            legs.append(Target(k + s, Load((x * unit, 0.0), depth * setup.full_drive), s in (0.0, 1.0)))
    balance = follow(setup, legs)
    assert balance.loss > 0.02
    assert balance.error < TOLERANCE
