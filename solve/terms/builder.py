"""What the terms of a problem are built from: the meshed segment in solver units, and its unknowns."""

from collections.abc import Mapping
from dataclasses import dataclass

from foundation.arrays import Floats
from geometry.parameters import Segment
from mesh.types import TetMesh
from solve.fem.numbering import Numbers, Unknowns
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.terms.contact import ContactFacets
from solve.units import Units


@dataclass(frozen=True)
class Builder:
    """Parts from which terms are built. points : (n, 3) nodes in solver units. numbers : hands out more unknowns.

    contact : geometry of the contact with the dot. share : what is meshed of the whole segment, and so of all that
    acts on the dot. force_driven : a force drives the dot, else a displacement.
    """

    segment: Segment
    materials: Mapping[str, Material]
    tet_mesh: TetMesh
    points: Floats
    unknowns: Unknowns
    numbers: Numbers
    units: Units
    contact: ContactFacets
    share: float
    force_driven: bool

    @property
    def film_material(self) -> PiezoelectricFilm:
        """Material of the film. TypeError when it is none of a film."""
        film = self.materials["film"]
        if not isinstance(film, PiezoelectricFilm):
            raise TypeError(f"the film needs a piezoelectric-film material, not {film.model}")
        return film

    @property
    def MPa(self) -> float:
        """One MPa in solver units."""
        return 1e6 / self.units.stress

    def per_area(self, stiffness_N_per_mm3: float) -> float:
        """A traction per displacement in solver units."""
        return 1e9 * stiffness_N_per_mm3 * self.units.length / self.units.stress
