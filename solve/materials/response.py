"""What a law answers at a quadrature point, and what a law with memory makes of it."""

from dataclasses import dataclass
from typing import Protocol

from mesh.types import Floats

Memory = tuple[Floats, ...]  # arrays whose first axis counts the quadrature points


@dataclass(frozen=True)
class Response:
    """Second Piola-Kirchhoff stress (n, 6), tangent (n, 6, 6) and strain energy (n,) at n quadrature points.

    energy is None where no law asks for it.
    """

    stress: Floats
    tangent: Floats
    energy: Floats | None = None


class Inelastic(Protocol):
    """A law with memory that acts on the response of an elastic one."""

    @property
    def needs_energy(self) -> bool:
        """Whether Response.energy is read."""

    def start(self, points: int) -> Memory:
        """Memory of n quadrature points at rest."""

    def update(self, elastic: Response, memory: Memory, time_step: float) -> tuple[Response, Memory]:
        """Response and memory at the end of a time step (s)."""

    def scaled(self, factor: float) -> "Inelastic":
        """The same law in another unit of stress."""
