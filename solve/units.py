"""The solver's units: one of length, one of stress and one of voltage, and what follows from them."""

from collections.abc import Mapping
from dataclasses import dataclass

from geometry.parameters import Segment
from solve.materials.laws import MediumLaw
from solve.materials.parameters import Material, PiezoelectricFilm


@dataclass(frozen=True)
class Units:
    """One solver unit of length in m, of stress in Pa and of voltage in V."""

    length: float
    stress: float
    voltage: float

    @property
    def force(self) -> float:
        """One unit of force in N."""
        return self.stress * self.length**2

    @property
    def charge(self) -> float:
        """One unit of charge in C."""
        return self.force * self.length / self.voltage

    @property
    def mass(self) -> float:
        """One unit of mass in kg, so that force = mass x length / s^2."""
        return self.force / self.length


def solver_units(segment: Segment, laws: Mapping[str, MediumLaw], materials: Mapping[str, Material]) -> Units:
    """Units of a problem: the segment's length, its stiffest medium's shear modulus, a voltage that strains its
    film.
    """
    length, film = 1e-3 * segment.length_mm, materials["film"]
    constants = (film.d31_pC_per_N, film.d33_pC_per_N) if isinstance(film, PiezoelectricFilm) else (0.0, 0.0)
    coupling = 1e-12 * max(abs(constants[0]), abs(constants[1]), 1e-3)
    return Units(length, max(law.shear_modulus for law in laws.values()), length / coupling)
