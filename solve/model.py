"""A press with its physics: what a configuration asks of the solver, and mechanisms switched on in it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from geometry.parameters import Dot, Segment
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.parameters import Press, Readout
from solve.physics import BondLine, Physics


@dataclass(frozen=True)
class Model:
    """Everything the solver is told. materials : layer -> material."""

    segment: Segment
    materials: Mapping[str, Material]
    dot: Dot
    press: Press = field(default_factory=Press)
    readout: Readout | None = None
    physics: Physics = field(default_factory=Physics)

    @property
    def follows_time(self) -> bool:
        """Whether the press follows its waveform to the end; else only the loads count, not when they come."""
        film = self.materials["film"]
        coupled = self.readout is not None and isinstance(film, PiezoelectricFilm) and film.coupling == "two-way"
        return self.physics.follows_time or self.press.slides_in_hold or coupled


def declared_bonds(segment: Segment) -> dict[str, BondLine]:
    """The compliant bonds of [[segment.bonds]] by name."""
    return {
        bond_name(*bond.between): BondLine(bond.normal_stiffness_N_per_mm3, bond.shear_stiffness_N_per_mm3)
        for bond in segment.bonds
    }


def bond_name(one: str, other: str) -> str:
    """bond-base, or bond-UPPER-LOWER of two neighbouring layers."""
    if "base" in (one, other):
        return "bond-base"
    upper_first = ("effector", "medium1", "film", "medium2")
    return "bond-" + "-".join(sorted((one, other), key=upper_first.index))
