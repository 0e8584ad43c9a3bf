"""Wrong numbers in rig.toml: moduli, thicknesses, piezoelectric constants, the dot's size. Also the nuisances."""

from collections.abc import Callable, Iterator, Sequence
from math import exp, log
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.scene import Scene
from geometry.dot import resolve_dot
from geometry.stack import layers

MODULUS = log(3.5)  # data and data sheets of one silicone differ up to 3.5 times
THICKNESS = log(1.35)  # a cast sheet is seldom off by more than a third
D31 = log(3.0)  # 20 % from lot to lot; a film that has been too hot loses most of it
RADIUS = log(1.35)  # Braille standards allow 10 % and more
HALVES = 0.4, 1.0  # of the way to the bounds: where the 3D model is pressed

FACTORS = {"modulus": MODULUS, "thickness": THICKNESS, "d31": D31, "radius": RADIUS, "height": RADIUS}


def wrong_numbers(scene: Scene) -> Iterator[Candidate]:
    """One candidate for each layer and for the dot; a factor's coordinate is its logarithm."""
    for layer in layers(scene.model.segment):
        factors = ("modulus", "thickness", "d31") if layer.name == "film" else ("modulus", "thickness")
        yield property_error(layer.name, factors)
    if scene.model.dot.shape != "plate":
        touches = scene.depth_mm >= resolve_dot(scene.model.dot, scene.model.segment).height_mm
        yield property_error("dot", ("radius", "height") if touches else ("radius",))


def property_error(component: str, factors: Sequence[str]) -> Candidate:
    """Errors of some factors of a component. d31 scales the charge, which takes no press."""
    coordinates = tuple(_factor(name) for name in factors)
    units = {f"{name}_factor": "" for name in factors}
    return Candidate("property-error", component, coordinates, _parameters(factors), units=units)


def _factor(name: str) -> Coordinate:
    most = FACTORS[name]
    nodes = () if name == "d31" else tuple(sign * half * most for half in HALVES for sign in (-1.0, 1.0))
    return Coordinate(name, -most, most, (0.3 * most, -0.3 * most), nodes)


def _parameters(factors: Sequence[str]) -> Callable[[Sequence[float]], dict[str, Any]]:
    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {f"{name}_factor": exp(value) for name, value in zip(factors, values, strict=True)}

    return parameters


def nuisance(scene: Scene, name: str) -> Candidate | None:
    """The candidate whose one coordinate is the relative error of "modulus.PART", "thickness.PART" or "d31"."""
    quantity, _, part = name.partition(".")
    component = part or "film"
    if quantity not in ("modulus", "thickness", "d31") or component not in scene.model.materials:
        return None
    return property_error(component, (quantity,))
