"""Presses with memory at any strength, from three that are solved through time and kept.

The difference to the elastic press is interpolated over the strength by the parabola through none, half and full
(NODES), and scaled by the elastic answers of the specimen over those of the nominal stack.
"""

from dataclasses import replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from diagnose.prove.world.made import Floats, Layer, Made
from diagnose.prove.world.march import Course, through_time

NODES = 0.25, 0.5
FAINT = 0.02


def strength(made: Made) -> float:
    """Of the one layer that remembers; 0 without."""
    of = [
        layer.spectrum.strength if layer.spectrum else layer.damage.loss if layer.damage else 0.0
        for layer in made.layers
        if isinstance(layer, Layer)
    ]
    if sum(value > 0.0 for value in of) > 1:
        raise ValueError("at most one layer of a stack remembers in the proof")
    return max(of)


def with_strength(made: Made, value: float) -> Made:
    """The same with the memory at another strength; 0 forgets."""
    layers = []
    for layer in made.layers:
        if isinstance(layer, Layer) and layer.spectrum:
            layer = replace(layer, spectrum=replace(layer.spectrum, strength=value) if value else None)
        if isinstance(layer, Layer) and layer.damage:
            layer = replace(layer, damage=replace(layer.damage, loss=value) if value else None)
        layers.append(layer)
    return replace(made, layers=tuple(layers))


def forgetful(made: Made) -> Made:
    """Without memory."""
    return with_strength(made, 0.0)


def scaled_memory(made: Made, time: Floats, path: Floats, elastic: Course, nominal: Course) -> Course:
    """Answers (t,) to the path of the dot. ValueError beyond the largest strength that is solved."""
    value = strength(made)
    if value > NODES[-1]:
        raise ValueError(f"a strength of {value:g} is beyond {NODES[-1]:g}")
    marks, near = through_time(with_strength(made, NODES[0]), time, path)
    far = through_time(with_strength(made, NODES[1]), time, path)[1]

    def scaled(name: str) -> Floats:
        own, base = getattr(elastic, name), getattr(nominal, name)
        solved = [getattr(course, name) - base[marks] for course in (near, far)]
        return _scaled(own, base, PchipInterpolator(time[marks], _parabola(value, *solved))(time))

    return Course(np.where(path > 0.0, scaled("force_N"), 0.0), scaled("charge_pC"), elastic.area_mm2)


def _parabola(value: float, near: Floats, far: Floats) -> Floats:
    """Difference to the elastic press at a strength: a s + b s^2, which has the solved differences at both nodes."""
    first, second = near / NODES[0], far / NODES[1]
    bend = (second - first) / (NODES[1] - NODES[0])
    return np.asarray(value * (first + bend * (value - NODES[0])))


def _scaled(elastic: Floats, nominal: Floats, difference: Floats) -> Floats:
    """elastic + ratio times the difference: only that is interpolated in time, for the path itself is known."""
    faint = FAINT * float(np.abs(nominal).max())
    ratio = np.where(np.abs(nominal) > faint, elastic / np.where(np.abs(nominal) > faint, nominal, 1.0), 1.0)
    return np.asarray(elastic + ratio * difference)
