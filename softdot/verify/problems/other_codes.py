"""A slice and a solid that other codes solved once: the same mesh, but their own elements, contact and solver."""

import numpy as np

from softdot.case import Case
from softdot.verify.dragged_block import DraggedBlock
from softdot.verify.lattice import Grid, graded, grid
from softdot.verify.other_codes import reference
from softdot.verify.problem import Problem
from solve.materials.laws import InvariantLaw, bulk_modulus

CELL_MM = 0.1
YOUNG_MPA, POISSON, RADIUS_MM = 1.0, 0.45, 1.0


def block() -> Grid:
    """3 x 1 mm in the plane, fine under the cylinder, one cell across."""
    outside = graded(0.5, 1.5, CELL_MM, 0.25)
    inside = [CELL_MM * i for i in range(-4, 5)]
    x = np.array([*-outside[::-1], *inside, *outside])
    return grid((x, [-CELL_MM / 2, CELL_MM / 2], 1.0 - graded(0.0, 1.0, CELL_MM, 0.25)[::-1]))


def dragged(friction: float) -> DraggedBlock:
    """The rubber block under a cylinder."""
    shear = YOUNG_MPA / (2.0 * (1.0 + POISSON))
    law = InvariantLaw(shear / 2.0, 0.0, 0.0, 0.0, bulk_modulus(shear, POISSON))
    return DraggedBlock(block(), law, RADIUS_MM, friction)


def pressed_force() -> float:
    """Without friction, 0.1 mm deep, N/mm."""
    slice_of_block = dragged(0.0)
    for number in range(1, 6):
        slice_of_block.drag(0.0, -0.02 * number)
    return -float(slice_of_block.force[2]) / CELL_MM


def dragged_force() -> float:
    """Along the surface, with friction 0.3, 0.1 mm deep and dragged by 0.1 mm, N/mm."""
    slice_of_block = dragged(0.3)
    for number in range(1, 6):
        slice_of_block.drag(0.0, -0.02 * number)
    for number in range(1, 11):
        slice_of_block.drag(0.01 * number, -0.1)
    return float(slice_of_block.force[0]) / CELL_MM


def solid() -> Case:
    """The segment of 2.5 x 2.5 mm with clamped sides under a Marburg dot, of which a quarter is meshed."""
    rubbers = {"model": "neo-hookean", "poisson_ratio": 0.495}
    return Case(
        segment={
            "length_mm": 2.5,
            "width_mm": 2.5,
            "boundary": "clamped",
            "effector": {"height_mm": 1.0, "material": "soft"},
            "medium1": {"thickness_mm": 0.5, "material": "stiff"},
            "film": {"thickness_um": 28.0},
            "medium2": {"thickness_mm": 2.0, "material": "soft"},
        },
        materials={
            "soft": {**rubbers, "youngs_modulus_MPa": 1.0},
            "stiff": {**rubbers, "youngs_modulus_MPa": 5.0},
        },
        dot={"shape": "cap", "base_diameter_mm": 1.5, "height_mm": 0.5},
        press={"indentation_mm": 0.3, "load_steps": 4},
        mesh={
            "mesher": "layered",
            "element_size_mm": 0.5,
            "contact_element_size_mm": 0.12,
            "film_element_size_mm": 0.45,
        },
    )


def solid_voltage() -> float:
    """Open circuit, V."""
    return float(solid().solve().steps[-1].open_circuit_voltage_V[0])


PROBLEMS = (
    Problem(
        name="slice-press",
        title="Slice of a rubber block under a rigid cylinder 0.1 mm deep, force per width",
        source=reference("slice-press").source,
        unit="N/mm",
        bound_percent=1.0,
        basis="its penalty of 1000 MPa/mm overlaps by 0.3 % of the depth, 0.5 % of the force",
        reference=lambda: reference("slice-press").value,
        solved=pressed_force,
    ),
    Problem(
        name="slice-drag",
        title="The same slice with friction 0.3 dragged by 0.1 mm, force along the surface per width",
        source=reference("slice-drag").source,
        unit="N/mm",
        bound_percent=2.0,
        basis="it slips elastically by τ over 200 MPa/mm and its normals lag by 0.8 % of this force",
        reference=lambda: reference("slice-drag").value,
        solved=dragged_force,
    ),
    Problem(
        name="solid-press",
        title="Segment of 2.5 mm with clamped sides under a Marburg dot 0.3 mm deep, open-circuit voltage",
        source=reference("solid-press").source,
        unit="V",
        bound_percent=1.0,
        basis="the same elements, another contact: facets of 0.1 to 0.2 mm move it by 0.3 to 0.9 %",
        reference=lambda: reference("solid-press").value,
        solved=solid_voltage,
    ),
)
