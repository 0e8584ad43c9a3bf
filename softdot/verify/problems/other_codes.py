"""A slice and a solid that other codes have solved too, on the same mesh with their own elements and contact."""

import numpy as np

from softdot.case import Case
from softdot.verify.dragged_block import DraggedBlock
from softdot.verify.lattice import Grid, graded_coordinates, grid
from softdot.verify.other_codes import reference
from softdot.verify.problem import Problem
from solve.materials.laws import InvariantLaw, bulk_modulus

CELL_MM = 0.1
YOUNG_MPA, POISSON, RADIUS_MM = 1.0, 0.45, 1.0


def block_mesh() -> Grid:
    """The mesh of a slice of 3 x 1 mm, fine under the cylinder, one cell across."""
    outside = graded_coordinates(0.5, 1.5, CELL_MM, 0.25)
    inside = [CELL_MM * i for i in range(-4, 5)]
    x = np.array([*-outside[::-1], *inside, *outside])
    return grid((x, [-CELL_MM / 2, CELL_MM / 2], 1.0 - graded_coordinates(0.0, 1.0, CELL_MM, 0.25)[::-1]))


def block_under_cylinder(friction: float) -> DraggedBlock:
    """The rubber block under a cylinder, with a coefficient of friction."""
    shear = YOUNG_MPA / (2.0 * (1.0 + POISSON))
    law = InvariantLaw(shear / 2.0, 0.0, 0.0, 0.0, bulk_modulus(shear, POISSON))
    return DraggedBlock(block_mesh(), law, RADIUS_MM, friction)


def pressed_force() -> float:
    """Force of the cylinder 0.1 mm deep without friction, N/mm."""
    slice_of_block = block_under_cylinder(0.0)
    for number in range(1, 6):
        slice_of_block.drag(0.0, -0.02 * number)
    return -float(slice_of_block.force[2]) / CELL_MM


def dragged_force() -> float:
    """Force along the surface at friction 0.3, after a press of 0.1 mm and a drag of 0.1 mm, N/mm."""
    slice_of_block = block_under_cylinder(0.3)
    for number in range(1, 6):
        slice_of_block.drag(0.0, -0.02 * number)
    for number in range(1, 11):
        slice_of_block.drag(0.01 * number, -0.1)
    return float(slice_of_block.force[0]) / CELL_MM


def reference_segment() -> Case:
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
    """Open-circuit voltage of the segment, V."""
    return float(reference_segment().solve().steps[-1].open_circuit_voltage_V[0])


PROBLEMS = (
    Problem(
        name="slice-press",
        title="Slice of a rubber block under a rigid cylinder 0.1 mm deep, force per width",
        source=reference("slice-press").source,
        unit="N/mm",
        bound_percent=1.0,
        basis="its penalty of 1000 MPa/mm overlaps by 0.3 % of the depth, 0.5 % of the force",
        reference=lambda: reference("slice-press").value,
        solve=pressed_force,
    ),
    Problem(
        name="slice-drag",
        title="The same slice with friction 0.3 dragged by 0.1 mm, force along the surface per width",
        source=reference("slice-drag").source,
        unit="N/mm",
        bound_percent=2.0,
        basis="it slips elastically by τ over 200 MPa/mm and its normals lag by 0.8 % of this force",
        reference=lambda: reference("slice-drag").value,
        solve=dragged_force,
    ),
    Problem(
        name="solid-press",
        title="Segment of 2.5 mm with clamped sides under a Marburg dot 0.3 mm deep, open-circuit voltage",
        source=reference("solid-press").source,
        unit="V",
        bound_percent=1.0,
        basis="the same elements, another contact: facets of 0.1 to 0.2 mm move it by 0.3 to 0.9 %",
        reference=lambda: reference("solid-press").value,
        solve=solid_voltage,
    ),
)
