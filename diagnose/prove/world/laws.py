"""Stress P = dW/dF and tangent dP/dF at deformation gradients (n, 3, 3), by derivatives of invariants of F."""

import numpy as np

from diagnose.prove.world.made import Film, Floats, Glue, Layer

EYE = np.eye(3)


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


def volumetric(f: Floats, pressure: Floats) -> tuple[Floats, Floats, Floats]:
    """J (n,), its cofactor dJ/dF (n, 3, 3) and pressure times its derivative."""
    j, inverse = np.linalg.det(f), np.linalg.inv(f).transpose(0, 2, 1)
    cofactor = j[:, None, None] * inverse
    bend = np.einsum("nij,nkl->nijkl", inverse, inverse) - np.einsum("nil,nkj->nijkl", inverse, inverse)
    return j, cofactor, (pressure * j)[:, None, None, None, None] * bend


def film_stress(film: Film, f: Floats) -> tuple[Floats, Floats, Floats]:
    """S (n, 3, 3), P and dP/dF of Hooke's law between S and Green's strain, prestretch added."""
    shear = shear_modulus(film)
    lame = bulk_modulus(film) - 2.0 / 3.0 * shear
    strain = 0.5 * (np.einsum("nki,nkj->nij", f, f) - EYE) + _prestrain(film, lame, shear)
    stress = lame * np.trace(strain, axis1=1, axis2=2)[:, None, None] * EYE + 2.0 * shear * strain
    law = lame * np.einsum("ij,kl->ijkl", EYE, EYE)
    law = law + shear * (np.einsum("ik,jl->ijkl", EYE, EYE) + np.einsum("il,jk->ijkl", EYE, EYE))
    turned = np.einsum("nim,mjrl,nkr->nijkl", f, law, f, optimize=True)
    return stress, f @ stress, turned + geometric(stress)


def geometric(stress: Floats) -> Floats:
    """dP/dF of P = F S for a fixed S (n, 3, 3)."""
    return np.asarray(np.einsum("ik,njl->nijkl", EYE, stress))


def _prestrain(film: Film, lame: float, shear: float) -> Floats:
    """Green's strain of a film pulled along x, held along y and free to thin."""
    along = film.prestretch + 0.5 * film.prestretch**2
    return np.diag([along, 0.0, -lame / (lame + 2.0 * shear) * along])
