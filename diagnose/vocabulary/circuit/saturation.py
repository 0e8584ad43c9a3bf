"""The amplifier's limit: by its overdrive and by how hard it is."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import Vocabulary, register
from diagnose.vocabulary.scales import shrinking
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.saturation import SATURATION

CLIPPED = 20.0  # an amplifier that stops at less than this part of what was recorded gives no signal
SOFTEST = 1.7  # sharpness of its knee: a hyperbolic tangent has 2.5
HARD = 1e-3  # one over the sharpness that is as good as no knee


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any amplifier."""
    yield _saturation(scene)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """A hard limit: a soft knee looks like any sensor that is not quite linear."""
    yield hard_limit(scene)


def hard_limit(scene: Scene) -> Candidate:
    """One over the limit, in terms of the largest voltage recorded: below about 1 nothing is cut."""
    largest = scene.voltage_V or 1.0
    limit = Coordinate("inverse_limit", 0.0, CLIPPED, (1.1, 1.5, 3.0))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"limit_V": shrinking(largest, values[0])}

    return Candidate(SATURATION.name, "readout", (limit,), parameters, units={"limit_V": "V"})


def _saturation(scene: Scene) -> Candidate:
    """A limit with a knee of any sharpness p, from the softest to none.

    The overdrive is (V_largest / V_max)^p of the softest: what that one takes away is linear in it. A hard limit takes
    nothing away before it is reached: a fit that starts there does not see where to go.
    """
    hard = hard_limit(scene)
    starts = tuple(inverse**SOFTEST for inverse in (0.5, 1.1, 3.0))
    overdrive = Coordinate("overdrive", 0.0, CLIPPED**SOFTEST, starts)
    hardness = Coordinate("hardness", 0.0, 1.0, (0.5, 0.9), levels_off=(False, True))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        limit, softness = hard.parameters([values[0] ** (1.0 / SOFTEST)]), (1.0 - values[1]) / SOFTEST
        return limit if softness < HARD else {**limit, "sharpness": 1.0 / softness}

    units = {**hard.units, "sharpness": ""}
    return replace(hard, coordinates=(overdrive, hardness), parameters=parameters, units=units)


register(Vocabulary(SATURATION, "{} saturates", of_segment=of_segment, of_unknown_geometry=of_unknown_geometry))
