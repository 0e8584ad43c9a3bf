"""A press with its physics: what a configuration asks of the solver, and mechanisms switched on in it.

Physics beyond the baseline, as the solver needs it. Every default is off and restores the baseline exactly.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from geometry.parameters import Dot, Segment
from solve.materials.inelastic import Prony, Softening
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.parameters import Press, Readout
from solve.readout.stages import Stage

if TYPE_CHECKING:
    from solve.mechanisms import Mechanism


@dataclass(frozen=True)
class BondLine:
    """Stiffness of an adhesive, traction per jump of displacement."""

    normal_stiffness_N_per_mm3: float
    shear_stiffness_N_per_mm3: float


@dataclass(frozen=True)
class Delamination:
    """A disc (in plane strain a strip of that width) without bond."""

    bond: str
    center_mm: tuple[float, float]
    diameter_mm: float


@dataclass(frozen=True)
class Yield:
    """Yield stress of the film and its linear isotropic hardening modulus."""

    stress_MPa: float
    hardening_MPa: float = 0.0


@dataclass(frozen=True)
class Pyroelectric:
    """A temperature of the film that approaches temperature_step_K with time_constant_s."""

    temperature_step_K: float = 0.0
    time_constant_s: float = 1.0


@dataclass(frozen=True)
class Physics:
    """What acts on the segment besides the baseline.

    viscosity : layer or bond -> Prony series; softening : medium -> law (stress scale in MPa).
    bonds : bond -> stiffness. friction : Coulomb coefficient between dot and surface.
    rig_compliance_mm_per_N lies between the displacement sensor and the dot, moving_mass_g between the force sensor
    and the dot. prestretch : nominal strain of the film in x and y. contact_charge_pC : charge that the dot leaves on
    the electrodes, in proportion to the contact area, all of it at the largest area. electronics : stages of the
    amplifier beside those of the read-out. crosstalk : channel (from 1) -> share of the other channels' voltage.
    """

    viscosity: Mapping[str, Prony] = field(default_factory=dict)
    softening: Mapping[str, Softening] = field(default_factory=dict)
    film_yield: Yield | None = None
    bonds: Mapping[str, BondLine] = field(default_factory=dict)
    delaminations: tuple[Delamination, ...] = ()
    friction: float = 0.0
    rig_compliance_mm_per_N: float = 0.0
    moving_mass_g: float = 0.0
    prestretch: tuple[float, float] = (0.0, 0.0)
    pyroelectric: Pyroelectric = Pyroelectric()
    contact_charge_pC: float = 0.0
    electronics: tuple[Stage, ...] = ()
    crosstalk: Mapping[int, float] = field(default_factory=dict)

    @property
    def follows_time(self) -> bool:
        """Whether the path, or its speed, matters: the press then follows its waveform to the end."""
        return bool(
            self.viscosity
            or self.softening
            or self.film_yield
            or self.friction > 0.0
            or self.moving_mass_g > 0.0
            or self.pyroelectric.temperature_step_K != 0.0
        )


@dataclass(frozen=True)
class Model:
    """Everything the solver is told. materials : layer -> material. mechanisms : those that were switched on."""

    segment: Segment
    materials: Mapping[str, Material]
    dot: Dot
    press: Press = field(default_factory=Press)
    readout: Readout | None = None
    physics: Physics = field(default_factory=Physics)
    mechanisms: tuple["Mechanism", ...] = ()

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
