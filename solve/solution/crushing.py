"""How far elements are squeezed, and whether a step crushes one that can hardly be compressed."""

from foundation.arrays import Floats
from solve.fem.kinematics import deformation_gradient, smallest_jacobian
from solve.system import System
from solve.terms.film import FilmRegion
from solve.terms.solid import SolidRegion

CRUSHED_VOLUME_RATIO = 0.3  # det F: below it the element is to blame, whatever ended the iteration


def smallest_volumes(region: SolidRegion | FilmRegion, displacement: Floats) -> Floats:
    """Smallest det F of each element (m,) of a region at displacements (n, 3)."""
    return smallest_jacobian(deformation_gradient(region.gradient, displacement[region.tets]))


INCOMPRESSIBLE_MODULI_RATIO = 10.0  # of the bulk modulus over the shear modulus; 9.7 at a Poisson's ratio of 0.45


def crushes(system: System, before: Floats, after: Floats) -> bool:
    """Whether a step, from unknowns (count,) to others, takes most of the volume of an element that can hardly be
    compressed.

    Then Newton's method has gone too far, to an equilibrium in which a fold of the mesh holds itself.
    """
    return _least_volume(system, after) < CRUSHED_VOLUME_RATIO <= _least_volume(system, before)


def _least_volume(system: System, x: Floats) -> float:
    """The smallest det F of media that can hardly be compressed."""
    displacement = system.displacement(x)
    rubbers = [s for s in system.solids if s.law.bulk_modulus > INCOMPRESSIBLE_MODULI_RATIO * s.law.shear_modulus]
    return float(min((smallest_volumes(one, displacement).min() for one in rubbers), default=1.0))
