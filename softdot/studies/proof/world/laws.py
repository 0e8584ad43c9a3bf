"""Stress P = dW/dF and tangent dP/dF at deformation gradients (n, 3, 3), by derivatives of invariants of F."""

import numpy as np

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.made import Film, Glue, Layer

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
    """Second derivative pressure d2J/dF2 (n, 3, 3, 3, 3)."""
    bend = np.einsum("nij,nkl->nijkl", cofactor, cofactor) - np.einsum("nil,nkj->nijkl", cofactor, cofactor)
    return np.asarray((pressure / j)[:, None, None, None, None] * bend)


def film_stress(film: Film, f: Floats, flown: Floats | None = None) -> tuple[Floats, Floats, Floats]:
    """S (n, 3, 3), P and dP/dF of Hooke's law between S and elastic strain; flown : plastic strain (n, 3, 3)."""
    stress = hooke(film, elastic_strain(film, f, flown))
    law = bulk_modulus(film) * VOLUME + 2.0 * shear_modulus(film) * DEVIATOR
    return stress, f @ stress, tangent_of_gradient(f, law[None]) + geometric(stress)


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


def tangent_of_gradient(f: Floats, law: Floats) -> Floats:
    """Part of dP/dF (n, 3, 3, 3, 3) that comes of dS/dE (n or 1, 3, 3, 3, 3)."""
    laws = np.broadcast_to(law, (len(f), 3, 3, 3, 3))
    return np.asarray(np.einsum("nim,nmjrl,nkr->nijkl", f, laws, f, optimize=True))


def geometric(stress: Floats) -> Floats:
    """Derivative dP/dF of P = F S for a fixed S (n, 3, 3)."""
    return np.asarray(np.einsum("ik,njl->nijkl", EYE, stress))


def _prestrain(film: Film, lame: float, shear: float) -> Floats:
    """Green's strain of a film pulled along x, held along y and free to thin."""
    along = film.prestretch + 0.5 * film.prestretch**2
    return np.diag([along, 0.0, -lame / (lame + 2.0 * shear) * along])
