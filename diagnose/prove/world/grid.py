"""Rectangular elements of the stack, graded towards dot, film and sides: quadrilaterals, or bricks of a quarter.

Regions of the stack as arrays at integration points, and their element matrices.

Displacements are quadratic; the volume change of a rubber is averaged over an element by least squares with linear
functions (Simo, Taylor and Pister 1985), so that no pressure is left as an unknown.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementHex2, ElementQuad2, MeshHex, MeshQuad  # type: ignore[import-untyped]

from diagnose.prove.world import laws
from diagnose.prove.world.laws import Film, Floats, Glue, Layer, Made, Memory, at_rest, respond
from diagnose.prove.world.plastic import Flow, flowed

AXIAL_MM = 0.04
"""Size of elements along the surface under a ridge, mm."""
TOUCHED_MM, NEAR_MM, FAR_MM = 0.5, 0.125, 0.25
"""About a cap: half width of the touched square, size of elements in it and, on average, outside, mm."""
ACROSS_MM = {"ridge": 0.1, "cap": 0.3}
"""Size of elements across the layers, mm."""
MOST_ACROSS = {"ridge": 12, "cap": 4}
TO_SIDES, FROM_TOUCHED, TO_FACES = 1.3, 2.5, {"ridge": 0.9, "cap": 0.6}
"""Grading. Grids 2.2 times as fine differ by 0.04 % at all of the depth of the clamped ridge, by 0.1 and 0.2 % in force
and charge at a third of it, by 0.2 and 0.4 % at a tenth. The last elements at a side are as thin as they may be: of 5
instead of 14 micrometres the uppermost one folds under 0.28 mm on the thick rig.

Under a cap, five elements instead of three from the touched square to a held side change the charge by 0.05 % at half
depth and by 3 % at a tenth of it; evenly spaced ones have 5 and 40 % more.
"""


@dataclass(frozen=True)
class Grid:
    """mesh : of skfem, last coordinate up, top at 0. part : (m,) number of the layer of each element.

    whole : both halves along x; a quarter of a cap, or half of a ridge in the middle, otherwise.
    """

    mesh: MeshQuad | MeshHex
    part: NDArray[np.int64]
    whole: bool

    @property
    def copies(self) -> int:
        """How often the piece makes the whole."""
        half = 1 if self.whole else 2
        return half if self.mesh.dim() == 2 else 4


def grid(made: Made) -> Grid:
    """Elements for what was made."""
    levels, parts = _levels(made)
    whole = made.offset_mm != 0.0 or made.one_sided
    ridge = made.dot == "ridge"
    places = _to_side if ridge else _about_dot
    x = places(made.length_mm / 2.0, made.fine) if not made.electrodes else _between_edges(made)
    if made.loose_from_mm is not None:
        x[1 + np.abs(x[1:-1] - made.loose_from_mm).argmin()] = made.loose_from_mm  # never the middle or the side
    if whole and not made.electrodes:
        x = np.concatenate([-x[:0:-1], x])
    across = [] if ridge else [places(made.width_mm / 2.0, made.fine)]
    mesh = (MeshQuad if ridge else MeshHex).init_tensor(x, *across, levels)
    middle = mesh.p[:, mesh.t].mean(axis=1)
    place = np.searchsorted(levels, middle[-1]) - 1
    return Grid(mesh, np.asarray(parts)[place], whole)


def _to_side(end: float, fine: float) -> Floats:
    """0 to end, finer towards the side, where the stress of a held film is singular."""
    even = np.linspace(0.0, 1.0, max(2, round(end * fine / AXIAL_MM)) + 1)
    return np.asarray(end * (1.0 - (1.0 - even) ** TO_SIDES))


def _between_edges(made: Made) -> Floats:
    """Lines at the edges of electrodes, and between them in sizes that grow from the ridge and from the sides.

    From 0 on where the ridge is in the middle, else over the whole length.
    """
    end, start = made.length_mm / 2.0, 0.0 if made.offset_mm == 0.0 else -made.length_mm / 2.0
    edges = sorted({start, end, *(edge for strip in made.electrodes for edge in strip if edge > start)})
    pieces = [np.array([start])]
    for low, high in pairwise(edges):
        x = np.linspace(low, high, PIECE)
        from_dot, from_side = np.abs(x - made.offset_mm), end - np.abs(x)
        size = np.minimum(AXIAL_MM + GROWS * np.maximum(from_dot - STRIP_MM, 0.0), SIDE_MM + SIDE_GROWS * from_side)
        density = 1.0 / np.minimum(size, WIDEST_MM)
        passed = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(x))])
        count = max(2, round(made.fine * passed[-1]))
        pieces.append(np.interp(np.linspace(0.0, passed[-1], count + 1), passed, x)[1:])
    return np.concatenate(pieces)


STRIP_MM, GROWS, WIDEST_MM = 0.8, 0.06, 0.12
"""About a ridge over one of several electrodes: half width of the fine part, growth of sizes from there, the widest."""
SIDE_MM, SIDE_GROWS = 0.01, 0.2
PIECE = 401


def _about_dot(end: float, fine: float) -> Floats:
    """0 to end, finer where a cap touches, as its force is that of a small patch, and towards the side."""
    near = np.linspace(0.0, TOUCHED_MM, round(TOUCHED_MM * fine / NEAR_MM) + 1)
    even = np.linspace(0.0, 1.0, max(2, round((end - TOUCHED_MM) * fine / FAR_MM)) + 1)
    far = end - (end - TOUCHED_MM) * (1.0 - even) ** FROM_TOUCHED
    return np.concatenate([near, far[1:]])


def _levels(made: Made) -> tuple[Floats, list[int]]:
    """Heights of the rows of elements from the base (top at 0), and the layer of each row."""
    heights, parts = [-made.height_mm], []
    for number, layer in enumerate(made.layers):
        rows = _rows(layer, made)
        parts += [number] * (len(rows) - 1)
        heights += list(heights[-1] + rows[1:])
    heights[-1] = 0.0
    return np.array(heights), parts


def _rows(layer: Layer | Film | Glue, made: Made) -> Floats:
    """Finer at both faces of a layer; film and glue are one row."""
    if not isinstance(layer, Layer):
        return np.array([0.0, layer.thickness_mm])
    count = min(max(2, round(layer.thickness_mm / ACROSS_MM[made.dot])), MOST_ACROSS[made.dot])
    even = np.linspace(0.0, 1.0, round(made.fine * count) + 1)
    return np.asarray(layer.thickness_mm * (even - TO_FACES[made.dot] * np.sin(2.0 * np.pi * even) / (2.0 * np.pi)))


Indices = NDArray[np.int64]


def unknowns(nodes: Indices, dim: int) -> Indices:
    """(m, a dim) of nodes (m, a): node by node, component by component."""
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
        """(m, a d) unknowns."""
        return unknowns(self.nodes, self.gradient.shape[3])

    def start(self) -> Memory | Flow | None:
        """Memory at rest; None for what has none."""
        if isinstance(self.layer, Film):
            return None if self.layer.yield_MPa is None else Flow.none(self.weight.size)
        return at_rest(self.layer, self.weight.size) if isinstance(self.layer, Layer) else None

    def deformed(self, u: Floats) -> Floats:
        """F (m q, 3, 3) for displacements (n, d); in two dimensions nothing moves along y."""
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
        f, before = self.deformed(u), self.deformed(came_from)
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
        residual, matrix = self._integrated(p + pressure[:, None, None] * cofactor, tangent + bend)
        return residual, matrix + self._volume_matrix(cofactor), new

    def _sheet(
        self, film: Film, f: Floats, before: Floats, old: Memory | Flow | None
    ) -> tuple[Floats, Floats, Memory | Flow | None]:
        if isinstance(old, Flow):
            p, tangent, new = flowed(film, f, old)
        else:
            (_, p, tangent), new = laws.film_stress(film, f), None
        step = f - before
        beyond = laws.hooke(film, -0.5 * np.einsum("nki,nkj->nij", step, step))
        return *self._integrated(p, tangent + laws.geometric(beyond)), new

    @cached_property
    def _averaging(self) -> Floats:
        """The inverse (m, l, l) of the mass of the linear functions."""
        weighted = self.weight[..., None] * self.linear
        return np.asarray(np.linalg.inv(np.einsum("mql,mqk->mlk", weighted, self.linear)))

    def _pressure(self, change: Floats) -> Floats:
        """(m q,) of the averaged volume change (m q,)."""
        weighted = self.weight * change.reshape(self.weight.shape)
        share = np.einsum("mlk,mqk,mq->ml", self._averaging, self.linear, weighted)
        return np.asarray(laws.bulk_modulus(self.layer) * np.einsum("mql,ml->mq", self.linear, share).ravel())

    def _volume_matrix(self, cofactor: Floats) -> Floats:
        """Bulk modulus times the derivative of the averaged volume change, squared."""
        b = np.einsum("mqij,mqaj->mqai", self._plane(cofactor), self.gradient)
        rate = np.einsum("mq,mql,mqx->mlx", self.weight, self.linear, b.reshape(*self.weight.shape, -1))
        return np.asarray(laws.bulk_modulus(self.layer) * rate.transpose(0, 2, 1) @ self._averaging @ rate)

    def _plane(self, tensor: Floats) -> Floats:
        """(m q, 3, 3) -> (m, q, d, d)."""
        axes = np.array([0, 2] if self.gradient.shape[3] == 2 else [0, 1, 2])
        return tensor[:, axes[:, None], axes].reshape(*self.weight.shape, len(axes), len(axes))

    def _integrated(self, p: Floats, tangent: Floats) -> tuple[Floats, Floats]:
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
    """Every layer, and the places (n, d) of the nodes."""
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
