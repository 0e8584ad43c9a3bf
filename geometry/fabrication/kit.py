"""All solids of the fabrication kit of one segment."""

from dataclasses import dataclass

from geometry.fabrication.casting import casting_kit
from geometry.fabrication.cavity_check import CavityCheck
from geometry.fabrication.clamp_frame import frame_parts
from geometry.fabrication.jig import jig_parts
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import FabricationPart
from geometry.fabrication.pours import Pour
from geometry.fabrication.routes import sheet_components
from geometry.parameters import Segment


@dataclass(frozen=True)
class SolidKit:
    """parts : all printable parts, labels unique.

    pours : one for each cast component.
    cavity_checks : one for each cast component, in the same order.
    cut_from_sheet : components that are cut instead.
    """

    parts: tuple[FabricationPart, ...]
    pours: tuple[Pour, ...]
    cavity_checks: tuple[CavityCheck, ...]
    cut_from_sheet: tuple[str, ...]


def solid_kit(segment: Segment, fabrication: Fabrication) -> SolidKit:
    """Moulds, clamp frame or base, and jig of a segment that has passed its checks.

    InputError with one sentence for what cannot be made, before any mould is built.
    """
    cut = sheet_components(segment, fabrication)
    held = frame_parts(segment, fabrication)
    cast = casting_kit(segment, fabrication)
    parts = (*cast.parts, *held, *jig_parts(segment, fabrication))
    return SolidKit(parts, cast.pours, cast.checks, cut)
