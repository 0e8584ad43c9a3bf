"""Clamped plates and beams of solid elements against the theories of thin bodies, beside those of softdot verify."""

import numpy as np
import pytest

from softdot.verify.body import solid_body
from softdot.verify.lattice import grid
from softdot.verify.loads import traction_force
from softdot.verify.problems.plates import hooke, thin_plate
from softdot.verify.von_karman import centre_deflection
from tests.cases import for_each
from tests.verification.row import agrees


def pressure_load(ratio: float) -> float:
    """F a^2 / (E t^4) of w/t + 0.471 (w/t)^3 = 0.171 q a^4 / (E t^4), F = pi a^2 q."""
    return np.pi * (ratio + 0.471 * ratio**3) / 0.171


def central_load(ratio: float) -> float:
    """F a^2 / (E t^4) of w/t + 0.443 (w/t)^3 = 0.217 F a^2 / (E t^4); the linear part is F a^2 / (16 pi D)."""
    return (ratio + 0.443 * ratio**3) / 0.217


CASES = [("pressure", pressure_load, 1.0), ("central force", central_load, 0.05)]


@pytest.mark.press
@for_each(("name", "load", "patch"), CASES, ids=["pressure", "central force"])
@for_each("ratio", [0.1, 1.0, 2.0])
def test_clamped_plate_follows_von_karman(name, load, patch, ratio):
    """Within 1 % of the plate equations, and up to w/t = 1 within 5 % of the cubic formula (Timoshenko, sec. 97).

    At w/t = 2 the cubic formula for a pressure itself lies 6 % above the solution of the plate equations.
    """
    ours = thin_plate(load(ratio), patch)
    agrees(f"clamped plate, {name}, w/t {ratio}, von Karman", ours, centre_deflection(load(ratio), patch), 0.01)
    if ratio <= 1.0:
        agrees(f"clamped plate, {name}, w/t {ratio}, cubic formula", ours, ratio, 0.05)


@for_each(("height", "tolerance"), [(0.1, 0.05), (0.32, 0.1)])
def test_clamped_beam_with_shear(height, tolerance):
    """F l^3 / (192 E I) + F l / (4 k G A), k = 5/6 (Timoshenko beam), l = 1, a narrow section."""
    width, load, small = 0.05, 1.0, 1e-6
    shape = grid((np.linspace(0.0, 0.5, 13), [0.0, width], np.linspace(0.0, height, 5)))
    body = solid_body(shape.points, hooke(0.3), shape.tets)
    prescribed = body.free_displacements()
    prescribed[shape.points[:, 0] == 0.0] = 0.0
    prescribed[shape.points[:, 0] == 0.5, 0] = 0.0
    middle = shape.facets(lambda x: x[:, 0] == 0.5)
    force = traction_force(shape.points, middle, [0.0, 0.0, 0.5 * load / (width * height)])
    body.solve(prescribed, small * force, tolerance=1e-8)
    ours = np.vdot(force[:, 2], body.u[:, 2]) / force[:, 2].sum() / small
    inertia, shear = width * height**3 / 12.0, 0.5 / 1.3
    reference = load / (192.0 * inertia) + load / (4.0 * 5.0 / 6.0 * shear * width * height)
    agrees(f"clamped beam, height/length {height}", ours, reference, tolerance)
