"""The rigid dot on the top of a stack, and the ground under what is loose: stiff walls at integration points."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import ElementHex2, ElementQuad2, FacetBasis  # type: ignore[import-untyped]

from softdot.studies.proof.world.arrays import Floats, Indices
from softdot.studies.proof.world.grid import Grid
from softdot.studies.proof.world.made import Made
from softdot.studies.proof.world.parts import unknowns

WALL = 1e4
"""Stiffness of the contact, MPa/mm: at 1 MPa of pressure the surfaces overlap by a tenth of a micrometre."""
FACET_ORDER = 9


@dataclass(frozen=True)
class Skin:
    """Facets with shape functions (k, q, a), nodes (k, a), weights (k, q) and places (k, q, d)."""

    shape: Floats
    nodes: Indices
    weight: Floats
    place: Floats

    def positions(self, u: Floats) -> Floats:
        """Positions (k, q, d) of the points at displacements (n, d)."""
        return np.asarray(self.place + np.einsum("kqa,kai->kqi", self.shape, u[self.nodes]))

    def dofs(self, dim: int) -> Indices:
        """Unknowns (k, a d) of the facets."""
        return unknowns(self.nodes, dim)


def skin(mesh: Grid, chosen: NDArray[np.bool_]) -> Skin:
    """Shape functions on the chosen facets."""
    element = ElementQuad2() if mesh.mesh.dim() == 2 else ElementHex2()
    basis = FacetBasis(mesh.mesh, element, facets=np.flatnonzero(chosen), intorder=FACET_ORDER)
    values = [np.broadcast_to(np.asarray(field[0]), basis.dx.shape) for field in basis.basis]
    shape = np.stack(values).transpose(1, 2, 0)
    used = np.abs(shape).max(axis=(0, 1)) > 1e-12
    where = np.asarray(basis.global_coordinates()).transpose(1, 2, 0)
    return Skin(shape[..., used], basis.element_dofs.T.astype(np.int64)[:, used], basis.dx, where)


@dataclass(frozen=True)
class Touch:
    """Contact at points (k, q) : distance from the centre of the dot, gap (negative where they touch), normal away from
    it.
    """

    distance: Floats
    gap: Floats
    normal: Floats

    @property
    def pressure(self) -> Floats:
        """Contact pressure (k, q) in MPa."""
        return np.asarray(-WALL * np.minimum(self.gap, 0.0))


class Dot:
    """A round body of what was made above a skin."""

    def __init__(self, made: Made, top: Skin) -> None:
        self.made, self.top = made, top

    def touch(self, u: Floats, depth_mm: float) -> Touch:
        """Distances, gaps and normals of the dot at displacements (n, d)."""
        centre = np.zeros(u.shape[1])
        centre[0], centre[-1] = self.made.offset_mm, self.made.radius_mm - depth_mm
        arm = self.top.positions(u) - centre
        distance = np.linalg.norm(arm, axis=2)
        return Touch(distance, distance - self.made.radius_mm, arm / distance[..., None])

    def press(self, u: Floats, depth_mm: float) -> tuple[Indices, Floats, Floats]:
        """Unknowns (k, a d), residuals (k, a d) and matrices (k, a d, a d) of the facets."""
        now, dim = self.touch(u, depth_mm), u.shape[1]
        outer = now.normal[..., :, None] * now.normal[..., None, :]
        stiff = np.where(now.gap < 0.0, WALL, 0.0)[..., None, None] * outer
        stiff = stiff - (now.pressure / now.distance)[..., None, None] * (np.eye(dim) - outer)
        shape, weight, dofs = self.top.shape, self.top.weight, self.top.dofs(dim)
        residual = np.einsum("kq,kqi,kqa->kai", -weight * now.pressure, now.normal, shape).reshape(dofs.shape)
        matrix = np.einsum("kq,kqij,kqa,kqb->kaibj", weight, stiff, shape, shape, optimize=True)
        return dofs, residual, matrix.reshape(*dofs.shape, -1)

    def force_and_area(self, u: Floats, depth_mm: float) -> tuple[float, float]:
        """N that lifts the dot and mm2 that touch, of the meshed piece (in two dimensions for each mm of width)."""
        now = self.touch(u, depth_mm)
        force = -(self.top.weight * now.pressure * now.normal[..., -1]).sum()
        return float(force), float(self.top.weight[now.gap < 0.0].sum())


class Floor:
    """The ground under what has come loose from it: it pushes upwards as a stiff wall, without friction."""

    def __init__(self, loose: Skin) -> None:
        self.loose = loose

    def press(self, u: Floats) -> tuple[Indices, Floats, Floats]:
        """Unknowns (k, a), residuals (k, a) and matrices (k, a, a) of the facets at displacements (n, d)."""
        shape, nodes, weight = self.loose.shape, self.loose.nodes, self.loose.weight
        sunk = np.einsum("kqa,ka->kq", shape, u[nodes, -1])
        push, stiff = WALL * np.minimum(sunk, 0.0) * weight, WALL * (sunk < 0.0) * weight
        matrix = np.einsum("kq,kqa,kqb->kab", stiff, shape, shape, optimize=True)
        dim = u.shape[1]
        return nodes * dim + dim - 1, np.einsum("kq,kqa->ka", push, shape), matrix
