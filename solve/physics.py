"""Physics beyond the baseline, as the solver needs it. Every default is off and restores the baseline exactly."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

from geometry.parameters import Segment
from solve.added import Added
from solve.materials.inelastic import StatedLaw
from solve.readout.channel_parts import ChannelPart
from solve.readout.stages import Stage


@dataclass(frozen=True)
class BondLine:
    """Stiffness of an adhesive, traction per jump of displacement."""

    normal_stiffness_N_per_mm3: float
    shear_stiffness_N_per_mm3: float


@dataclass(frozen=True)
class Delamination:
    """A disc (in plane strain a strip of that width) without bond; outside : all but that disc without bond."""

    bond: str
    center_mm: tuple[float, float]
    diameter_mm: float
    outside: bool = False


@dataclass(frozen=True)
class Physics:
    """What acts on the segment besides the baseline.

    inelastic : layer or bond -> the laws with memory around it. bonds : bond -> stiffness.
    friction : Coulomb coefficient between dot and surface. rig_compliance_mm_per_N lies between the displacement sensor
    and the dot, moving_mass_g between the force sensor and the dot. prestretch : nominal strain of the film in x and y.
    added : what is added to a trace afterwards. stages : of every amplifier, beside those of the read-out.
    channels : what is of single channels, which need an amplifier for each electrode.
    """

    inelastic: Mapping[str, tuple[StatedLaw, ...]] = field(default_factory=dict)
    bonds: Mapping[str, BondLine] = field(default_factory=dict)
    delaminations: tuple[Delamination, ...] = ()
    friction: float = 0.0
    rig_compliance_mm_per_N: float = 0.0
    moving_mass_g: float = 0.0
    prestretch: tuple[float, float] = (0.0, 0.0)
    added: tuple[Added, ...] = ()
    stages: tuple[Stage, ...] = ()
    channels: tuple[ChannelPart, ...] = ()

    @property
    def follows_time(self) -> bool:
        """Whether the path, or its speed, matters: the press then follows its waveform to the end."""
        return bool(
            any(law.follows_time for laws in self.inelastic.values() for law in laws)
            or self.friction > 0.0
            or self.moving_mass_g > 0.0
            or any(one.follows_time for one in self.added)
        )


Part = TypeVar("Part")


def like(parts: Iterable[object], default: Part) -> Part:
    """The first of the parts that is of the same kind as the default, which it is where there is none."""
    return next((one for one in parts if type(one) is type(default)), default)


Law = TypeVar("Law")
LawsAround = Mapping[str, tuple[StatedLaw, ...]]


def laws_of(inelastic: LawsAround, kind: type[Law]) -> dict[str, Law]:
    """Layer or bond -> its law of a kind, where it has one."""
    each = ((place, law) for place, laws in inelastic.items() for law in laws)
    return {place: law for place, law in each if isinstance(law, kind)}


def nonlinear_laws(inelastic: LawsAround) -> dict[str, tuple[StatedLaw, ...]]:
    """Layer or bond -> those of its laws that are not linear in the history of the stress, where it has any."""
    found = {place: tuple(law for law in laws if not law.linear) for place, laws in inelastic.items()}
    return {place: laws for place, laws in found.items() if laws}


def linear_laws(inelastic: LawsAround) -> dict[str, tuple[StatedLaw, ...]]:
    """The others."""
    found = {place: tuple(law for law in laws if law.linear) for place, laws in inelastic.items()}
    return {place: laws for place, laws in found.items() if laws}


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
