"""Physics beyond the baseline, as the solver needs it. Every default is off and restores the baseline exactly."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from foundation.arrays import Floats
from geometry.parameters import Segment
from solve.added import Added, Motion
from solve.materials.inelastic import StatedLaw
from solve.readout.channel_parts import ChannelPart
from solve.readout.stages import Stage
from solve.terms.definition import TermDefinition


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

    terms : of rig, dot and segment, beside those of every problem. inelastic : layer or bond -> the laws with memory
    around it. bonds : bond -> stiffness. prestretch : nominal strain of the film in x and y.
    stages : of every amplifier, beside those of the read-out; channels : what is of single channels, which need an
    amplifier for each electrode. added : what is added to a trace afterwards.
    """

    terms: tuple[TermDefinition, ...] = ()
    inelastic: Mapping[str, tuple[StatedLaw, ...]] = field(default_factory=dict)
    bonds: Mapping[str, BondLine] = field(default_factory=dict)
    delaminations: tuple[Delamination, ...] = ()
    prestretch: tuple[float, float] = (0.0, 0.0)
    stages: tuple[Stage, ...] = ()
    channels: tuple[ChannelPart, ...] = ()
    added: tuple[Added, ...] = ()

    @property
    def follows_time(self) -> bool:
        """Whether the path, or its speed, matters: the press then follows its waveform to the end."""
        laws = (law.follows_time for laws in self.inelastic.values() for law in laws)
        return any((*laws, *(term.follows_time for term in self.terms), *(one.follows_time for one in self.added)))

    @property
    def structure(self) -> "Physics":
        """The part that acts in an elastic press of the dot alone: neither time and path nor rig and read-out."""
        elastic = tuple(term for term in self.terms if not (term.follows_time or term.of_rig))
        return Physics(bonds=self.bonds, delaminations=self.delaminations, prestretch=self.prestretch, terms=elastic)

    @property
    def rig_terms(self) -> tuple[TermDefinition, ...]:
        """Terms between the rig and the dot."""
        return tuple(term for term in self.terms if term.of_rig)

    def added_force_N(self, motion: Motion, dot_is_free: bool) -> Floats:
        """Force (t,) in N that the sensor carries beside the segment's.

        dot_is_free : the dot's own path is another one than the sensor's, so that what acts on it is in the answer.
        """
        forces = [one.force_N(motion) for one in self.added]
        forces += [] if dot_is_free else [term.force_N(motion) for term in self.terms]
        return np.asarray(sum(forces, np.zeros(len(motion.path_mm))))


Part = TypeVar("Part")


def like(parts: Iterable[object], default: Part) -> Part:
    """The first of the parts that has the type of the default, else the default."""
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
    """Layer or bond -> those of its laws that are linear in the history of the stress, where it has any."""
    found = {place: tuple(law for law in laws if law.linear) for place, laws in inelastic.items()}
    return {place: laws for place, laws in found.items() if laws}


def declared_bonds(segment: Segment) -> dict[str, BondLine]:
    """Bond -> stiffness of the compliant bonds that a segment states in [[segment.bonds]]."""
    return {
        bond_name(*bond.between): BondLine(bond.normal_stiffness_N_per_mm3, bond.shear_stiffness_N_per_mm3)
        for bond in segment.bonds
    }


def bond_name(one: str, other: str) -> str:
    """Name of the bond between two neighbouring layers, bond-UPPER-LOWER; bond-base where one is the base."""
    if "base" in (one, other):
        return "bond-base"
    upper_first = ("effector", "medium1", "film", "medium2")
    return "bond-" + "-".join(sorted((one, other), key=upper_first.index))
