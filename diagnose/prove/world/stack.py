"""Equilibrium of a stack under a rigid ridge or cap: Newton's method, contact by a stiff wall at integration points."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import ElementHex2, ElementQuad2, FacetBasis  # type: ignore[import-untyped]

from diagnose.prove.world import laws
from diagnose.prove.world.grid import Grid, Indices, Part, grid, parts
from diagnose.prove.world.laws import Film, Floats, Layer, Made, Memory

try:
    from pypardiso import spsolve
except ImportError:  # there is no MKL for this processor
    from scipy.sparse.linalg import spsolve

WALL = 1e4
"""Stiffness of the contact, MPa/mm: at 1 MPa of pressure the surfaces overlap by a tenth of a micrometre."""
FACET_ORDER = 9
TOLERANCE = 1e-8
MOST_ITERATIONS = 40
STILL_MM = 1e-3
SHARES = (1.0, 0.5, 0.25, 0.1)
"""Of a step of Newton's method, tried in this order."""


@dataclass(frozen=True)
class State:
    """Displacements (n, d), memory of each part, depth of the dot in mm; slope : du / d(depth) of the last step."""

    u: Floats
    memory: tuple[Memory | None, ...]
    depth_mm: float
    slope: Floats


@dataclass(frozen=True)
class Answer:
    """Of the whole stack: force in N, charge in pC of each electrode, touched area in mm2."""

    force_N: float
    charges_pC: tuple[float, ...]
    area_mm2: float

    @property
    def charge_pC(self) -> float:
        """Of all electrodes."""
        return sum(self.charges_pC)


@dataclass(frozen=True)
class Skin:
    """Facets with shape functions (k, q, a), nodes (k, a) and weights (k, q)."""

    shape: Floats
    nodes: Indices
    weight: Floats
    place: Floats


class Stack:
    """A discretised stack."""

    def __init__(self, made: Made) -> None:
        self.made, self.grid = made, grid(made)
        self.parts, self.places = parts(made.layers, self.grid)
        self.dim = self.places.shape[1]
        self.top = _skin(
            self.grid,
            np.isclose(self.grid.mesh.p[-1, self.grid.mesh.facets].max(axis=0), 0.0)
            & np.isclose(np.ptp(self.grid.mesh.p[-1, self.grid.mesh.facets], axis=0), 0.0),
        )
        self.floor = None if made.loose_from_mm is None else self._floor(made.loose_from_mm)
        self.free = self._free()
        self.springs = self._springs()
        self.scale = made.width_mm * self.grid.copies if self.dim == 2 else float(self.grid.copies)

    def rest(self) -> State:
        """Before the touch; a stretched film has pulled the stack into shape."""
        still = np.zeros_like(self.places)
        start = State(still, tuple(part.start() for part in self.parts), -1.0, still)
        return start if self.made.film.prestretch == 0.0 else self.press(start, -1.0, 0.0)

    def press(self, old: State, depth_mm: float, step_s: float) -> State:
        """Equilibrium at a depth, step_s after the old state; halved where Newton's method fails. RuntimeError."""
        return self._halving(old, depth_mm, step_s, 6)

    def _halving(self, old: State, depth_mm: float, step_s: float, left: int) -> State:
        try:
            return self._newton(old, depth_mm, step_s)
        except FloatingPointError as error:
            if left == 0:
                raise RuntimeError(f"no equilibrium at {depth_mm:.4f} mm: {error}") from None
        middle = self._halving(old, 0.5 * (old.depth_mm + depth_mm), 0.5 * step_s, left - 1)
        return self._halving(middle, depth_mm, 0.5 * step_s, left - 1)

    def _newton(self, old: State, depth_mm: float, step_s: float) -> State:
        u = old.u + old.slope * (depth_mm - old.depth_mm)
        residual, matrix, memory = self._assembled(u, old.memory, depth_mm, step_s)
        for _ in range(MOST_ITERATIONS):
            size = self._size(residual)
            if size < TOLERANCE:
                way = depth_mm - old.depth_mm
                slope = (u - old.u) / way if abs(way) > STILL_MM and min(depth_mm, old.depth_mm) > 0.0 else 0.0 * u
                return State(u, memory, depth_mm, slope)
            step = np.zeros(u.size)
            step[self.free] = spsolve(matrix[self.free][:, self.free], residual[self.free])
            u, residual, matrix, memory = self._stepped(u, step.reshape(u.shape), size, old, depth_mm, step_s)
        raise FloatingPointError(f"residual {size:.1e} N")

    def _stepped(
        self, u: Floats, step: Floats, size: float, old: State, depth_mm: float, step_s: float
    ) -> tuple[Floats, Floats, sp.csr_matrix, tuple[Memory | None, ...]]:
        """The step, halved until nothing is inside out and the residual has not grown; at last the smallest step."""
        for share in SHARES:
            try:
                new = u - share * step
                assembled = self._assembled(new, old.memory, depth_mm, step_s)
            except FloatingPointError:
                continue
            if self._size(assembled[0]) < size or share == SHARES[-1]:
                return new, *assembled
        raise FloatingPointError("no step of Newton's method keeps the elements in shape")

    def _size(self, residual: Floats) -> float:
        return float(np.abs(residual[self.free]).max())

    def _assembled(
        self, u: Floats, old: tuple[Memory | None, ...], depth_mm: float, step_s: float
    ) -> tuple[Floats, sp.csr_matrix, tuple[Memory | None, ...]]:
        scatter, memory = _Scatter(u.size), []
        for part, before in zip(self.parts, old, strict=True):
            residual, matrices, after = part.elements(u, before, step_s)
            scatter.add(part.dofs, residual, matrices)
            memory.append(after)
        scatter.add(*self._contact(u, depth_mm))
        if self.floor is not None:
            scatter.add(*self._floored(u, self.floor))
        return scatter.residual + self.springs @ u.ravel(), scatter.matrix() + self.springs, tuple(memory)

    def _distance(self, u: Floats, depth_mm: float) -> tuple[Floats, Floats, Floats]:
        """Gap (k, q), normal (k, q, d) and curvature 1 / r of the dot at the points of the top."""
        where = self.top.place + np.einsum("kqa,kai->kqi", self.top.shape, u[self.top.nodes])
        centre = np.zeros(self.dim)
        centre[0], centre[-1] = self.made.offset_mm, self.made.radius_mm - depth_mm
        arm = where - centre
        length = np.linalg.norm(arm, axis=2)
        return length - self.made.radius_mm, arm / length[..., None], 1.0 / length

    def _floor(self, from_mm: float) -> Skin:
        """The base beyond a distance from the middle."""
        corners = self.grid.mesh.p[:, self.grid.mesh.facets]
        below = np.isclose(corners[-1].max(axis=0), -self.made.height_mm)
        return _skin(self.grid, below & (np.abs(corners[0].mean(axis=0)) > from_mm))

    def _floored(self, u: Floats, floor: Skin) -> tuple[Indices, Floats, Floats]:
        """The floor under what is loose pushes upwards, without friction."""
        sunk = np.einsum("kqa,ka->kq", floor.shape, u[floor.nodes, -1])
        push, stiff = WALL * np.minimum(sunk, 0.0) * floor.weight, WALL * (sunk < 0.0) * floor.weight
        matrix = np.einsum("kq,kqa,kqb->kab", stiff, floor.shape, floor.shape, optimize=True)
        return floor.nodes * self.dim + self.dim - 1, np.einsum("kq,kqa->ka", push, floor.shape), matrix

    def _contact(self, u: Floats, depth_mm: float) -> tuple[Indices, Floats, Floats]:
        gap, normal, curvature = self._distance(u, depth_mm)
        push = WALL * np.minimum(gap, 0.0) * self.top.weight
        stiff = WALL * (gap < 0.0) * self.top.weight
        outer = normal[..., :, None] * normal[..., None, :]
        hessian = stiff[..., None, None] * outer + (push * curvature)[..., None, None] * (np.eye(self.dim) - outer)
        k, a = self.top.nodes.shape
        residual = np.einsum("kq,kqi,kqa->kai", push, normal, self.top.shape).reshape(k, -1)
        matrix = np.einsum("kqij,kqa,kqb->kaibj", hessian, self.top.shape, self.top.shape, optimize=True)
        dofs = (self.top.nodes[:, :, None] * self.dim + np.arange(self.dim)).reshape(k, -1)
        return dofs, residual, matrix.reshape(k, a * self.dim, -1)

    def answer(self, state: State) -> Answer:
        """Force, charge and touched area of a state."""
        gap, normal, _ = self._distance(state.u, state.depth_mm)
        push = WALL * np.minimum(gap, 0.0) * self.top.weight
        film = next(part for part in self.parts if isinstance(part.layer, Film))
        stress = laws.film_stress(self.made.film, film.deformed(state.u))[0]
        density = np.einsum("nii,i->n", stress, np.array(self.made.film.d)) / self.made.film.thickness_mm
        collected = density * film.weight.ravel()
        return Answer(
            float(self.scale * (push * normal[..., -1]).sum()),
            tuple(float(self.scale * (collected * share).sum()) for share in self._shares(film)),
            float(self.scale * self.top.weight[gap < 0.0].sum()),
        )

    def _shares(self, film: Part) -> Iterator[Floats]:
        """Of what is at the points of the film (n,), the share that each electrode collects.

        Of the half of a ridge in the middle an electrode has its own part and the image of the other one.
        """
        x = film.x.ravel()
        for low, high in self.made.strips:
            inside = ((x >= low) & (x <= high)).astype(np.float64)
            image = inside if self.grid.whole else ((-x >= low) & (-x <= high)).astype(np.float64)
            yield 0.5 * (inside + image)

    def _free(self) -> Indices:
        """Unknowns that may move: neither base, nor held sides without springs, nor across a plane of symmetry."""
        fixed = np.zeros((len(self.places), self.dim), dtype=bool)
        fixed[np.isclose(self.places[:, -1], -self.made.height_mm)] = True
        if self.floor is not None:  # its rim stays bonded
            loose = np.unique(self.floor.nodes)
            outside = np.abs(self.places[loose, 0])
            fixed[loose[outside > outside.min() + 1e-9]] = False
        if self.made.spring_N_per_mm3 is None:
            fixed[self._at_held_side(self.places)] = True
        for axis in range(self.dim - 1):
            if not self.grid.whole:
                fixed[np.isclose(self.places[:, axis], 0.0), axis] = True
        return np.flatnonzero(~fixed.ravel())

    def _at_held_side(self, places: Floats) -> NDArray[np.bool_]:
        outside = np.isclose(np.abs(places[:, 0]), self.made.length_mm / 2.0)
        if self.dim == 3:
            outside |= np.isclose(places[:, 1], self.made.width_mm / 2.0)
        held = np.zeros(len(places), dtype=bool)
        low = -self.made.height_mm
        for layer in self.made.layers:
            high = low + layer.thickness_mm
            if isinstance(layer, Layer | Film) and layer.held:
                held |= (places[:, -1] > low - 1e-9) & (places[:, -1] < high + 1e-9)
            low = high
        return np.asarray(outside & held)

    def _springs(self) -> sp.csr_matrix:
        """Traction per displacement at the held sides."""
        size = self.places.size
        if self.made.spring_N_per_mm3 is None:
            return sp.csr_matrix((size, size))
        mesh = self.grid.mesh
        upright = np.isclose(np.abs(mesh.p[0, mesh.facets]).min(axis=0), self.made.length_mm / 2.0)
        if self.dim == 3:
            upright |= np.isclose(np.abs(mesh.p[1, mesh.facets]).min(axis=0), self.made.width_mm / 2.0)
        side = _skin(self.grid, upright & self._at_held_side(mesh.p[:, mesh.facets].mean(axis=1).T))
        mass = self.made.spring_N_per_mm3 * np.einsum("kq,kqa,kqb->kab", side.weight, side.shape, side.shape)
        k, a = side.nodes.shape
        matrices = np.einsum("kab,ij->kaibj", mass, np.eye(self.dim)).reshape(k, a * self.dim, -1)
        dofs = (side.nodes[:, :, None] * self.dim + np.arange(self.dim)).reshape(k, -1)
        scatter = _Scatter(size)
        scatter.add(dofs, np.zeros(dofs.shape), matrices)
        return scatter.matrix()


def _skin(mesh: Grid, chosen: NDArray[np.bool_]) -> Skin:
    """Shape functions on the chosen facets."""
    element = ElementQuad2() if mesh.mesh.dim() == 2 else ElementHex2()
    basis = FacetBasis(mesh.mesh, element, facets=np.flatnonzero(chosen), intorder=FACET_ORDER)
    values = [np.broadcast_to(np.asarray(field[0]), basis.dx.shape) for field in basis.basis]
    shape = np.stack(values).transpose(1, 2, 0)
    used = np.abs(shape).max(axis=(0, 1)) > 1e-12
    where = np.asarray(basis.global_coordinates()).transpose(1, 2, 0)
    return Skin(shape[..., used], basis.element_dofs.T.astype(np.int64)[:, used], basis.dx, where)


class _Scatter:
    """Collects element residuals (m, e) and matrices (m, e, e) at their unknowns (m, e)."""

    def __init__(self, size: int) -> None:
        self.residual = np.zeros(size)
        self.rows: list[Indices] = []
        self.columns: list[Indices] = []
        self.values: list[Floats] = []

    def add(self, dofs: Indices, residual: Floats, matrices: Floats) -> None:
        """Of more elements."""
        self.residual += np.bincount(dofs.ravel(), residual.ravel(), len(self.residual))
        self.rows.append(np.broadcast_to(dofs[:, :, None], matrices.shape).ravel())
        self.columns.append(np.broadcast_to(dofs[:, None, :], matrices.shape).ravel())
        self.values.append(matrices.ravel())

    def matrix(self) -> sp.csr_matrix:
        """Their sum."""
        place = (np.concatenate(self.rows), np.concatenate(self.columns))
        size = len(self.residual)
        return sp.coo_matrix((np.concatenate(self.values), place), shape=(size, size)).tocsr()
