"""Small segments and dots for the solver's tests."""

import numpy as np

from geometry.dot import DotShape
from geometry.parameters import Effector, Film, Medium, Segment
from geometry.stack import layers
from mesh.build import build
from mesh.options import MeshOptions
from solve.materials.parameters import NeoHookean, PiezoelectricFilm

COARSE = MeshOptions(element_size_mm=1.4, contact_element_size_mm=0.7, mesher="layered")


def segment(**changes) -> Segment:
    """The paper's final design, with changes."""
    values = {
        "effector": Effector(height_mm=1.0),
        "medium1": Medium(thickness_mm=0.5),
        "film": Film(thickness_um=28.0),
        "medium2": Medium(thickness_mm=2.0),
    }
    return Segment(**{**values, **changes})


def materials(e_effector=1.0, e_medium1=5.0, e_medium2=1.0, poisson_ratio=0.495, **film) -> dict:
    """Rubbers and a PVDF film."""
    rubber = {"poisson_ratio": poisson_ratio}
    return {
        "effector": NeoHookean(youngs_modulus_MPa=e_effector, **rubber),
        "medium1": NeoHookean(youngs_modulus_MPa=e_medium1, **rubber),
        "medium2": NeoHookean(youngs_modulus_MPa=e_medium2, **rubber),
        "film": PiezoelectricFilm(**{"youngs_modulus_MPa": 2000.0, "poisson_ratio": 0.29, **film}),
    }


def cap(stack: Segment, x: float = 0.0, y: float = 0.0) -> DotShape:
    """A Marburg dot: base 1.5 mm, height 0.5 mm, so radius (0.75^2 + 0.5^2) / (2 0.5)."""
    return _dot("cap", 0.8125, 0.5, stack, x, y)


def ridge(stack: Segment, radius_mm: float = 1.15) -> DotShape:
    """A half cylinder along y."""
    return _dot("ridge", radius_mm, radius_mm, stack, 0.0, 0.0)


def _dot(kind, radius_mm, height_mm, stack, x, y) -> DotShape:
    top = layers(stack)[-1].top_mm
    return DotShape(kind, radius_mm, height_mm, np.zeros((1, 3)), np.array([x, y, top]), np.eye(3))


def coarse_mesh(stack: Segment, dot: DotShape, options: MeshOptions = COARSE):
    """A mesh for tests that do not depend on its fineness."""
    return build(stack, dot, options)
