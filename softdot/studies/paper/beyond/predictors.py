"""Design parameters, the paper's own and corrected ones: what each says a segment's output goes with. All work on many
designs at once; lengths in mm, moduli in MPa, forces in N per mm of width.
"""

from collections.abc import Sequence
from dataclasses import astuple, dataclass, replace
from typing import cast

import numpy as np

from foundation.arrays import Floats
from softdot.studies.paper.analytical.beam import bending_softness
from softdot.studies.paper.analytical.composite import plane_strain_modulus_Pa
from softdot.studies.paper.analytical.softness import index_of_modulus, index_of_thickness, softness
from softdot.studies.paper.beyond.designs import Design
from softdot.studies.paper.segment import INDENTATION_MM, LENGTH_MM, POISSON_RATIO, RIDGE_RADIUS_MM
from solve.materials.parameters import VACUUM_PERMITTIVITY, PiezoelectricFilm, find_material

CONTACT_MM = 2.0 * np.sqrt(RIDGE_RADIUS_MM * INDENTATION_MM)
"""Width of the contact, 2 sqrt(R u): the scale of Hertz."""
BISECTIONS = 60


@dataclass(frozen=True)
class Columns:
    """The variables of n designs, each (n,)."""

    h1: Floats
    e1: Floats
    h2: Floats
    e2: Floats
    effector: Floats
    e_effector: Floats
    film: Floats
    """Thickness in mm."""


def columns(designs: Sequence[Design]) -> Columns:
    """The variables of the designs, the film's thickness in mm."""
    table = Columns(*np.array([astuple(design) for design in designs]).T)
    return replace(table, film=1e-3 * table.film)


def papers_parameters(designs: Sequence[Design]) -> dict[str, Floats]:
    """The paper's parameters (n,). S_A and S_B put designs in the order of S_2/S_1, or its reverse.

    S_1 + S_2 is no parameter of the paper but stands in the denominator of its Eq. (7).
    """
    c = columns(designs)
    s1 = np.array([softness(h, LENGTH_MM, e) for h, e in zip(c.h1, c.e1, strict=True)])
    s2 = np.array([softness(h, LENGTH_MM, e) for h, e in zip(c.h2, c.e2, strict=True)])
    return {
        "f": np.vectorize(index_of_thickness)(c.h1, c.h2),
        "e": np.vectorize(index_of_modulus)(c.e1, c.e2),
        "S₁": s1,
        "S₂": s2,
        "S₂/S₁": s2 / s1,
        "S₁b": np.vectorize(bending_softness)(LENGTH_MM, c.e1, c.h1),
        "S₁ + S₂": s1 + s2,
    }


def free_force_N_per_mm(c: Columns) -> Floats:
    """Depth over the softness of the stack, corrected twice (Eq. 7 has neither).

    Above the film the load spreads from the width of the contact by 45 degrees on either side. Below it medium 2
    is held by base and film, which do not stretch: its modulus grows by the shape factor of Gent and Lindley.
    """
    above = spread_softness([(c.effector, _wide(c.e_effector)), (c.h1, _wide(c.e1))], 1.0)
    below = c.h2 / (LENGTH_MM * _wide(c.e2) * shape_factor(c.h2))
    return INDENTATION_MM / (above + below)


def free_voltage_V(c: Columns, tension_share: float) -> Floats:
    """Media that are squeezed want to widen; the film holds them and is pulled by a share of the force.

    The film is so stiff in its plane that its tension, and so the voltage g31 N, does not depend on its thickness.
    tension_share : tension of the film over the pressing force; fitted.
    """
    force = free_force_N_per_mm(c)
    tension = 1e3 * tension_share * force  # N/m
    return (_stretch_coefficient() * tension + _thickness_voltage(c, force)) / _permittivity()


def clamped_voltage_V(c: Columns, give: float, rest: float, film_stiffness: float = 1.0) -> Floats:
    """The held film is stretched by its deflection w: mean strain (8/3) (w/l)² of a parabola.

    give, rest : see local_softness; fitted. film_stiffness : 0 leaves out the membrane stiffness of the film.
    """
    deflection, force = clamped_deflection(c, give, rest, film_stiffness)
    strain = 8.0 / 3.0 * (deflection / LENGTH_MM) ** 2
    stretched = _stretch_coefficient() * _film_modulus_Pa() * strain * 1e-3 * c.film
    return (stretched + _thickness_voltage(c, force)) / _permittivity()


def clamped_deflection(c: Columns, give: float, rest: float, film_stiffness: float = 1.0) -> tuple[Floats, Floats]:
    """Deflection w of the film in mm and force in N/mm.

    Equilibrium of the local softness above with what carries the film, for a parabola of sagitta w by energies:
    (u - w) / S = (16/3) sum(G h) w / l + (8/15) E2' l w / h2 + (128/9) sum(E' h) (w/l)³
    shear of the held media, medium 2 as a foundation, stretch of the held layers, of which the film is stiffest.
    The left side falls with w and the right side rises: bisection finds the only root.
    """
    local = give * spread_softness([(c.effector, _wide(c.e_effector)), (c.h1, _wide(c.e1))], rest)
    shear = 16.0 / 3.0 * (_shear(c.e_effector) * c.effector + _shear(c.e1) * c.h1) / LENGTH_MM
    foundation = 8.0 / 15.0 * _wide(c.e2) * shape_factor(c.h2) * LENGTH_MM / c.h2
    membrane = film_stiffness * 1e-6 * _film_modulus_Pa() * c.film + _wide(c.e1) * c.h1
    membrane = membrane + _wide(c.e_effector) * c.effector
    low, high = np.zeros_like(c.h1), np.full_like(c.h1, INDENTATION_MM)
    for _ in range(BISECTIONS):
        middle = (low + high) / 2.0
        carried = (shear + foundation) * middle + 128.0 / 9.0 * membrane * (middle / LENGTH_MM) ** 3
        deeper = (INDENTATION_MM - middle) / local > carried
        low, high = np.where(deeper, middle, low), np.where(deeper, high, middle)
    return low, (INDENTATION_MM - low) / local


def spread_softness(layers: Sequence[tuple[Floats, Floats]], rest: float) -> Floats:
    """Depth over force of layers (thickness, modulus) from the top, the load spreading by 45 degrees: 1/(N/mm) mm.

    Integral of dz / (E w) with the loaded width w = CONTACT_MM + 2 z up to the whole length. rest : share that counts
    where the whole length is loaded; below 1 for held sides, between which rubber can only shear.
    """
    full = (LENGTH_MM - CONTACT_MM) / 2.0
    top: Floats = np.zeros_like(layers[0][0])
    total = top
    for thickness, modulus in layers:
        bottom = top + thickness
        upper, lower = np.minimum(top, full), np.minimum(bottom, full)
        spreading = np.log((CONTACT_MM + 2.0 * lower) / (CONTACT_MM + 2.0 * upper)) / 2.0
        total = total + (spreading + rest * (thickness - (lower - upper)) / LENGTH_MM) / modulus
        top = bottom
    return total


def shape_factor(thickness_mm: Floats) -> Floats:
    """1 + S² with S = l / (2 h): a strip between two rigid faces (Gent and Lindley 1959)."""
    return 1.0 + (LENGTH_MM / (2.0 * thickness_mm)) ** 2


def _wide(modulus: Floats) -> Floats:
    return modulus / (1.0 - POISSON_RATIO**2)


def _shear(modulus: Floats) -> Floats:
    return modulus / (2.0 * (1.0 + POISSON_RATIO))


def film() -> PiezoelectricFilm:
    """The film of every design."""
    return cast(PiezoelectricFilm, find_material("pvdf", {}, "material"))


def _film_modulus_Pa() -> float:
    return plane_strain_modulus_Pa(1e6 * film().youngs_modulus_MPa, film().poisson_ratio)


def _stretch_coefficient() -> float:
    """Charge density over stress along the film in C/N: d31 + nu d32, as nothing strains across it."""
    pvdf = film()
    return 1e-12 * (pvdf.d31_pC_per_N + pvdf.poisson_ratio * pvdf.d32_pC_per_N)


def _permittivity() -> float:
    return VACUUM_PERMITTIVITY * film().relative_permittivity


def _thickness_voltage(c: Columns, force: Floats) -> Floats:
    """Charge density times thickness that the pressure gives through d33, C/m."""
    pressure = 1e6 * force / LENGTH_MM
    return -1e-12 * film().d33_pC_per_N * pressure * 1e-3 * c.film
