"""A mass that moves with the dot, or between load cell and specimen."""

from collections.abc import Iterator, Sequence
from math import sinh
from typing import Any

from diagnose.forward import Candidate
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scales import growing
from diagnose.vocabulary.scene import FORCE, CouponScene, Scene
from solve.mechanisms.boundaries.inertia import INERTIA
from solve.physics import like
from solve.terms.inertia import MovingMass

MASS_G, GRIP_G = 5.0, 50.0  # of a small dot, and of a clip
HEAVIEST_G = 200_000.0  # the crosshead, or the carriage of a linear motor, which may press a segment too


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates where a force answers, or drives what moves."""
    if scene.shows(FORCE) or any(drive == FORCE for drive, _ in scene.shown):
        yield _mass(scene)


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """Yield candidates where the load cell moves."""
    if any(run.drive != "displacement_mm" for run in scene.recording.runs):
        return
    coordinate = growing("mass", GRIP_G, HEAVIEST_G, (GRIP_G, 10.0 * GRIP_G))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"moving_mass_g": GRIP_G * sinh(values[0])}

    yield Candidate(INERTIA.name, "rig", (coordinate,), parameters, units={"moving_mass_g": "g"})


def _mass(scene: Scene) -> Candidate:
    """The dot, its holder and half of the beam: grams."""
    have = like(scene.model.physics.terms, MovingMass()).mass_g
    coordinate = growing("mass", MASS_G, HEAVIEST_G, (MASS_G, 10.0 * MASS_G))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"moving_mass_g": have + MASS_G * sinh(values[0])}

    return Candidate(INERTIA.name, "rig", (coordinate,), parameters, units={"moving_mass_g": "g"})


register(
    Vocabulary(
        INERTIA, "the inertia of a moving mass in {} adds to the force", of_segment=of_segment, of_coupon=of_coupon
    )
)
