"""What a law answers at a quadrature point, and what a law with memory makes of it."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from foundation.arrays import Floats

Memory = tuple[Floats, ...]  # arrays whose first axis counts the quadrature points


@dataclass(frozen=True)
class StressResponse:
    """Second Piola-Kirchhoff stress (n, 6), tangent (n, 6, 6) and strain energy (n,) at n quadrature points.

    energy is None where no law asks for it; cauchy_green : C (n, 3, 3) of a medium, None of a film or a bond.
    """

    stress: Floats
    tangent: Floats
    energy: Floats | None = None
    cauchy_green: Floats | None = None


class Inelastic(Protocol):
    """A law with memory that acts on the response of an elastic one."""

    @property
    def needs_energy(self) -> bool:
        """Whether StressResponse.energy is read."""

    def start(self, points: int, components: int = 6) -> Memory:
        """Memory of n quadrature points at rest; components : of a stress, or of a bond's jump."""

    def update(self, elastic: StressResponse, memory: Memory, time_step: float) -> tuple[StressResponse, Memory]:
        """Response and memory at the end of a time step (s)."""

    def scale_moduli(self, factor: float) -> "Inelastic":
        """The law with its moduli times a factor, for another unit of stress."""

    def time_error(self, memory: Memory, new: Memory, time_step: float, after_kink: bool) -> float:
        """Error of the time integration in a step, relative to the largest stress; 0 for a law without rates."""


class StatedLaw(ABC):
    """A law with memory as it is stated, with stresses in MPa and times in s. words : what it is, for a reader.

    order : laws around one material act in this order, from the elastic one on; one takes the place of another of its
    order. linear : in the history of the elastic stress. follows_time : whether the path or its speed matters to it.
    """

    words: ClassVar[str]
    order: ClassVar[float]
    linear = False
    follows_time = True

    @property
    def is_off(self) -> bool:
        """Whether its values change nothing."""
        return False

    @abstractmethod
    def around(self, elastic: Any, MPa: float) -> Inelastic:
        """The law around an elastic one of a medium or the film, None of a bond; MPa : one in the solver's unit."""


SOFTENING, YIELD, RELAXATION = 0.0, 1.0, 2.0
"""The order of the laws: what relaxes is the stress that softening and yield leave."""


def sort_laws(laws: Sequence[StatedLaw]) -> list[StatedLaw]:
    """Laws in the order in which they act, from the elastic one on."""
    return sorted(laws, key=lambda law: law.order)


def rest_memories(laws: Sequence[Inelastic], points: int, components: int = 6) -> tuple[Memory, ...]:
    """Memories at rest of laws that act one after the other, at a number of quadrature points."""
    return tuple(law.start(points, components) for law in laws)


def respond(
    laws: Sequence[Inelastic], elastic: StressResponse, memories: Sequence[Memory], time_step: float
) -> tuple[StressResponse, tuple[Memory, ...]]:
    """Apply each law to the response of the one before; returns the last response and the new memories."""
    response, new = elastic, []
    for law, memory in zip(laws, memories, strict=True):
        response, now = law.update(response, memory, time_step)
        new.append(now)
    return response, tuple(new)


def time_error(
    laws: Sequence[Inelastic], old: Sequence[Memory], new: Sequence[Memory], time_step: float, after_kink: bool
) -> float:
    """Largest error of the time integration of these laws in a step, relative to the largest stress."""
    each = zip(laws, old, new, strict=True)
    return max((law.time_error(before, now, time_step, after_kink) for law, before, now in each), default=0.0)
