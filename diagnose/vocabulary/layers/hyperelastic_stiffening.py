"""A law that stiffens at large strain, of a medium, a coupon or whatever strains an unknown sensor."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from diagnose.engines.coupon.kinematics import SimpleShear
from diagnose.engines.coupon.point import MaterialPoint
from diagnose.engines.coupon.stiffening import Stiffening
from diagnose.engines.coupon.tested_layer import LAYER, SPECIMEN, PartOfLayer, layer_model
from diagnose.engines.proportional.medium import LARGEST_MEDIUM_STRAIN, MEDIUM
from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import STIFFNESS, Vocabulary, register
from diagnose.vocabulary.scene import CouponScene, Scene
from solve.materials.parameters import Hyperfoam, Knowles, Material, MooneyRivlin, NeoHookean, Ogden, Yeoh
from solve.mechanisms import Mechanism, with_mechanisms
from solve.mechanisms.base import MEDIA
from solve.mechanisms.layers.hyperelastic_stiffening import HYPERELASTIC_STIFFENING

HIGHEST = float(np.log1p(30.0))  # a slope of dW/dI1 of 30 at rest: soft tissue reaches it, no rubber does
EXPONENTIAL = 0.01  # of 1 / (n - 1), below which the law is as good as exponential
NEXT_TO_NOTHING = 1e-9  # of b, which is above 0 where the mechanism is on: where a fit ends at a slope of 0
SOONEST = 100.0  # of b
STEEP = 8.0  # exponent of the Ogden term that stiffens


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for the media that this rig has: laws that go over into the declared one with constants 0."""
    for component in MEDIA:
        material = scene.model.materials.get(component)
        if isinstance(material, NeoHookean):
            yield _knowles(component)
        elif isinstance(material, Knowles):
            yield _steeper_knowles(component, material)
        elif isinstance(material, Yeoh):
            yield _yeoh(component, material)
        elif isinstance(material, MooneyRivlin | Ogden):
            yield _ogden(component, material)


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """Yield candidates for all but foams."""
    if not isinstance(scene.material, Hyperfoam):
        by_force = any(run.drive == "force_N" for run in scene.recording.runs)
        yield _of_specimen(scene.material, scene.point, scene.travel_mm, by_force)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Yield candidates for whatever medium strains the film."""
    yield _of_sensor()


def _of_sensor() -> Candidate:
    """force_ratio is that at the strain of the largest force without: the force that it takes with."""
    stretch = SimpleShear(1.0, 1.0).principal_stretch(np.array([LARGEST_MEDIUM_STRAIN]))
    law = Stiffening(MEDIUM, stretch, SimpleShear.lateral, by_force=True)

    def derived(values: Sequence[float]) -> dict[str, float]:
        return {"force_ratio": 1.0 + sum(values)}

    unit = "of twice the shear modulus"
    units = {"c10_MPa": unit, "c20_MPa": unit, "c30_MPa": unit, "force_ratio": ""}
    return Candidate(HYPERELASTIC_STIFFENING.name, LAYER, law.coordinates, law.parameters, derived, units)


def _knowles(component: str) -> Candidate:
    """Knowles' law from the exponential one to Yeoh's, by the slope of dW/dI1 at rest, b (n - 1) / n, and 1 / (n - 1).

    Gent's law with the limit J of I1 - 3 has the slope 1 / J at rest.
    """
    coordinates = (
        Coordinate("log_stiffening", 0.0, HIGHEST, (0.3, 1.2), (0.2 * HIGHEST, 0.5 * HIGHEST, HIGHEST)),
        Coordinate("power_law", 0.0, 1.0, (0.3, 1.0), (1.0,), (True, True)),
    )

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        b, inverse = max(float(np.expm1(values[0])) * (1.0 + values[1]), NEXT_TO_NOTHING), values[1]
        return {"b": b, "n": 1.0 + 1.0 / inverse} if inverse > EXPONENTIAL else {"b": b}

    return _of_layer(component, coordinates, parameters, {"b": "", "n": ""}, "fading")


def _steeper_knowles(component: str, material: Knowles) -> Candidate:
    """Logarithm of the factor on b, how soon the declared law stiffens; its exponent stays."""
    coordinate = Coordinate("log_b", -HIGHEST, HIGHEST, (0.3, -0.3), (-HIGHEST, -0.4 * HIGHEST, 0.4 * HIGHEST, HIGHEST))
    stays = {"c10_MPa": material.c10_MPa} | ({} if material.n is None else {"n": material.n})

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {**stays, "b": min(material.b * float(np.exp(values[0])), SOONEST)}

    return _of_layer(component, (coordinate,), parameters, {"c10_MPa": "MPa", "b": "", "n": ""})


def _yeoh(component: str, material: Yeoh) -> Candidate:
    """c20 and c30 over c10. Gent's law with the limit J of I1 - 3 has 1 / 2J and 1 / 3J^2: up to J = 0.4 and 0.33."""
    c10, c20, c30 = material.c10_MPa, material.c20_MPa, material.c30_MPa
    coordinates = (
        Coordinate("c20_over_c10", 0.0, 1.25, (0.1, 0.5), (0.4, 1.25)),
        Coordinate("c30_over_c10", 0.0, 3.0, (0.1, 1.0), (0.75, 3.0)),
    )

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"c10_MPa": c10, "c20_MPa": c20 + c10 * values[0], "c30_MPa": c30 + c10 * values[1]}

    return _of_layer(component, coordinates, parameters, dict.fromkeys(("c10_MPa", "c20_MPa", "c30_MPa"), "MPa"))


def _ogden(component: str, material: MooneyRivlin | Ogden) -> Candidate:
    """One more term with a large exponent, by its share of the shear modulus. Mooney-Rivlin is Ogden's 2 and -2."""
    if isinstance(material, Ogden):
        mu, alpha = material.mu_MPa, material.alpha
    else:
        mu, alpha = (2.0 * material.c10_MPa, -2.0 * material.c01_MPa), (2.0, -2.0)
    shear = material.shear_modulus_MPa
    coordinate = Coordinate("share", 0.0, 3.0, (0.1, 1.0), (0.3, 1.0, 3.0))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"mu_MPa": (*mu, 2.0 * shear * values[0] / STEEP), "alpha": (*alpha, STEEP)}

    return _of_layer(component, (coordinate,), parameters, {"mu_MPa": "MPa", "alpha": ""})


def _of_layer(
    component: str,
    coordinates: tuple[Coordinate, ...],
    parameters: Callable[[Sequence[float]], dict[str, Any]],
    units: Mapping[str, str],
    together: str = "jointly",
) -> Candidate:
    """One whose force_ratio a press of the 3D model tells."""
    return Candidate(
        HYPERELASTIC_STIFFENING.name,
        component,
        coordinates,
        parameters,
        units={**units, "force_ratio": ""},
        compared="force_ratio",
        together=together,
    )


def _of_specimen(material: Material, point: MaterialPoint, travel_mm: float, by_force: bool) -> Candidate:
    """force_ratio is that at the largest travel, with over without.

    Terms are told by their shares of the small-strain modulus, since a modulus that is fitted beside them multiplies
    all constants: mu alpha / 2 over the shear modulus of Ogden's (Ogden 1972), c20 and c30 over c10.
    """
    unknown = point.kinematics.initial_unknowns(np.array([travel_mm]), point.poisson_ratio)
    law = Stiffening(material, point.kinematics.principal_stretch(unknown[0]), point.kinematics.lateral, by_force)
    without = _force(point, travel_mm)

    def derived(values: Sequence[float]) -> dict[str, float]:
        mechanism = Mechanism(name=HYPERELASTIC_STIFFENING.name, component=LAYER, parameters=law.parameters(values))
        stiff = with_mechanisms(layer_model(material, 1.0), [mechanism]).materials[LAYER]
        return {"force_ratio": _force(replace(point, law=stiff.law), travel_mm) / without}

    def told(values: Sequence[float]) -> dict[str, Any]:
        constants = {name.removesuffix("_MPa"): np.array(each) for name, each in law.parameters(values).items()}
        if "c10" in constants:
            return {f"{name}_over_c10": float(constants[name] / constants["c10"]) for name in ("c20", "c30")}
        shares = constants["mu"] * constants["alpha"] / (2.0 * material.shear_modulus_MPa)
        return {"share_of_modulus": shares.tolist(), "alpha": constants["alpha"].tolist()}

    units = {"c10_MPa": "MPa", "c20_MPa": "MPa", "c30_MPa": "MPa", "mu_MPa": "MPa", "alpha": "", "force_ratio": ""}
    return PartOfLayer(
        HYPERELASTIC_STIFFENING.name, SPECIMEN, law.coordinates, law.parameters, derived, units, told=told
    )


def _force(point: MaterialPoint, travel_mm: float) -> float:
    """Force of the elastic coupon at a travel, from rest."""
    return float(point.answer(np.array([0.0, 1.0]), np.array([0.0, travel_mm]), "displacement_mm")[1])


register(
    Vocabulary(
        HYPERELASTIC_STIFFENING,
        "{} stiffens at large strain",
        of_segment=of_segment,
        of_coupon=of_coupon,
        of_unknown_geometry=of_unknown_geometry,
        below_one=("force_ratio", "{} stiffens less, or gives way, at large strain"),
        kind=STIFFNESS,
    )
)
