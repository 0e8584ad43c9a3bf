"""The same problem in metres, millimetres and micrometres: lengths scale by s, forces by s^2, moduli stay."""

from dataclasses import replace

import numpy as np
import pytest

from geometry.parameters import Film, Medium
from solve.materials.prony import Prony
from solve.model import Press
from solve.physics import Physics
from solve.terms.friction import DotFriction
from solve.terms.inertia import MovingMass
from solve.terms.rig import RigSpring
from solve.waveform import Waveform
from tests.cases import for_each
from tests.pressing import press_segment
from tests.solve.segments import materials, ridge, segment
from tests.verification.slices import mesh_of

WAVE = Waveform(shape="raised-cosine", rise_s=0.1)
SERIES = Prony((0.3,), (0.1,))
CASES = {
    "elastic": lambda _: Physics(),
    "viscous": lambda _: Physics(inelastic={"medium2": (SERIES,)}),
    "friction": lambda _: Physics(terms=(DotFriction(0.4),)),
    "soft rig": lambda s: Physics(terms=(RigSpring(0.05 / s),)),
    "moving mass behind a soft rig": lambda s: Physics(terms=(RigSpring(0.05 / s), MovingMass(5.0 * s))),
}


@pytest.fixture(scope="module", autouse=True)
def equal_steps():
    """Only the load steps: a step's length must not hang on the last digits of an error estimate."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("solve.solution.march.TIME_TOLERANCE", np.inf)
        yield


def press(scale, physics):
    """A segment scale times as large; the mesh is the same one, scaled."""
    stack = segment(
        section="plane-strain",
        length_mm=2.5 * scale,
        width_mm=2.5 * scale,
        medium1=Medium(thickness_mm=0.5 * scale),
        film=Film(thickness_um=28.0 * scale),
        medium2=Medium(thickness_mm=2.0 * scale),
        effector=None,
    )
    whole = mesh_of(False)
    tet_mesh = replace(whole, points_mm=scale * whole.points_mm, thickness_mm=scale * whole.thickness_mm)
    stack = stack.model_copy(update={"effector": segment().effector})
    dot = ridge(segment())
    sizes = {name: scale * getattr(dot, name) for name in ("radius_mm", "height_mm", "origin_mm")}
    dot = replace(dot, **sizes)
    way = Press(indentation_mm=0.15 * scale, load_steps=4, waveform=WAVE)
    return press_segment(stack, materials(), dot, way, tet_mesh, None, physics)


@pytest.mark.press
@for_each("case", CASES)
@for_each("scale", [1e3, 1e-3], ids=["metres", "micrometres"])
def test_the_answer_does_not_depend_on_the_unit_of_length(case, scale, in_millimetres):
    ours, reference = press(scale, CASES[case](scale)), in_millimetres(case)
    assert ours.converged
    assert [s.newton_iterations for s in ours.steps] == [s.newton_iterations for s in reference.steps]
    np.testing.assert_allclose(ours.trace.time_s, reference.trace.time_s, rtol=1e-12)
    for name in ("reaction_force_N", "film_charge_C"):
        a, b = getattr(ours.trace, name) / scale**2, getattr(reference.trace, name)
        np.testing.assert_allclose(a, b, atol=1e-9 * np.abs(b).max())


@pytest.fixture(scope="module")
def in_millimetres():
    known = {}

    def get(case):
        if case not in known:
            known[case] = press(1.0, CASES[case](1.0))
        return known[case]

    return get


def test_the_cases_are_not_all_the_same(in_millimetres):
    ends = [in_millimetres(case).trace.reaction_force_N.max() for case in CASES]
    assert np.unique(np.round(ends, 6)).size == len(ends)
