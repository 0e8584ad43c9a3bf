"""Equilibrium of a stack under a rigid ridge or cap: Newton's method."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from softdot.studies.proof.world import laws
from softdot.studies.proof.world.arrays import Floats, Indices
from softdot.studies.proof.world.contact import Dot, Floor, skin
from softdot.studies.proof.world.grid import grid
from softdot.studies.proof.world.made import Film, Layer, Made
from softdot.studies.proof.world.memory_laws import Memory
from softdot.studies.proof.world.parts import Part, parts
from softdot.studies.proof.world.plastic import Flow

try:
    from pypardiso import spsolve
except ImportError:  # there is no MKL for this processor
    from scipy.sparse.linalg import spsolve

RESIDUAL_TOLERANCE = 1e-8
MOST_ITERATIONS = 20
MOST_HALVINGS = 8
STILL_MM = 1e-3

Memories = tuple[Memory | Flow | None, ...]


@dataclass(frozen=True)
class State:
    """Displacements (n, d), memory of each part, depth of the dot in mm; slope : du / d(depth) of the last step."""

    u: Floats
    memory: Memories
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
        """Charge of all electrodes."""
        return sum(self.charges_pC)


class Stack:
    """A discretised stack."""

    def __init__(self, made: Made) -> None:
        self.made, self.grid = made, grid(made)
        self.parts, self.places = parts(made.layers, self.grid)
        self.dim = self.places.shape[1]
        levels = self.grid.mesh.p[-1, self.grid.mesh.facets]
        on_top = np.isclose(levels.max(axis=0), 0.0) & np.isclose(np.ptp(levels, axis=0), 0.0)
        self.dot = Dot(made, skin(self.grid, on_top))
        self.floor = None if made.loose_from_mm is None else self._floor(made.loose_from_mm)
        self.free = self._free()
        self.springs = self._springs()
        self.scale = made.width_mm * self.grid.copies if self.dim == 2 else float(self.grid.copies)

    @cached_property
    def squeeze(self) -> Floats:
        """Derivative du / d(depth) (n, d) where the depth hardly changes: the stack follows the dot, and what touches
        stays.
        """
        follows = np.zeros(self.places.size)
        follows[self.free] = 1.0
        along = follows.reshape(self.places.shape)[:, -1] * (-1.0 - self.places[:, -1] / self.made.height_mm)
        return np.pad(along[:, None], ((0, 0), (self.dim - 1, 0)))

    def rest(self) -> State:
        """Before the touch; a stretched film has pulled the stack into shape."""
        still = np.zeros_like(self.places)
        start = State(still, tuple(part.start() for part in self.parts), -1.0, still)
        return start if self.made.film.prestretch == 0.0 else self.press(start, -1.0, 0.0)

    def press(self, old: State, depth_mm: float, step_s: float) -> State:
        """Equilibrium at a depth, step_s after the old state; halved where Newton's method fails. RuntimeError."""
        return self._halving(old, depth_mm, step_s, MOST_HALVINGS)

    def _halving(self, old: State, depth_mm: float, step_s: float, left: int) -> State:
        try:
            return self._newton(old, depth_mm, step_s)
        except FloatingPointError as error:
            if left == 0:
                raise RuntimeError(f"no equilibrium at {depth_mm:.4f} mm: {error}") from None
        middle = self._halving(old, 0.5 * (old.depth_mm + depth_mm), 0.5 * step_s, left - 1)
        return self._halving(middle, depth_mm, 0.5 * step_s, left - 1)

    def _newton(self, old: State, depth_mm: float, step_s: float) -> State:
        u = came_from = old.u + old.slope * (depth_mm - old.depth_mm)
        for _ in range(MOST_ITERATIONS):
            residual, matrix, memory = self._assemble(u, came_from, old.memory, depth_mm, step_s)
            size = self._size(residual)
            if size < RESIDUAL_TOLERANCE:
                way = depth_mm - old.depth_mm
                if min(depth_mm, old.depth_mm) <= 0.0:
                    return State(u, memory, depth_mm, 0.0 * u)
                return State(u, memory, depth_mm, (u - old.u) / way if abs(way) > STILL_MM else self.squeeze)
            step = np.zeros(u.size)
            step[self.free] = spsolve(matrix[self.free][:, self.free], residual[self.free])
            came_from, u = u, u - step.reshape(u.shape)
        raise FloatingPointError(f"residual {size:.1e} N")

    def _size(self, residual: Floats) -> float:
        return float(np.abs(residual[self.free]).max())

    def _assemble(
        self, u: Floats, came_from: Floats, old: Memories, depth_mm: float, step_s: float
    ) -> tuple[Floats, sp.csr_matrix, Memories]:
        """Residual, tangent and memories at displacements u (n, d) and a depth, after a step from came_from."""
        scatter, memory = _Scatter(u.size), []
        for part, before in zip(self.parts, old, strict=True):
            residual, matrices, after = part.elements(u, came_from, before, step_s)
            scatter.add(part.dofs, residual, matrices)
            memory.append(after)
        scatter.add(*self.dot.press(u, depth_mm))
        if self.floor is not None:
            scatter.add(*self.floor.press(u))
        return scatter.residual + self.springs @ u.ravel(), scatter.matrix() + self.springs, tuple(memory)

    def _floor(self, from_mm: float) -> Floor:
        """The base beyond a distance from the middle."""
        corners = self.grid.mesh.p[:, self.grid.mesh.facets]
        below = np.isclose(corners[-1].max(axis=0), -self.made.height_mm)
        middle = corners[0].mean(axis=0)
        return Floor(skin(self.grid, below & ((middle if self.made.one_sided else np.abs(middle)) > from_mm)))

    def answer(self, state: State) -> Answer:
        """Force, charge and touched area of a state."""
        number, film = next((n, part) for n, part in enumerate(self.parts) if isinstance(part.layer, Film))
        flow = state.memory[number]
        flown = flow.strain if isinstance(flow, Flow) else None
        stress = laws.film_stress(self.made.film, film.deformation_gradients(state.u), flown)[0]
        density = np.einsum("nii,i->n", stress, np.array(self.made.film.d)) / self.made.film.thickness_mm
        collected = density * film.weight.ravel()
        force, area = self.dot.force_and_area(state.u, state.depth_mm)
        charges = tuple(float(self.scale * (collected * share).sum()) for share in self._shares(film))
        return Answer(self.scale * force, charges, self.scale * area)

    def _shares(self, film: Part) -> Iterator[Floats]:
        """Shares (n,) of the charge at the points of the film that each electrode collects.

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
            loose = np.unique(self.floor.loose.nodes)
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
        side = skin(self.grid, upright & self._at_held_side(mesh.p[:, mesh.facets].mean(axis=1).T))
        mass = self.made.spring_N_per_mm3 * np.einsum("kq,kqa,kqb->kab", side.weight, side.shape, side.shape)
        dofs = side.dofs(self.dim)
        matrices = np.einsum("kab,ij->kaibj", mass, np.eye(self.dim)).reshape(*dofs.shape, -1)
        scatter = _Scatter(size)
        scatter.add(dofs, np.zeros(dofs.shape), matrices)
        return scatter.matrix()


class _Scatter:
    """Collects element residuals (m, e) and matrices (m, e, e) at their unknowns (m, e)."""

    def __init__(self, size: int) -> None:
        self.residual = np.zeros(size)
        self.rows: list[Indices] = []
        self.columns: list[Indices] = []
        self.values: list[Floats] = []

    def add(self, dofs: Indices, residual: Floats, matrices: Floats) -> None:
        """Add the residuals and matrices of more elements."""
        self.residual += np.bincount(dofs.ravel(), residual.ravel(), len(self.residual))
        self.rows.append(np.broadcast_to(dofs[:, :, None], matrices.shape).ravel())
        self.columns.append(np.broadcast_to(dofs[:, None, :], matrices.shape).ravel())
        self.values.append(matrices.ravel())

    def matrix(self) -> sp.csr_matrix:
        """Sum of the matrices that were added."""
        place = (np.concatenate(self.rows), np.concatenate(self.columns))
        size = len(self.residual)
        return sp.coo_matrix((np.concatenate(self.values), place), shape=(size, size)).tocsr()
