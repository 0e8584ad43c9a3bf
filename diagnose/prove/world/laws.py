"""Stress P = dW/dF and tangent dP/dF at deformation gradients (n, 3, 3), by derivatives of invariants of F.

Laws with memory at the points of one layer: a fractional spectrum, and softening after the largest energy.

What was really made, as the generator of recordings knows it. Units: mm, N, MPa, s, pC, V.
"""

import hashlib
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


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
        """From and to along x of every electrode."""
        return self.electrodes or ((-self.length_mm / 2.0, self.length_mm / 2.0),)

    @property
    def film(self) -> Film:
        """The film."""
        return next(layer for layer in self.layers if isinstance(layer, Film))

    @property
    def height_mm(self) -> float:
        """Of the whole stack."""
        return sum(layer.thickness_mm for layer in self.layers)

    @property
    def capacitance_pF(self) -> float:
        """Of the undeformed film under all electrodes."""
        return sum(self.capacitances_pF)

    @property
    def capacitances_pF(self) -> tuple[float, ...]:
        """Of the undeformed film under each electrode."""
        film = self.film
        per_mm = 8.8541878128e-3 * film.relative_permittivity * self.width_mm / film.thickness_mm
        return tuple(per_mm * (high - low) for low, high in self.strips)

    @property
    def mirrored(self) -> "Made":
        """Its image in x = 0, electrodes growing along x again: the last one is the image of the first."""
        strips = tuple((-high, -low) for low, high in reversed(self.electrodes))
        return replace(self, offset_mm=-self.offset_mm, electrodes=strips)

    @property
    def remembers(self) -> bool:
        """Whether an answer depends on what happened before."""
        relaxes = any(isinstance(layer, Layer) and layer.spectrum for layer in self.layers)
        return relaxes or self.damaged

    @property
    def damaged(self) -> bool:
        """Whether it remembers for good."""
        softens = any(isinstance(layer, Layer) and layer.damage for layer in self.layers)
        return softens or self.film.yield_MPa is not None

    def key(self) -> str:
        """Hash of all of it."""
        return hashlib.sha256(repr(self).encode()).hexdigest()[:32]


EYE = np.eye(3)
VOLUME = np.einsum("ij,kl->ijkl", EYE, EYE)
DEVIATOR = 0.5 * (np.einsum("ik,jl->ijkl", EYE, EYE) + np.einsum("il,jk->ijkl", EYE, EYE)) - VOLUME / 3.0
"""A change of volume, three times as large, and the rest of a symmetric tensor, as tensors of the fourth rank."""


def shear_modulus(layer: Layer | Glue | Film) -> float:
    """Small-strain shear modulus, MPa."""
    return layer.modulus_MPa / (2.0 * (1.0 + layer.poisson_ratio))


def bulk_modulus(layer: Layer | Glue | Film) -> float:
    """Small-strain bulk modulus, MPa."""
    return layer.modulus_MPa / (3.0 * (1.0 - 2.0 * layer.poisson_ratio))


def isochoric(layer: Layer | Glue, f: Floats) -> tuple[Floats, Floats, Floats]:
    """Energy (n,), P (n, 3, 3) and dP/dF (n, 3, 3, 3, 3) of W(I1), I1 = J^(-2/3) F : F."""
    j, inverse = np.linalg.det(f), np.linalg.inv(f).transpose(0, 2, 1)
    scale = j ** (-2.0 / 3.0)
    i1 = scale * np.einsum("nij,nij->n", f, f)
    energy, first, second = _of_invariant(layer, i1)
    slope = 2.0 * (scale[:, None, None] * f - (i1 / 3.0)[:, None, None] * inverse)
    mixed = np.einsum("nij,nkl->nijkl", f, inverse)
    bend = scale[:, None, None, None, None] * (
        np.einsum("ik,jl->ijkl", EYE, EYE) - 2.0 / 3.0 * (mixed + mixed.transpose(0, 3, 4, 1, 2))
    )
    bend += (2.0 / 9.0 * i1)[:, None, None, None, None] * np.einsum("nij,nkl->nijkl", inverse, inverse)
    bend += (i1 / 3.0)[:, None, None, None, None] * np.einsum("nil,nkj->nijkl", inverse, inverse)
    tangent = 2.0 * first[:, None, None, None, None] * bend
    tangent += second[:, None, None, None, None] * np.einsum("nij,nkl->nijkl", slope, slope)
    return energy, first[:, None, None] * slope, tangent


def _of_invariant(layer: Layer | Glue, i1: Floats) -> tuple[Floats, Floats, Floats]:
    """W, W' and W''. FloatingPointError where Gent's chains are stretched out."""
    mu = shear_modulus(layer)
    limit = layer.gent_limit if isinstance(layer, Layer) else None
    if limit is None:
        return mu / 2.0 * (i1 - 3.0), np.full_like(i1, mu / 2.0), np.zeros_like(i1)
    left = 1.0 - (i1 - 3.0) / limit
    if left.min() <= 0.0:
        raise FloatingPointError("the chains of a Gent rubber are stretched out")
    return -mu * limit / 2.0 * np.log(left), mu / (2.0 * left), mu / (2.0 * limit * left**2)


def volumetric(f: Floats) -> tuple[Floats, Floats]:
    """J (n,) and its cofactor dJ/dF (n, 3, 3)."""
    j = np.linalg.det(f)
    return j, j[:, None, None] * np.linalg.inv(f).transpose(0, 2, 1)


def volume_curvature(j: Floats, cofactor: Floats, pressure: Floats) -> Floats:
    """pressure d2J/dF2 (n, 3, 3, 3, 3)."""
    bend = np.einsum("nij,nkl->nijkl", cofactor, cofactor) - np.einsum("nil,nkj->nijkl", cofactor, cofactor)
    return np.asarray((pressure / j)[:, None, None, None, None] * bend)


def film_stress(film: Film, f: Floats, flown: Floats | None = None) -> tuple[Floats, Floats, Floats]:
    """S (n, 3, 3), P and dP/dF of Hooke's law between S and elastic strain; flown : plastic strain (n, 3, 3)."""
    stress = hooke(film, elastic_strain(film, f, flown))
    law = bulk_modulus(film) * VOLUME + 2.0 * shear_modulus(film) * DEVIATOR
    return stress, f @ stress, turned(f, law[None]) + geometric(stress)


def hooke(film: Film, strain: Floats) -> Floats:
    """S (n, 3, 3) of an elastic Green's strain."""
    shear = shear_modulus(film)
    lame = bulk_modulus(film) - 2.0 / 3.0 * shear
    return np.asarray(lame * np.trace(strain, axis1=1, axis2=2)[:, None, None] * EYE + 2.0 * shear * strain)


def elastic_strain(film: Film, f: Floats, flown: Floats | None = None) -> Floats:
    """Green's strain (n, 3, 3) that is under stress: with prestretch, without what has flown (n, 3, 3)."""
    shear = shear_modulus(film)
    strain = 0.5 * (np.einsum("nki,nkj->nij", f, f) - EYE)
    strain = strain + _prestrain(film, bulk_modulus(film) - 2.0 / 3.0 * shear, shear)
    return np.asarray(strain if flown is None else strain - flown)


def turned(f: Floats, law: Floats) -> Floats:
    """dP/dF that comes of dS/dE (n or 1, 3, 3, 3, 3)."""
    laws = np.broadcast_to(law, (len(f), 3, 3, 3, 3))
    return np.asarray(np.einsum("nim,nmjrl,nkr->nijkl", f, laws, f, optimize=True))


def geometric(stress: Floats) -> Floats:
    """dP/dF of P = F S for a fixed S (n, 3, 3)."""
    return np.asarray(np.einsum("ik,njl->nijkl", EYE, stress))


def _prestrain(film: Film, lame: float, shear: float) -> Floats:
    """Green's strain of a film pulled along x, held along y and free to thin."""
    along = film.prestretch + 0.5 * film.prestretch**2
    return np.diag([along, 0.0, -lame / (lame + 2.0 * shear) * along])


PER_DECADE, DECADES = 2, 3
"""Branches of the discrete spectrum, and how far it reaches on both sides of its middle."""


@lru_cache(maxsize=256)
def branches(spectrum: Spectrum) -> tuple[Floats, Floats]:
    """Shares and times of log-spaced branches: H(log tau) of the Mittag-Leffler function (Gross 1947), cut and scaled.

    H(x) = sin(pi a) / (2 pi (cosh(a x) + cos(pi a))), x = log(tau / time).
    """
    count = 2 * DECADES * PER_DECADE + 1
    x = np.linspace(-DECADES, DECADES, count) * np.log(10.0)
    angle = np.pi * spectrum.order
    density = np.sin(angle) / (np.cosh(spectrum.order * x) + np.cos(angle))
    return spectrum.strength * density / density.sum(), spectrum.time_s * np.exp(x)


def relaxation(spectrum: Spectrum, time_s: Floats) -> Floats:
    """G(t) / G(0) of the discrete spectrum, (t,)."""
    share, tau = branches(spectrum)
    return 1.0 - spectrum.strength + np.exp(-time_s[:, None] / tau) @ share


@dataclass(frozen=True)
class Memory:
    """stress : (n, 3, 3) elastic second Piola-Kirchhoff stress of the last step; parts : (b, n, 3, 3) of the branches.

    energy : (n,) largest so far.
    """

    stress: Floats
    parts: Floats
    energy: Floats


def at_rest(layer: Layer, points: int) -> Memory:
    """Nothing has happened."""
    count = len(branches(layer.spectrum)[0]) if layer.spectrum else 0
    return Memory(np.zeros((points, 3, 3)), np.zeros((count, points, 3, 3)), np.zeros(points))


def respond(layer: Layer, f: Floats, old: Memory, step_s: float) -> tuple[Floats, Floats, Memory]:
    """P (n, 3, 3), dP/dF and the memory after a step."""
    energy, p, tangent = isochoric(layer, f)
    new = old
    if layer.damage is not None:
        p, tangent = _softened(layer, energy, p, tangent, old.energy)
        new = replace(new, energy=np.maximum(old.energy, energy))
    if layer.spectrum is None:
        return p, tangent, new
    stress: Floats = np.linalg.solve(f, p).astype(np.float64)
    weight, kept = _branch_step(layer.spectrum, step_s)
    rest = np.einsum("b,bnij->nij", kept, old.parts) - weight.sum() * old.stress
    now = 1.0 - layer.spectrum.strength + float(weight.sum())
    memory = replace(
        new,
        stress=stress,
        parts=kept[:, None, None, None] * old.parts + weight[:, None, None, None] * (stress - old.stress),
    )
    return now * p + f @ rest, now * tangent + geometric(rest), memory


def _branch_step(spectrum: Spectrum, step_s: float) -> tuple[Floats, Floats]:
    """q <- kept q + weight (s - s_old): trapezium for slow branches, backward Euler for those faster than the step."""
    share, tau = branches(spectrum)
    a = step_s / tau
    theta = np.where(a < 1.0, 0.5, 1.0)
    return share / (1.0 + theta * a), (1.0 - (1.0 - theta) * a) / (1.0 + theta * a)


def _softened(layer: Layer, energy: Floats, p: Floats, tangent: Floats, largest: Floats) -> tuple[Floats, Floats]:
    """P times 1 - loss tanh((largest - W) / energy) below the largest energy."""
    assert layer.damage is not None
    behind = np.maximum(largest - energy, 0.0) / layer.damage.energy_MPa
    kept = 1.0 - layer.damage.loss * np.tanh(behind)
    slope = np.where(behind > 0.0, layer.damage.loss / layer.damage.energy_MPa / np.cosh(behind) ** 2, 0.0)
    bend = np.einsum("n,nij,nkl->nijkl", slope, p, p)
    return kept[:, None, None] * p, kept[:, None, None, None, None] * tangent + bend
