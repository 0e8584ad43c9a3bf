"""A press that cannot go on says why, where, at which step, and what to do; what converged is kept."""

import re

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.checks import check_pushed_dot
from geometry.dot import DotShape
from geometry.parameters import Dot, Electrode, Film, Medium, Segment
from geometry.stack import layers
from mesh.build import build
from mesh.options import MeshOptions
from solve.materials.parameters import Linear, NeoHookean, PiezoelectricFilm
from solve.model import Press
from solve.solution import march as marching
from solve.solution import newton
from tests.pressing import press_segment

SLICE = MeshOptions(element_size_mm=0.8, contact_element_size_mm=0.4, mesher="layered")
FILM = PiezoelectricFilm()
SOFT = NeoHookean(youngs_modulus_MPa=1.0, poisson_ratio=0.45)
PLACE = re.compile(r" x = (-?\d+\.\d\d), y = (-?\d+\.\d\d), z = (-?\d+\.\d\d) mm[;,] ")


def slab(**changes) -> Segment:
    """A plane-strain slice without effector, 1.528 mm high and 3 mm long."""
    sizes = {"length_mm": 3.0, "width_mm": 2.0, "section": "plane-strain", "boundary": "free"}
    soft = {"medium1": Medium(thickness_mm=0.5), "film": Film(thickness_um=28.0), "medium2": Medium(thickness_mm=1.0)}
    return Segment(**{**sizes, **soft, **changes})


def dot(kind: str, stack: Segment, x: float = 0.0, height_mm: float = 1.0) -> DotShape:
    """A ridge of 1 mm radius, or a plate, at rest on the slab."""
    origin = np.array([x, 0.0, layers(stack)[-1].top_mm])
    height_mm = 0.0 if kind == "plate" else height_mm
    return DotShape(kind, 1.0, height_mm, np.zeros((1, 3)), origin, np.eye(3))


def stopped(stack: Segment, shape: DotShape, press: Press, medium=SOFT):
    """A press that stops short; every message names the step, a part or the dot, a place in it, and advice."""
    tables = {"medium1": medium, "medium2": medium, "film": FILM}
    result = press_segment(stack, tables, shape, press, build(stack, shape, SLICE))
    said = result.failure
    assert not result.converged
    assert "\n" not in said
    reached = result.steps[-1]
    depth = f"{1e3 * reached.indentation_m:.3f} mm and {reached.reaction_force_N + 0.0:.3g} N"
    assert re.match(rf"step \d of \d stopped at {re.escape(depth)}, sub-steps fell below 1/64 of it: ", said)
    assert re.search(r"medium1|medium2|film", said)
    x, y, z = (float(n) for n in PLACE.search(said).groups())
    assert abs(x) <= 1.5
    assert abs(y) <= 0.2
    assert 0.0 <= z <= 1.53
    return result, said


@pytest.mark.press
def test_a_slab_crushed_flat_turns_an_element_inside_out_and_keeps_the_steps_before():
    stack = slab()
    softens_in_compression = Linear(youngs_modulus_MPa=1.0, poisson_ratio=0.3)
    press = Press(indentation_mm=1.2, load_steps=4)
    result, said = stopped(stack, dot("ridge", stack), press, softens_in_compression)
    assert re.search(r"an element of medium1 is crushed to \d+ % of its volume and turned inside out at x = ", said)
    assert "try more load steps (press.load_steps), a finer mesh" in said
    assert [round(1e3 * step.indentation_m, 6) for step in result.steps[:3]] == [0.0, 0.3, 0.6]
    assert all(np.isfinite(step.fields.cauchy_stress_Pa).all() for step in result.steps)
    assert result.steps[-1].reaction_force_N > result.steps[1].reaction_force_N


def test_a_plate_on_a_rim_that_the_case_holds_is_told_so_and_no_far_equilibrium_is_looked_for(monkeypatch):
    monkeypatch.setattr(marching, "snap", lambda *_: pytest.fail("looked for a far equilibrium"))
    stack = slab(boundary="clamped", held_layers=("medium1",))
    result, said = stopped(stack, dot("plate", stack), Press(indentation_mm=0.1, load_steps=2))
    assert "the dot meets the rim of medium1 that the case holds at x = " in said
    assert "and neither can deform; move the dot" in said
    assert len(result.steps) == 1


def test_a_force_on_a_dot_beside_the_segment_finds_no_contact():
    stack = slab()
    on_a_stilt = dot("ridge", stack, x=4.0, height_mm=1e6)
    _, said = stopped(stack, on_a_stilt, Press(force_N=0.1, load_steps=2))
    assert "the dot that a force pushes loses contact" in said
    assert "keep the dot over the segment (dot.offset_mm, press.path_xy_mm)" in said


def test_a_dot_that_a_force_pushes_over_the_edge_is_refused():
    with pytest.raises(InputError, match=r"press\.path_xy_mm\[1\] = \[4\.0, 0\.0\]: with press\.force_N"):
        check_pushed_dot(Dot(), slab(), ((0.5, 0.0), (4.0, 0.0)))


def test_newton_that_may_not_iterate_halves_its_steps_to_the_smallest_and_says_so(monkeypatch):
    stack = slab()
    monkeypatch.setattr(newton, "MAX_ITERATIONS", 1)
    result, said = stopped(stack, dot("ridge", stack), Press(indentation_mm=0.1, load_steps=2))
    assert "no convergence in 1 Newton iterations, worst in " in said
    assert "try more load steps (press.load_steps), a finer mesh" in said
    assert 1e3 * result.steps[-1].indentation_m < 0.1


def test_an_electrode_whose_voltage_acts_back_on_no_element_is_refused():
    speck = Electrode(name="speck", center_mm=(0.1, 0.0), size_mm=(1e-6, 1.0))
    stack, shape = slab(film=Film(thickness_um=28.0, electrodes=(speck,))), dot("ridge", slab())
    tables = {"medium1": SOFT, "medium2": SOFT, "film": FILM.model_copy(update={"coupling": "two-way"})}
    with pytest.raises(InputError, match=r"segment.film.electrodes: 'speck' .* reduce mesh.film_element_size_mm"):
        press_segment(stack, tables, shape, Press(indentation_mm=0.1), build(stack, shape, SLICE))
