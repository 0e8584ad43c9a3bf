"""Clamped plate, strip membrane and clamped beam of solid elements against the theories of thin bodies."""

import numpy as np

from solve.materials.laws import LinearLaw, bulk_modulus
from tests.cases import for_each
from tests.verification.body import solid_body
from tests.verification.lattice import disc, graded, grid
from tests.verification.loads import traction_force
from tests.verification.row import agrees
from tests.verification.von_karman import centre_deflection

THICKNESS = 0.02  # of the plate of radius 1


def hooke(poisson_ratio: float) -> LinearLaw:
    """E = 1."""
    shear = 0.5 / (1.0 + poisson_ratio)
    return LinearLaw(shear, bulk_modulus(shear, poisson_ratio))


def plate_centre(load: float, patch: float) -> float:
    """Deflection over thickness of a clamped disc under a pressure on r < patch; load is the whole force."""
    middle = np.linspace(0.0, 0.85, 12) if patch == 1.0 else np.append(0.0, graded(patch, 0.85, patch, 0.08))
    shape = disc(np.append(middle, [0.9, 0.94, 0.97, 1.0]), np.linspace(0.0, np.pi / 2, 11), [0.0, THICKNESS])
    body = solid_body(shape.points, hooke(0.3), shape.tets)
    prescribed = body.free()
    radius = np.hypot(shape.points[:, 0], shape.points[:, 1])
    prescribed[radius > 1.0 - 1e-9] = 0.0
    for axis in range(2):
        prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0
    top = shape.facets(lambda x: (x[:, 2] == THICKNESS) & (np.hypot(x[:, 0], x[:, 1]) < patch + 1e-9))
    force = traction_force(shape.points, top, [0.0, 0.0, 1.0])
    body.solve(prescribed, 0.25 * load / force.sum() * force, steps=3, tolerance=1e-6)
    return body.u[radius < 1e-9, 2].mean() / THICKNESS


def pressure_load(ratio: float) -> float:
    """F a^2 / (E t^4) of w/t + 0.471 (w/t)^3 = 0.171 q a^4 / (E t^4), F = pi a^2 q."""
    return np.pi * (ratio + 0.471 * ratio**3) / 0.171


def central_load(ratio: float) -> float:
    """F a^2 / (E t^4) of w/t + 0.443 (w/t)^3 = 0.217 F a^2 / (E t^4); the linear part is F a^2 / (16 pi D)."""
    return (ratio + 0.443 * ratio**3) / 0.217


CASES = [("pressure", pressure_load, 1.0), ("central force", central_load, 0.05)]


@for_each(("name", "load", "patch"), CASES, ids=["pressure", "central force"])
@for_each("ratio", [0.1, 1.0, 2.0])
def test_clamped_plate_follows_von_karman(name, load, patch, ratio):
    """Within 1 % of the plate equations, and up to w/t = 1 within 5 % of the cubic formula (Timoshenko, sec. 97).

    At w/t = 2 the cubic formula for a pressure itself lies 6 % above the solution of the plate equations.
    """
    ours = plate_centre(load(ratio) * THICKNESS**4, patch)
    agrees(f"clamped plate, {name}, w/t {ratio}, von Karman", ours, centre_deflection(load(ratio), patch), 0.01)
    if ratio <= 1.0:
        agrees(f"clamped plate, {name}, w/t {ratio}, cubic formula", ours, ratio, 0.05)


def test_strip_membrane_under_a_central_line_load():
    """F = 8 E A (d / l)^3 where the strip is so thin that it only stretches: strain 2 (d / l)^2; nu = 0."""
    half, thickness, deflection = 0.5, 5e-4, 0.05
    x = graded(0.0, half / 2, 0.001, 0.03)
    x = np.concatenate([x, half - x[-2::-1]])
    shape = grid((x, [0.0, 0.02], [0.0, thickness]))
    body = solid_body(shape.points, hooke(0.0), shape.tets)
    prescribed = body.free()
    prescribed[:, 1] = np.where(np.isin(shape.points[:, 1], (0.0, 0.02)), 0.0, np.nan)
    prescribed[shape.points[:, 0] == 0.0] = 0.0
    middle = np.flatnonzero(shape.points[:, 0] == half)
    prescribed[middle, 0] = 0.0
    prescribed[middle, 2] = deflection
    body.solve(prescribed, steps=40, tolerance=1e-8)
    agrees("strip membrane", 2.0 * body.reaction(middle)[2], 8.0 * 0.02 * thickness * deflection**3, 0.05)


@for_each(("height", "tolerance"), [(0.1, 0.05), (0.32, 0.1)])
def test_clamped_beam_with_shear(height, tolerance):
    """F l^3 / (192 E I) + F l / (4 k G A), k = 5/6 (Timoshenko beam), l = 1, a narrow section."""
    width, load, small = 0.05, 1.0, 1e-6
    shape = grid((np.linspace(0.0, 0.5, 13), [0.0, width], np.linspace(0.0, height, 5)))
    body = solid_body(shape.points, hooke(0.3), shape.tets)
    prescribed = body.free()
    prescribed[shape.points[:, 0] == 0.0] = 0.0
    prescribed[shape.points[:, 0] == 0.5, 0] = 0.0
    middle = shape.facets(lambda x: x[:, 0] == 0.5)
    force = traction_force(shape.points, middle, [0.0, 0.0, 0.5 * load / (width * height)])
    body.solve(prescribed, small * force, tolerance=1e-8)
    ours = np.vdot(force[:, 2], body.u[:, 2]) / force[:, 2].sum() / small
    inertia, shear = width * height**3 / 12.0, 0.5 / 1.3
    reference = load / (192.0 * inertia) + load / (4.0 * 5.0 / 6.0 * shear * width * height)
    agrees(f"clamped beam, height/length {height}", ours, reference, tolerance)
