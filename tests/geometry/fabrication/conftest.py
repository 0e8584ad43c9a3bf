"""Three designs with their kits: an effector layer, a dome and a cylinder."""

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from geometry.fabrication.device import lone_device
from geometry.fabrication.kit import SolidKit, solid_kit
from geometry.fabrication.parameters import CastingNumbers, Fabrication
from geometry.parameters import Effector, Film, Medium, Segment

SHRINKING = CastingNumbers(shrinkage_percent=4.0, density_g_cm3=1.2, parts_A=3.0, parts_B=1.0)
"""A made-up material that shrinks far more than silicone, so that a forgotten compensation shows."""


@dataclass(frozen=True)
class Design:
    segment: Segment
    fabrication: Fabrication
    kit: SolidKit


def a_segment(**changes) -> Segment:
    layers = {"medium1": Medium(thickness_mm=0.5), "medium2": Medium(thickness_mm=2.0)}
    return Segment(**{"film": Film(thickness_um=28.0), "effector": Effector(), **layers, **changes})


DESIGNS: dict[str, tuple[Segment, Fabrication]] = {
    "layer, open moulds, clamped": (
        a_segment(effector=Effector(material="own")),
        Fabrication(casting={"own": SHRINKING}, cavities=(1, 2), cable_exit="-x"),
    ),
    "dome, clamped": (
        a_segment(
            effector=Effector(shape="dome", diameter_mm=2.0, height_mm=0.8, material="own"),
            medium2=Medium(thickness_mm=2.0, material="sponge"),
        ),
        Fabrication(casting={"own": SHRINKING}, cavities=(2, 1), cable_exit="+y", routes={"medium1": "sheet"}),
    ),
    "cylinder, split moulds, free": (
        a_segment(effector=Effector(shape="cylinder", diameter_mm=1.6, height_mm=0.7, material="own"), boundary="free"),
        Fabrication(casting={"own": SHRINKING}, mould_style="split", cavities=(1, 1), routes={"medium1": "sheet"}),
    ),
}


@pytest.fixture(scope="session", params=DESIGNS)
def design(request: pytest.FixtureRequest) -> Design:
    segment, fabrication = DESIGNS[request.param]
    return Design(segment, fabrication, solid_kit(lone_device(segment), fabrication))


@pytest.fixture(scope="session")
def make_kit_segment() -> Callable[..., Segment]:
    return a_segment
