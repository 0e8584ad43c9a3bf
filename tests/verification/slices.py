"""Presses of a coarse plane-strain slice, a second each, for statements about time, rig and circuit."""

from functools import cache

import numpy as np

from geometry.dot import DotShape
from geometry.parameters import Dot, Segment
from geometry.stack import layers
from mesh.options import MeshOptions
from mesh.types import TetMesh
from solve.materials.parameters import Hyperfoam, PiezoelectricFilm
from solve.model import Model, Press, Readout
from solve.open_interfaces import open_interfaces
from solve.physics import Physics
from solve.result import PressResult
from solve.setup import Setup, set_up
from solve.waveform import Waveform
from tests.pressing import press_segment
from tests.solve.segments import coarse_mesh, materials, ridge, segment

STACK = segment(section="plane-strain")
BLOCK = segment(section="plane-strain", boundary="free", effector=None)
FOAM = Hyperfoam(mu_MPa=(0.2,), alpha=(2.0,), poisson_ratio=(0.25,))
DEPTH_MM = 0.2
OF_SLICES = MeshOptions(element_size_mm=0.9, contact_element_size_mm=0.45, mesher="layered")


def plate(stack: Segment) -> DotShape:
    """A flat dot on the top."""
    return DotShape("plate", 0.0, 0.0, np.zeros((1, 3)), np.array([0.0, 0.0, layers(stack)[-1].top_mm]), np.eye(3))


def foams() -> dict:
    """Media whose whole stress relaxes when they are viscous, and a film about as soft: nearly one block."""
    return dict.fromkeys(("effector", "medium1", "medium2"), FOAM) | {
        "film": PiezoelectricFilm(youngs_modulus_MPa=2.0, poisson_ratio=0.29)
    }


@cache
def mesh_of(flat: bool) -> TetMesh:
    """The coarse mesh under the ridge, or under the plate."""
    stack = BLOCK if flat else STACK
    return coarse_mesh(stack, plate(stack) if flat else ridge(stack), OF_SLICES)


def pressed(
    press: Press | None = None, physics: Physics | None = None, readout: Readout | None = None, flat=False, **film
) -> PressResult:
    """The ridge on the rubber segment, or with flat the plate on the foam block. It has converged."""
    stack, own = (BLOCK, foams()) if flat else (STACK, materials(**film))
    result = press_segment(
        stack, own, plate(stack) if flat else ridge(stack), press or waved(), mesh_of(flat), None, physics, readout
    )
    assert result.converged, result.failure
    return result


def waved(shape="raised-cosine", steps=6, depth_mm=DEPTH_MM, force_N=None, **times) -> Press:
    """A press along a waveform."""
    aim = {"indentation_mm": depth_mm} if force_N is None else {"force_N": force_N}
    return Press(**aim, load_steps=steps, waveform=Waveform(shape=shape, **times))


def setup_of(press: Press, physics: Physics, own=None, readout: Readout | None = None, flat=False) -> Setup:
    """The discretised press itself."""
    stack = BLOCK if flat else STACK
    opened_mesh, opened = open_interfaces(mesh_of(flat), physics.bonds, physics.delaminations, True)
    own = own or (foams() if flat else materials())
    return set_up(
        Model(stack, own, Dot(), press, readout, physics), plate(stack) if flat else ridge(stack), opened_mesh, opened
    )


def force(result: PressResult):
    """Of every converged state (t,), N."""
    return result.trace.reaction_force_N


def charge(result: PressResult):
    """Of every converged state (t,), C."""
    return result.trace.film_charge_C[:, 0]
