"""A leak beside the read-out's resistance, at the amplifier or within the film: by its conductance."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import sinh, sqrt
from typing import Any

from diagnose.forward import Candidate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import LOSES_CHARGE, Vocabulary, register
from diagnose.vocabulary.scales import growing, shrinking
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.circuit.charge_leakage import CHARGE_LEAKAGE


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates where the input's impedance counts: of all channels together, or of one."""
    if scene.voltage_mode:
        yield from (_leakage(scene, component) for component in ("readout", "film"))
        yield from (_leakage(scene.of_each_channel, channel) for channel in scene.numbered)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Yield candidates for all channels together; what shows is the time constant."""
    if scene.voltage_mode:
        yield from (_with_time_constant(scene, _leakage(scene, component)) for component in ("readout", "film"))


def _leakage(scene: Scene, component: str) -> Candidate:
    """Conductance. At most, the charge is gone within one sample."""
    scale, most = scene.conductance_uS, 1e-6 * scene.capacitance_pF / scene.scales.step_s
    top = max(most, 100.0 * scale)
    coordinate = growing("conductance", scale, top, (0.3 * scale, 3.0 * scale, sqrt(scale * top)))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"resistance_MOhm": shrinking(1.0 / scale, sinh(values[0]))}

    return Candidate(CHARGE_LEAKAGE.name, component, (coordinate,), parameters, units={"resistance_MOhm": "MOhm"})


def _with_time_constant(scene: Scene, one: Candidate) -> Candidate:
    """A leak with its time constant, which is what shows; its resistance is that for the assumed capacitance.

    A charge that is gone within a sample leaves the derivative of the force, whose size the free sensitivity takes.
    """

    def derived(values: Sequence[float]) -> dict[str, float]:
        resistance_MOhm = float(one.parameters(values)["resistance_MOhm"])
        return {"time_constant_s": 1e-6 * scene.capacitance_pF * resistance_MOhm}

    coordinates = tuple(replace(coordinate, levels_off=(True, True)) for coordinate in one.coordinates)
    return replace(one, coordinates=coordinates, derived=derived, units={**one.units, "time_constant_s": "s"})


register(
    Vocabulary(
        CHARGE_LEAKAGE,
        "charge leaks through {}",
        of_segment=of_segment,
        of_unknown_geometry=of_unknown_geometry,
        kind=LOSES_CHARGE,
    )
)
