"""Rows of plane-strain slices: one slice, slices far apart, mirror images, and meshes of exact area."""

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.array.layout import array_layout
from geometry.array.parameters import Array, Groove
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Effector
from mesh.array.mesh import array_mesh
from mesh.options import MeshOptions
from mesh.types import signed_volumes
from softdot.case import Case
from softdot.prepared_press import PreparedPress
from tests.cases import for_each
from tests.geometry.test_array import ALL, segment
from tests.verification.array_cases import array, solved

SIZES = {"element_size_mm": 0.6, "contact_element_size_mm": 0.2}
FAR = {"shared": [], "pitch_mm": 10.0}


def row(columns, dot=None, **keys):
    """A row of slices of 2.3 mm under a ridge; keys : of the table [array]."""
    tables = {"dot": {"shape": "ridge", **(dot or {})}}
    return array(columns, 1, segment={"section": "plane-strain"}, mesh=SIZES, tables=tables, **keys)


def numbers(press, mesh=None):
    """Force in N and charges (e,) in pC at full load."""
    last = solved(press, mesh).steps[-1]
    return last.reaction_force_N, 1e12 * last.film_charge_C


def test_a_row_of_one_slice_is_the_slice():
    one = row(1)
    lone = Case(one.config.model_copy(update={
        "array": None, "mesh": one.config.mesh.model_copy(update={"mesher": "layered"})
    }))  # fmt: skip
    (force, charge), (lone_force, lone_charge) = (
        numbers(each) for each in (one.press_over(one.layout.places[0]), lone)
    )
    assert force == pytest.approx(lone_force, rel=1e-9)
    np.testing.assert_allclose(charge, lone_charge, rtol=1e-9)
    assert one.capacitance_pF[0] == pytest.approx(lone.press().film_capacitance_pF, rel=1e-9)


def test_far_apart_slices_add_up():
    """Islands under a ridge: the pressed one is a lone slice, the others read nothing. Under one plate: all are lone
    slices, and the forces are added. Of those at the ends, which have no column in their middle, the mesh is another.
    """
    three, one = row(3, **FAR), row(1, shared=[])
    force, charge = numbers(three.press_over(three.layout.places[1]))
    lone_force, lone_charge = numbers(one.press_over(one.layout.places[0]))
    assert force == pytest.approx(lone_force, rel=1e-9)
    np.testing.assert_allclose(charge, [0.0, lone_charge[0], 0.0], rtol=1e-9, atol=1e-9 * lone_charge[0])
    plates = [PreparedPress(case.config.model_copy(update={"dot": Dot(shape="plate")})) for case in (three, one)]
    (force, charge), (lone_force, lone_charge) = map(numbers, plates)
    assert force == pytest.approx(3.0 * lone_force, rel=1e-2)
    np.testing.assert_allclose(charge, np.full(3, lone_charge[0]), rtol=1e-2)
    assert charge[1] == pytest.approx(lone_charge[0], rel=1e-9)


def test_a_press_of_a_row_and_its_mirror_image():
    """The last of three is the image of the first; over the middle a half of the mesh gives what all of it gives."""
    case = row(3)
    assert case.solved_numbers == [0, 1]
    first, middle, last = (case.press_over(place) for place in case.layout.places)
    (force, charge), (image_force, image_charge) = numbers(first), numbers(last)
    assert image_force == pytest.approx(force, rel=1e-6)
    np.testing.assert_allclose(image_charge[::-1], charge, rtol=1e-6)
    assert middle.planes == (0,)
    np.testing.assert_allclose(numbers(middle)[1], numbers(middle, middle.mesh)[1], rtol=1e-6)


SECTIONS = {  # area of parts in mm2, by hand
    "effectors of their own": (Array(columns=2, rows=1), {}, {"effector": 2 * 2.3, "film": 4.8 * 0.028}),
    "blocks": (Array(columns=2, rows=1), {"effector": Effector(shape="block", length_mm=1.2)}, {"effector": 2 * 1.2}),
    "islands": (Array(columns=3, rows=1, shared=()), {}, {"film": 3 * 2.3 * 0.028, "medium2": 3 * 2.3 * 2.0}),
    "a groove": (
        Array(columns=2, rows=1, shared=ALL, grooves=(Groove(layer="medium2", width_mm=0.4, depth_mm=0.5),)),
        {},
        {"medium2": 4.8 * 2.0 - 0.4 * 0.5, "effector": 4.8},
    ),
    "a grid": (Array(columns=2, rows=1, grid_layers=("film",)), {}, {"film": 2 * 2.3 * 0.028, "medium1": 4.8 * 0.5}),
}


@for_each("name", SECTIONS)
def test_the_mesh_of_a_row_has_the_area_of_each_part(name):
    """No node is an orphan; the sides are in x alone, those of a grid among them."""
    stated, changes, areas = SECTIONS[name]
    layout = array_layout(stated, segment(section="plane-strain", **changes), Dot())
    options = MeshOptions(element_size_mm=0.6, contact_element_size_mm=0.2)
    found = array_mesh(layout, resolve_dot(Dot(shape="ridge"), layout.whole), options)
    volume = signed_volumes(found.points_mm, found.tets[:, :4])
    for part, area in areas.items():
        assert volume[found.region_tets(part)].sum() == pytest.approx(area * found.thickness_mm, rel=1e-9)
    assert (np.unique(found.tets) == np.arange(len(found.points_mm))).all()
    sides = found.points_mm[found.facets["side-film"]]
    assert (np.ptp(sides[..., 0], axis=1) < 1e-9).all()
    walls = np.unique(np.round(np.abs(sides[..., 0]), 6))
    np.testing.assert_allclose(walls, [0.1, 2.4] if name == "a grid" else layout.half_mm[:1])


def test_what_slices_cannot_have_is_refused():
    with pytest.raises(InputError, match=r"array.rows = 2: segment.section = 'plane-strain'.*; must be 1"):
        Case(row(2).config.model_copy(update={"array": Array(columns=2, rows=2)})).over("r1c1")
    with pytest.raises(InputError, match=r"segment.section = 'plane-strain': a kernel is of dots anywhere"):
        row(2).refuse_kernel()
