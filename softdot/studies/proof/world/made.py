"""What was really made, as the generator of recordings knows it. Units: mm, N, MPa, s, pC, V."""

import hashlib
from dataclasses import dataclass, replace
from typing import Literal


@dataclass(frozen=True)
class Spectrum:
    """Fractional Zener relaxation: G(t) / G(0) = 1 - strength (1 - E_alpha(-(t / time)^alpha))."""

    strength: float
    time_s: float
    order: float = 0.5


@dataclass(frozen=True)
class Damage:
    """Pseudo-elastic softening below the largest energy so far, with tanh (Dorfmann and Ogden 2003)."""

    loss: float
    energy_MPa: float


@dataclass(frozen=True)
class Layer:
    """Neo-Hookean; with gent_limit the energy of Gent (1996), -mu Jm / 2 log(1 - (I1 - 3) / Jm)."""

    name: str
    thickness_mm: float
    modulus_MPa: float
    poisson_ratio: float = 0.495
    gent_limit: float | None = None
    spectrum: Spectrum | None = None
    damage: Damage | None = None
    held: bool = False


@dataclass(frozen=True)
class Film:
    """Linear piezoelectric film, d in pC/N along x, y and z; prestretch : nominal strain along x before bonding.

    yield_MPa : von Mises stress at which it yields, None for never; hardening_MPa : slope of that over plastic strain.
    """

    thickness_mm: float = 0.028
    modulus_MPa: float = 2000.0
    poisson_ratio: float = 0.29
    d: tuple[float, float, float] = (23.0, 2.3, -33.0)
    relative_permittivity: float = 12.0
    held: bool = False
    prestretch: float = 0.0
    yield_MPa: float | None = None
    hardening_MPa: float = 0.0


@dataclass(frozen=True)
class Glue:
    """A resolved layer of soft compressible glue, in the place of a medium's skin."""

    thickness_mm: float
    modulus_MPa: float
    poisson_ratio: float = 0.45


@dataclass(frozen=True)
class Made:
    """A stack from the base up; the film lies among the layers by name "film". spring : sides, N/mm3; None: rigid.

    dot : "ridge" (plane strain, force for width_mm) or "cap" (a quarter in 3D). fine : elements are this much smaller.
    electrodes : from and to along x, growing, each over the whole width, of a ridge; none: one all over the film.
    loose_from_mm : beyond this distance from the middle the base of a ridge's stack is not bonded; None: it is.
    one_sided : it is loose there on the right alone.
    """

    layers: tuple[Layer | Film | Glue, ...]
    length_mm: float
    width_mm: float
    dot: Literal["ridge", "cap"]
    radius_mm: float
    offset_mm: float = 0.0
    spring_N_per_mm3: float | None = None
    fine: float = 1.0
    electrodes: tuple[tuple[float, float], ...] = ()
    loose_from_mm: float | None = None
    one_sided: bool = False

    @property
    def strips(self) -> tuple[tuple[float, float], ...]:
        """Begin and end along x of every electrode."""
        return self.electrodes or ((-self.length_mm / 2.0, self.length_mm / 2.0),)

    @property
    def film(self) -> Film:
        """The film."""
        return next(layer for layer in self.layers if isinstance(layer, Film))

    @property
    def height_mm(self) -> float:
        """Height of the whole stack."""
        return sum(layer.thickness_mm for layer in self.layers)

    @property
    def capacitance_pF(self) -> float:
        """Capacitance of the undeformed film under all electrodes."""
        return sum(self.capacitances_pF)

    @property
    def capacitances_pF(self) -> tuple[float, ...]:
        """Capacitance of the undeformed film under each electrode."""
        film = self.film
        per_mm = 8.8541878128e-3 * film.relative_permittivity * self.width_mm / film.thickness_mm
        return tuple(per_mm * (high - low) for low, high in self.strips)

    @property
    def mirror_image(self) -> "Made":
        """The image in x = 0, electrodes growing along x again: the last one is the image of the first."""
        strips = tuple((-high, -low) for low, high in reversed(self.electrodes))
        return replace(self, offset_mm=-self.offset_mm, electrodes=strips)

    @property
    def remembers(self) -> bool:
        """Whether an answer depends on what happened before."""
        relaxes = any(isinstance(layer, Layer) and layer.spectrum for layer in self.layers)
        return relaxes or self.keeps_damage

    @property
    def keeps_damage(self) -> bool:
        """Whether something in the stack remembers for good."""
        softens = any(isinstance(layer, Layer) and layer.damage for layer in self.layers)
        return softens or self.film.yield_MPa is not None

    def key(self) -> str:
        """Hash of all of it."""
        return hashlib.sha256(repr(self).encode()).hexdigest()[:32]
