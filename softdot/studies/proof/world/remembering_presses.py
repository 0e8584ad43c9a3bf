"""Presses with memory at any strength, from three that are solved through time and kept.

The difference to the elastic press is interpolated over the strength by the parabola through none, half and full
(NODES). It is solved along the path that the stage was asked for, on larger elements (MESH_SIZE_SHARE), by which it
changes by 1 %, and scaled by the elastic answer of the specimen along its own path over that of the nominal stack.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.made import Film, Glue, Layer, Made
from softdot.studies.proof.world.march import Course, table, through_time

NODES = 0.25, 0.5
MESH_SIZE_SHARE = 0.7
FAINT_SIGNAL_SHARE = 0.02


def strength(made: Made) -> float:
    """Strength of the one layer that relaxes or softens; 0 without."""
    of = [
        layer.spectrum.strength if layer.spectrum else layer.damage.loss if layer.damage else 0.0
        for layer in made.layers
        if isinstance(layer, Layer)
    ]
    if sum(value > 0.0 for value in of) > 1:
        raise ValueError("at most one layer of a stack remembers in the proof")
    return max(of)


def with_strength(made: Made, value: float) -> Made:
    """The segment with its memory at another strength; 0 forgets."""
    layers: list[Layer | Film | Glue] = []
    for layer in made.layers:
        if isinstance(layer, Layer) and layer.spectrum:
            layer = replace(layer, spectrum=replace(layer.spectrum, strength=value) if value else None)
        if isinstance(layer, Layer) and layer.damage:
            layer = replace(layer, damage=replace(layer.damage, loss=value) if value else None)
        layers.append(layer)
    return replace(made, layers=tuple(layers))


def forgetful(made: Made) -> Made:
    """The stack without memory."""
    still = with_strength(made, 0.0)
    layers = tuple(replace(one, yield_MPa=None) if isinstance(one, Film) else one for one in still.layers)
    return replace(still, layers=layers)


def scaled_memory(made: Made, asked: "AskedPath", elastic: Course, nominal: Course, deepest_mm: float) -> Course:
    """Answers (t,) of a specimen whose elastic answers are known; nominal : those of the stack made, as was asked for.

    deepest_mm : to which tables go. ValueError beyond the largest strength that is solved. A film that yields is solved
    as it is, since below some stress nothing yields.
    """
    value, time = strength(made), asked.time_s
    if value > NODES[-1]:
        raise ValueError(f"a strength of {value:g} is beyond {NODES[-1]:g}")
    larger = replace(made, fine=MESH_SIZE_SHARE * made.fine)
    yields = made.film.yield_MPa is not None
    solved = [larger] if yields else [with_strength(larger, node) for node in NODES]
    courses = [through_time(one, time, asked.path_mm, asked.before_mm) for one in solved]
    marks = courses[0][0]
    base = table(forgetful(larger), deepest_mm).at(asked.path_mm[marks])

    def signal(name: str) -> Floats:
        changes = [getattr(course, name) - getattr(base, name) for _, course in courses]
        change = changes[0] if yields else _parabola(value, *changes)
        difference = PchipInterpolator(time[marks], change, axis=0)(time)
        return _add_difference(getattr(elastic, name), getattr(nominal, name), difference)

    force = np.where(elastic.force_N > 0.0, signal("force_N"), 0.0)
    return Course(force, signal("charge_pC"), elastic.area_mm2)


@dataclass(frozen=True)
class AskedPath:
    """Times (t,) and the path (t,) of the dot without flaws of the rig; before_mm : its deepest in earlier runs."""

    time_s: Floats
    path_mm: Floats
    before_mm: float = 0.0


def _parabola(value: float, near: Floats, far: Floats) -> Floats:
    """Difference to the elastic press at a strength: a s + b s^2, which has the solved differences at both nodes."""
    first, second = near / NODES[0], far / NODES[1]
    bend = (second - first) / (NODES[1] - NODES[0])
    return np.asarray(value * (first + bend * (value - NODES[0])))


def _add_difference(elastic: Floats, nominal: Floats, difference: Floats) -> Floats:
    """Elastic signal plus ratio times the difference: only that is interpolated in time, for the path itself is
    known.
    """
    faint = FAINT_SIGNAL_SHARE * float(np.abs(nominal).max())
    ratio = np.where(np.abs(nominal) > faint, elastic / np.where(np.abs(nominal) > faint, nominal, 1.0), 1.0)
    return np.asarray(elastic + ratio * difference)
