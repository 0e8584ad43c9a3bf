"""Wrong numbers in rig.toml: moduli, thicknesses, piezoelectric constants, the dot's size. Also the nuisances."""

from collections.abc import Callable, Iterator, Sequence
from math import exp, log
from typing import Any

from diagnose.engines.coupon.tested_layer import SPECIMEN, PartOfLayer
from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.vocabulary.base import GIVES_WAY, STIFFNESS, Vocabulary, register
from diagnose.vocabulary.scene import CouponScene, Scene
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import SIZED_DOTS
from geometry.stack import layers
from solve.mechanisms.layers.property_error import PROPERTY_ERROR

MODULUS = log(3.5)  # data and data sheets of one silicone differ up to 3.5 times
THICKNESS = log(1.35)  # a cast sheet is seldom off by more than a third
D31 = log(3.0)  # 20 % from lot to lot; a film that has been too hot loses most of it
RADIUS = log(1.35)  # Braille standards allow 10 % and more
HALVES = 0.4, 1.0  # of the way to the bounds: where the 3D model is pressed

FACTORS = {"modulus": MODULUS, "thickness": THICKNESS, "d31": D31, "radius": RADIUS, "height": RADIUS}
COUPON_FACTOR = log(10.0)  # a modulus of a coupon that is wrong by more is another material


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """One candidate for each layer and for the dot; a factor's coordinate is its logarithm."""
    for layer in layers(scene.model.segment):
        factors = ("modulus", "thickness", "d31") if layer.name == "film" else ("modulus", "thickness")
        yield property_error(layer.name, factors)
    if scene.model.dot.shape in SIZED_DOTS:
        touches = scene.depth_mm >= resolve_dot(scene.model.dot, scene.model.segment).height_mm
        yield property_error("dot", ("radius", "height") if touches else ("radius",))


def property_error(component: str, factors: Sequence[str]) -> Candidate:
    """Errors of some factors of a component. d31 scales the charge, which takes no press."""
    coordinates = tuple(_factor(name) for name in factors)
    units = {f"{name}_factor": "" for name in factors}
    return Candidate(PROPERTY_ERROR.name, component, coordinates, _parameters(factors), units=units)


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


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """The modulus. A thickness in tension does the same, in shear and compression nearly so."""
    coordinate = Coordinate("log_modulus", -COUPON_FACTOR, COUPON_FACTOR, (0.2, -0.2, 1.0, -1.0))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"modulus_factor": exp(values[0])}

    yield PartOfLayer(PROPERTY_ERROR.name, SPECIMEN, (coordinate,), parameters, units={"modulus_factor": ""})


def relative_error(make: type[Candidate], name: str, parameter: str) -> Candidate:
    """A nuisance: the relative error of modulus or thickness, held within its bounds. make : class of the candidate."""
    coordinate = Coordinate(name, -0.95, 100.0, (0.1, -0.1))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {parameter: 1.0 + min(max(values[0], coordinate.low), coordinate.high)}

    return make(PROPERTY_ERROR.name, name, (coordinate,), parameters)


def kinds_at(setting: Setting) -> Iterator[str]:
    """Kinds of an error of a medium's stiffness; one that is less than stated gives way in series with the film."""
    factors = setting.candidate.parameters(setting.values)
    if setting.candidate.component in ("film", SPECIMEN) or "modulus_factor" not in factors:
        return
    yield STIFFNESS
    if factors["modulus_factor"] < factors.get("thickness_factor", 1.0):
        yield GIVES_WAY


register(
    Vocabulary(
        PROPERTY_ERROR,
        "a property of {} differs from rig.toml",
        of_segment=of_segment,
        of_coupon=of_coupon,
        kinds_at=kinds_at,
    )
)
