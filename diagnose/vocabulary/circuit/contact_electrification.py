"""Charge that the touch leaves, in terms of the largest that was recorded, by a power of the contact area."""

from collections.abc import Iterator, Sequence
from math import exp, log
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import OTHER_CHARGE, Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.contact_electrification import CONTACT_ELECTRIFICATION
from solve.physics import like
from solve.readout.heat_and_touch import ContactCharge

TOUCH_CHARGE = 10.0  # of the largest charge that was recorded
LARGEST_EXPONENT = log(3.0)  # of the area: charge that grows with the pressure too


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any film."""
    yield _touch(scene)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Yield the candidates of a segment."""
    yield _touch(scene)


def _touch(scene: Scene) -> Candidate:
    """The candidate, in terms of the charge that makes the largest voltage recorded."""
    scale = scene.capacitance_pF * (scene.voltage_V or 1.0)
    declared = like(scene.model.physics.added, ContactCharge()).charge_pC
    coordinates = (
        Coordinate("charge", -TOUCH_CHARGE, TOUCH_CHARGE, (0.1, -0.1)),
        Coordinate("log_exponent", -LARGEST_EXPONENT, LARGEST_EXPONENT, (0.4, -0.4)),
    )

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"charge_pC": declared + scale * values[0], "area_exponent": exp(values[1])}

    units = {"charge_pC": "pC", "area_exponent": ""}
    return Candidate(CONTACT_ELECTRIFICATION.name, "film", coordinates, parameters, units=units)


register(
    Vocabulary(
        CONTACT_ELECTRIFICATION,
        "contact leaves charge on {}",
        of_segment=of_segment,
        of_unknown_geometry=of_unknown_geometry,
        kind=OTHER_CHARGE,
    )
)
