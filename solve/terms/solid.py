"""The media: quadratic displacement, linear pressure, any hyperelastic law with or without memory.

A compressible foam has no pressure unknown, as its law gives the whole stress; and where a trial state turns an element
inside out, it is refused.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.fem.compressible_solid import compressible_solid
from solve.fem.kinematics import cauchy_green, deformation_gradient, smallest_jacobian
from solve.fem.mixed_solid import mixed_solid
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import linear, physical_gradients, quadratic
from solve.materials.inelastic import Inelastic, Memory, StressResponse, respond, rest_memories, time_error
from solve.materials.laws import MediumLaw
from solve.terms.base import Block, History, Term, Trial

CHUNK = 4096  # elements assembled at a time: bounds the memory of the element matrices


class InvertedElementError(ArithmeticError):
    """A trial state turns an element inside out. nodes : (10,) of the element."""

    def __init__(self, region: str, nodes: Ints) -> None:
        super().__init__(f"an element of {region} is turned inside out")
        self.region, self.nodes = region, nodes


def refuse_inversion(f: Floats, region: str, tets: Ints) -> None:
    """InvertedElementError when det F <= 0 anywhere; f (m, q, 3, 3), tets (m, 10)."""
    smallest = smallest_jacobian(f)
    if not smallest.min() > 0.0:
        raise InvertedElementError(region, tets[int(np.argmin(smallest))])


@dataclass(frozen=True)
class SolidRegion(Term):
    """One medium. tets: (m, 10) nodes; dofs: (m, 34) unknowns, displacements first, or (m, 30) of a foam.

    gradient, weight : quadrature; inelastic : laws with memory, each acting on the response of the one before.
    """

    name: str
    law: MediumLaw
    tets: Ints
    dofs: Ints
    gradient: Floats
    weight: Floats
    inelastic: tuple[Inelastic, ...] = ()

    @property
    def groups(self) -> tuple[Ints, ...]:
        """Unknowns of the elements."""
        return (self.dofs,)

    def start(self) -> History:
        """Memory of every inelastic law at rest."""
        return rest_memories(self.inelastic, self.weight.size)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Element matrices and residuals, chunk by chunk. InvertedElementError."""
        for part, f in self._chunks(trial):
            response = self.respond(f, _part_of(history, part, self.weight), trial.time_step)[0]
            yield Block(0, part, *self._integrate(part, f, response, trial.x))

    def advance(self, trial: Trial, history: History) -> History:
        """Memory at the converged state."""
        if not self.inelastic:
            return history
        parts = [
            self.respond(f, _part_of(history, part, self.weight), trial.time_step)[1] for part, f in self._chunks(trial)
        ]
        return tuple(tuple(np.concatenate(a) for a in zip(*m, strict=True)) for m in zip(*parts, strict=True))

    def time_error(self, history: History, new: History, time_step: float, after_kink: bool) -> float:
        """Error of the time integration in this step, relative to the largest stress."""
        return time_error(self.inelastic, history, new, time_step, after_kink)

    def respond(
        self, f: Floats, memory: tuple[Memory, ...], time_step: float
    ) -> tuple[StressResponse, tuple[Memory, ...]]:
        """Isochoric (of a foam: whole) response at F (s, q, 3, 3) in points in order, and the new memory."""
        c = cauchy_green(f)
        energy = self.law.energy(c) if any(law.needs_energy for law in self.inelastic) else None
        return respond(self.inelastic, StressResponse(*self.law.stress(c), energy, c), memory, time_step)

    def _chunks(self, trial: Trial) -> Iterator[tuple[slice, Floats]]:
        for start in range(0, len(self.tets), CHUNK):
            part = slice(start, start + CHUNK)
            f = deformation_gradient(self.gradient[part], trial.displacement[self.tets[part]])
            refuse_inversion(f, self.name, self.tets[part])
            yield part, f

    def _integrate(self, part: slice, f: Floats, response: StressResponse, x: Floats) -> tuple[Floats, Floats]:
        stress = response.stress.reshape(*f.shape[:2], 6)
        tangent = np.ascontiguousarray(response.tangent).reshape(*f.shape[:2], 6, 6)
        ke, re = np.empty((len(f), *2 * self.dofs.shape[1:])), np.empty((len(f), self.dofs.shape[1]))
        if self.law.compressible:
            compressible_solid(self.gradient[part], self.weight[part], f, stress, tangent, ke, re)
            return ke, re
        pressure = x[self.dofs[part, 30:]]
        shape_p = linear(tetrahedron()[0])
        mixed_solid(
            self.gradient[part], self.weight[part], shape_p, f, pressure, self.law.bulk_modulus, stress, tangent, ke, re
        )
        return ke, re


def _part_of(history: History, part: slice, weight: Floats) -> tuple[Memory, ...]:
    """The memory of the quadrature points of some elements."""
    points = weight.shape[1]
    return tuple(tuple(a[part.start * points : part.stop * points] for a in memory) for memory in history)


def solid_region(
    name: str, law: MediumLaw, points: Floats, tets: Ints, dofs: Ints, inelastic: tuple[Inelastic, ...] = ()
) -> SolidRegion:
    """Prepare a medium: points (n, 3), tets (m, 10), dofs (m, 34), or (m, 30) for a compressible law."""
    reference, weight = tetrahedron()
    gradient, volume = physical_gradients(points[tets], quadratic(reference)[1], weight)
    return SolidRegion(name, law, tets, np.ascontiguousarray(dofs), gradient, volume, inelastic)
