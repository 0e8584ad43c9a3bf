"""The media: quadratic displacement, linear pressure, any hyperelastic law."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mesh.types import Floats, Ints
from solve.element_kernels import mixed_solid
from solve.materials.laws import MediumLaw
from solve.quadrature import tetrahedron
from solve.shape_functions import linear, physical_gradients, quadratic

CHUNK = 4096  # elements assembled at a time: bounds the memory of the element matrices


def deformation_gradient(gradient: Floats, displacement: Floats) -> Floats:
    """F = 1 + du/dX at (m, q, n, 3) gradients and (m, n, 3) nodal displacements: (m, q, 3, 3)."""
    f: Floats = np.matmul(displacement.transpose(0, 2, 1)[:, None], gradient) + np.eye(3)
    return f


class InvertedElementError(ArithmeticError):
    """A trial state turns an element inside out. nodes : (10,) of the element."""

    def __init__(self, region: str, nodes: Ints) -> None:
        super().__init__(f"an element of {region} is turned inside out")
        self.region, self.nodes = region, nodes


def refuse_inversion(f: Floats, region: str, tets: Ints) -> None:
    """InvertedElementError when det F <= 0 anywhere; f (m, q, 3, 3), tets (m, 10)."""
    smallest = np.linalg.det(f).min(axis=1)
    if not smallest.min() > 0.0:
        raise InvertedElementError(region, tets[int(np.argmin(smallest))])


@dataclass(frozen=True)
class SolidRegion:
    """One medium. tets: (m, 10) nodes; dofs: (m, 34) unknowns, displacements first; gradient, weight: quadrature."""

    name: str
    law: MediumLaw
    tets: Ints
    dofs: Ints
    gradient: Floats
    weight: Floats

    def elements(self, displacement: Floats, unknowns: Floats) -> Iterator[tuple[slice, Floats, Floats]]:
        """Element matrices (upper triangle) and residuals, chunk by chunk."""
        shape_p = linear(tetrahedron()[0])
        for start in range(0, len(self.tets), CHUNK):
            part = slice(start, start + CHUNK)
            f = deformation_gradient(self.gradient[part], displacement[self.tets[part]])
            refuse_inversion(f, self.name, self.tets[part])
            stress, tangent = self.law.stress((f.swapaxes(-1, -2) @ f).reshape(-1, 3, 3))
            points = f.shape[:2]
            ke = np.empty((len(f), 34, 34))
            re = np.empty((len(f), 34))
            mixed_solid(
                self.gradient[part], self.weight[part], shape_p, f, unknowns[self.dofs[part, 30:]],
                self.law.bulk_modulus, stress.reshape(*points, 6),
                np.ascontiguousarray(tangent).reshape(*points, 6, 6), ke, re,
            )
            yield part, ke, re

def solid_region(name: str, law: MediumLaw, points: Floats, tets: Ints, dofs: Ints) -> SolidRegion:
    """Prepare a medium: points (n, 3), tets (m, 10), dofs (m, 34)."""
    reference, weight = tetrahedron()
    gradient, volume = physical_gradients(points[tets], quadratic(reference)[1], weight)
    return SolidRegion(name, law, tets, np.ascontiguousarray(dofs), gradient, volume)
