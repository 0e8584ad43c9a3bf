"""A film that yields: von Mises plasticity with linear hardening between S and Green's strain, by radial return.

The return is that of Simo and Hughes, Computational Inelasticity (1998), box 3.2, at all integration points of the film
at once.
"""

from dataclasses import dataclass

import numpy as np

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.laws import (
    DEVIATOR,
    EYE,
    VOLUME,
    bulk_modulus,
    elastic_strain,
    geometric,
    shear_modulus,
    tangent_of_gradient,
)
from softdot.studies.proof.world.made import Film


@dataclass(frozen=True)
class Flow:
    """Plastic flow so far. strain : (n, 3, 3) plastic Green's strain. total : (n,) equivalent plastic strain so far."""

    strain: Floats
    total: Floats

    @classmethod
    def none(cls, points: int) -> "Flow":
        """Flow of points that have not flown yet."""
        return cls(np.zeros((points, 3, 3)), np.zeros(points))


def flow_step(film: Film, f: Floats, old: Flow) -> tuple[Floats, Floats, Flow]:
    """Stress P (n, 3, 3), dP/dF (n, 3, 3, 3, 3) and the flow after a step to F (n, 3, 3)."""
    assert film.yield_MPa is not None
    shear, bulk = shear_modulus(film), bulk_modulus(film)
    strain = elastic_strain(film, f, old.strain)
    mean = np.trace(strain, axis1=1, axis2=2)
    deviator = 2.0 * shear * (strain - mean[:, None, None] / 3.0 * EYE)
    size = np.maximum(np.sqrt(1.5 * np.einsum("nij,nij->n", deviator, deviator)), 1e-300)
    over = np.maximum(size - film.yield_MPa - film.hardening_MPa * old.total, 0.0)
    step = over / (3.0 * shear + film.hardening_MPa)
    way = 1.5 * deviator / size[:, None, None]
    new = Flow(old.strain + step[:, None, None] * way, old.total + step)
    kept = 1.0 - 3.0 * shear * step / size
    stress = bulk * mean[:, None, None] * EYE + kept[:, None, None] * deviator
    inwards = np.where(over > 0.0, 3.0 * shear / (3.0 * shear + film.hardening_MPa) - (1.0 - kept), 0.0)
    law = bulk * VOLUME + 2.0 * shear * kept[:, None, None, None, None] * DEVIATOR
    law = law - (4.0 / 3.0 * shear * inwards)[:, None, None, None, None] * np.einsum("nij,nkl->nijkl", way, way)
    return f @ stress, tangent_of_gradient(f, law) + geometric(stress), new
