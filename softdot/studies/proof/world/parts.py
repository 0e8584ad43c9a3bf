"""Regions of the stack as arrays at integration points, and their element matrices.

Displacements are quadratic; the volume change of a rubber is averaged over an element by least squares with linear
functions (Simo, Taylor and Pister 1985), so that no pressure is left as an unknown.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import Basis, ElementHex2, ElementQuad2  # type: ignore[import-untyped]

from softdot.studies.proof.world import laws
from softdot.studies.proof.world.arrays import Floats, Indices
from softdot.studies.proof.world.grid import Grid
from softdot.studies.proof.world.made import Film, Glue, Layer
from softdot.studies.proof.world.memory_laws import Memory, at_rest, respond
from softdot.studies.proof.world.plastic import Flow, flow_step


def unknowns(nodes: Indices, dim: int) -> Indices:
    """Unknowns (m, a dim) of nodes (m, a): node by node, component by component."""
    return np.asarray((nodes[:, :, None] * dim + np.arange(dim)).reshape(len(nodes), -1))


@dataclass(frozen=True)
class Part:
    """One layer. nodes : (m, a); gradient : (m, q, a, d); weight, x : (m, q); linear : (m, q, d + 1)."""

    layer: Layer | Film | Glue
    nodes: Indices
    gradient: Floats
    weight: Floats
    x: Floats
    linear: Floats

    @property
    def dofs(self) -> Indices:
        """Unknowns (m, a d) of the elements."""
        return unknowns(self.nodes, self.gradient.shape[3])

    def start(self) -> Memory | Flow | None:
        """Memory at rest; None for what has none."""
        if isinstance(self.layer, Film):
            return None if self.layer.yield_MPa is None else Flow.none(self.weight.size)
        return at_rest(self.layer, self.weight.size) if isinstance(self.layer, Layer) else None

    def deformation_gradients(self, u: Floats) -> Floats:
        """Deformation gradients F (m q, 3, 3) for displacements (n, d); in two dimensions nothing moves along y."""
        d = u.shape[1]
        axes = np.array([0, 2] if d == 2 else [0, 1, 2])
        inner = np.einsum("mqaj,mai->mqij", self.gradient, u[self.nodes])
        f = np.broadcast_to(np.eye(3), (*self.weight.shape, 3, 3)).copy()
        f[..., axes[:, None], axes] += inner
        return f.reshape(-1, 3, 3)

    def elements(
        self, u: Floats, came_from: Floats, old: Memory | Flow | None, step_s: float
    ) -> tuple[Floats, Floats, Memory | Flow | None]:
        """Residuals (m, a d), matrices (m, a d, a d), memory after the step. FloatingPointError when inside out.

        came_from : (n, d) the iterate before u. What is stiff and bent, the stress of the film and the pressure of a
        rubber, stands in the matrix as it was extrapolated from there (Magisano, Leonetti and Garcea, Comput. Methods
        Appl. Mech. Eng. 313, 2017): under a round dot Newton's method then takes a third of the iterations.
        """
        f, before = self.deformation_gradients(u), self.deformation_gradients(came_from)
        if np.linalg.det(f).min() <= 0.0:
            raise FloatingPointError("an element is turned inside out")
        if isinstance(self.layer, Film):
            return self._sheet(self.layer, f, before, old)
        new = old
        if isinstance(self.layer, Layer) and isinstance(old, Memory):
            p, tangent, new = respond(self.layer, f, old, step_s)
        else:
            _, p, tangent = laws.isochoric(self.layer, f)
        (j, cofactor), (j_before, slope) = laws.volumetric(f), laws.volumetric(before)
        pressure = self._pressure(j - 1.0)
        extrapolated = self._pressure(j_before - 1.0 + np.einsum("nij,nij->n", slope, f - before))
        bend = laws.volume_curvature(j, cofactor, extrapolated)
        residual, matrix = self._integrate(p + pressure[:, None, None] * cofactor, tangent + bend)
        return residual, matrix + self._volume_matrix(cofactor), new

    def _sheet(
        self, film: Film, f: Floats, before: Floats, old: Memory | Flow | None
    ) -> tuple[Floats, Floats, Memory | Flow | None]:
        if isinstance(old, Flow):
            p, tangent, new = flow_step(film, f, old)
        else:
            (_, p, tangent), new = laws.film_stress(film, f), None
        step = f - before
        beyond = laws.hooke(film, -0.5 * np.einsum("nki,nkj->nij", step, step))
        return *self._integrate(p, tangent + laws.geometric(beyond)), new

    @cached_property
    def _averaging(self) -> Floats:
        """The inverse (m, l, l) of the mass of the linear functions."""
        weighted = self.weight[..., None] * self.linear
        return np.asarray(np.linalg.inv(np.einsum("mql,mqk->mlk", weighted, self.linear)))

    def _pressure(self, change: Floats) -> Floats:
        """Pressure (m q,) of the averaged volume change (m q,)."""
        weighted = self.weight * change.reshape(self.weight.shape)
        share = np.einsum("mlk,mqk,mq->ml", self._averaging, self.linear, weighted)
        return np.asarray(laws.bulk_modulus(self.layer) * np.einsum("mql,ml->mq", self.linear, share).ravel())

    def _volume_matrix(self, cofactor: Floats) -> Floats:
        """Bulk modulus times the derivative of the averaged volume change, squared."""
        b = np.einsum("mqij,mqaj->mqai", self._plane(cofactor), self.gradient)
        rate = np.einsum("mq,mql,mqx->mlx", self.weight, self.linear, b.reshape(*self.weight.shape, -1))
        return np.asarray(laws.bulk_modulus(self.layer) * rate.transpose(0, 2, 1) @ self._averaging @ rate)

    def _plane(self, tensor: Floats) -> Floats:
        """Components in the plane (m, q, d, d) of tensors (m q, 3, 3)."""
        axes = np.array([0, 2] if self.gradient.shape[3] == 2 else [0, 1, 2])
        return tensor[:, axes[:, None], axes].reshape(*self.weight.shape, len(axes), len(axes))

    def _integrate(self, p: Floats, tangent: Floats) -> tuple[Floats, Floats]:
        """Residuals and matrices of elements from stress and tangent at the points."""
        m, q, a, d = self.gradient.shape
        axes = np.array([0, 2] if d == 2 else [0, 1, 2])
        residual = np.einsum("mq,mqij,mqaj->mai", self.weight, self._plane(p), self.gradient, optimize=True)
        inner = tangent[:, axes[:, None, None, None], axes[:, None, None], axes[:, None], axes]
        law = inner.reshape(m, q, d * d, d * d) * self.weight[..., None, None]
        by_component = np.zeros((m, q, d, d, a, d))
        for i in range(d):
            by_component[:, :, i, :, :, i] = self.gradient.transpose(0, 1, 3, 2)
        operator = by_component.reshape(m, q, d * d, a * d)
        right = (law @ operator).reshape(m, q * d * d, a * d)
        return residual.reshape(m, -1), operator.reshape(m, q * d * d, a * d).transpose(0, 2, 1) @ right


def parts(made_layers: tuple[Layer | Film | Glue, ...], mesh: Grid) -> tuple[list[Part], Floats]:
    """Parts of every layer, and the places (n, d) of the nodes."""
    element = ElementQuad2() if mesh.mesh.dim() == 2 else ElementHex2()
    basis = Basis(mesh.mesh, element, intorder=4)
    gradient = np.stack([field[0].grad for field in basis.basis]).transpose(2, 3, 0, 1)
    where = np.asarray(basis.global_coordinates()).transpose(1, 2, 0)
    weight, nodes = basis.dx, basis.element_dofs.T.astype(np.int64)
    found = []
    for number, layer in enumerate(made_layers):
        inside = mesh.part == number
        arms = where[inside] - where[inside].mean(axis=1, keepdims=True)
        linear = np.concatenate([np.ones((*arms.shape[:2], 1)), arms / np.abs(arms).max()], axis=2)
        x = where[inside][..., 0]
        found.append(Part(layer, nodes[inside], gradient[inside], weight[inside], x, linear))
    return found, basis.doflocs.T
