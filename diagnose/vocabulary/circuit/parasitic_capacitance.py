"""A capacitance beside the input: up to a hundred times what is there, for then no signal is left."""

from collections.abc import Iterator, Sequence
from math import sinh
from typing import Any

from diagnose.forward import Candidate
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scales import growing
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.parasitic_capacitance import PARASITIC_CAPACITANCE


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates where the input's impedance counts."""
    if scene.voltage_mode:
        yield _parasitic(scene)


def _parasitic(scene: Scene) -> Candidate:
    """Up to a hundred times what is there: then no signal is left."""
    scale = scene.capacitance_pF
    coordinate = growing("capacitance", scale, 100.0 * scale, (0.2 * scale, 2.0 * scale))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"capacitance_pF": scale * sinh(values[0])}

    return Candidate(PARASITIC_CAPACITANCE.name, "readout", (coordinate,), parameters, units={"capacitance_pF": "pF"})


register(
    Vocabulary(PARASITIC_CAPACITANCE, "a capacitance across {} takes its share of the charge", of_segment=of_segment)
)
