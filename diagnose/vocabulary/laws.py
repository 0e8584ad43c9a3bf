"""Candidates of the media: laws that stiffen, that are compressible, that soften after the first press."""

from collections.abc import Iterator, Sequence
from math import exp, log
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.scene import Scene
from solve.materials.inelastic import Softening
from solve.materials.parameters import Hyperfoam, Material, MooneyRivlin, NeoHookean, Ogden, Yeoh
from solve.mechanisms import MEDIA
from solve.switch_on import shear_modulus_MPa

STEEP = 8.0  # exponent of the Ogden term that stiffens
FREELY_COMPRESSIBLE = 3.0  # 3 (1 - 2 nu) = E / K of nu = 0
STEEPEST = log(10.0)  # exponent of a foam over that of rubber, 2: measured foams have 8 to 20
LOSS = 0.7  # filled rubber loses up to 40 % on the first press, soft tough ones more


def of_media(scene: Scene) -> Iterator[Candidate]:
    """Those of the media that this rig has."""
    for component in MEDIA:
        material = scene.model.materials.get(component)
        if material is None:
            continue
        yield from _stiffening(component, material)
        yield from _foam(component, material)
        yield _softening(scene, component)


def _stiffening(component: str, material: Material) -> Iterator[Candidate]:
    """A law that goes over into the declared one, so that its constants are 0 when it is off."""
    if isinstance(material, NeoHookean | Yeoh):
        yield _yeoh(component, material)
    elif isinstance(material, MooneyRivlin | Ogden):
        yield _ogden(component, material)


def _yeoh(component: str, material: NeoHookean | Yeoh) -> Candidate:
    """c20 and c30 over c10. Gent's law with the limit J of I1 - 3 has 1 / 2J and 1 / 3J^2: up to J = 0.4 and 0.33."""
    c10 = 0.5 * shear_modulus_MPa(material)
    c20, c30 = (material.c20_MPa, material.c30_MPa) if isinstance(material, Yeoh) else (0.0, 0.0)
    coordinates = (
        Coordinate("c20_over_c10", 0.0, 1.25, (0.1, 0.5), (0.4, 1.25)),
        Coordinate("c30_over_c10", 0.0, 3.0, (0.1, 1.0), (0.75, 3.0)),
    )

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"c10_MPa": c10, "c20_MPa": c20 + c10 * values[0], "c30_MPa": c30 + c10 * values[1]}

    units = {"c10_MPa": "MPa", "c20_MPa": "MPa", "c30_MPa": "MPa", "force_ratio": ""}
    return Candidate("hyperelastic-stiffening", component, coordinates, parameters, units=units)


def _ogden(component: str, material: MooneyRivlin | Ogden) -> Candidate:
    """One more term with a large exponent, by its share of the shear modulus. Mooney-Rivlin is Ogden's 2 and -2."""
    if isinstance(material, Ogden):
        mu, alpha = material.mu_MPa, material.alpha
    else:
        mu, alpha = (2.0 * material.c10_MPa, -2.0 * material.c01_MPa), (2.0, -2.0)
    shear = shear_modulus_MPa(material)
    coordinate = Coordinate("share", 0.0, 3.0, (0.1, 1.0), (0.3, 1.0, 3.0))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"mu_MPa": (*mu, 2.0 * shear * values[0] / STEEP), "alpha": (*alpha, STEEP)}

    units = {"mu_MPa": "MPa", "alpha": "", "force_ratio": ""}
    return Candidate("hyperelastic-stiffening", component, (coordinate,), parameters, units=units)


def _foam(component: str, material: Material) -> Iterator[Candidate]:
    """Young's modulus stays. Of a rubber: compressibility, and how far the exponent is above rubber's 2.

    A declared foam stays as compressible as it is; its exponents change.
    """
    if isinstance(material, Hyperfoam):
        yield _steeper(component, material)
        return
    shear, ratio = shear_modulus_MPa(material), material.poisson_ratio
    assert isinstance(ratio, float)
    rigid = 3.0 * (1.0 - 2.0 * ratio)
    if rigid >= FREELY_COMPRESSIBLE:
        return
    most = FREELY_COMPRESSIBLE - rigid
    coordinates = (
        Coordinate("compressibility", 0.0, most, (0.3 * most, 0.8 * most), (0.2 * most, 0.5 * most, most)),
        Coordinate("log_exponent", 0.0, STEEPEST, (0.5, 1.5), (0.45 * STEEPEST, STEEPEST)),
    )

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        nu = 0.5 - (rigid + values[0]) / 6.0
        mu = shear * (1.0 + ratio) / (1.0 + nu)
        return {"mu_MPa": (mu,), "alpha": (2.0 * exp(values[1]),), "poisson_ratio": (nu,)}

    yield Candidate("foam-densification", component, coordinates, parameters, units=_FOAM)


def _steeper(component: str, material: Hyperfoam) -> Candidate:
    coordinate = Coordinate("log_exponent", -STEEPEST, STEEPEST, (0.5, -0.5), (-STEEPEST, -0.8, 0.8, STEEPEST))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        alpha = tuple(a * exp(values[0]) for a in material.alpha)
        return {"mu_MPa": material.mu_MPa, "alpha": alpha, "poisson_ratio": material.poisson_ratio}

    return Candidate("foam-densification", component, (coordinate,), parameters, units=_FOAM)


_FOAM = {"mu_MPa": "MPa", "alpha": "", "poisson_ratio": "", "force_ratio": ""}


def _softening(scene: Scene, component: str) -> Candidate:
    """The largest loss of stress."""
    declared = scene.model.physics.softening.get(component, Softening(0.0))
    coordinate = Coordinate("loss", 0.0, LOSS, (0.1, 0.4), (0.35, LOSS))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        loss = declared.loss + (1.0 - declared.loss) * values[0]
        return {"loss_ratio": loss, "energy_MPa": declared.energy, "beta": declared.beta}

    units = {"loss_ratio": "", "energy_MPa": "MPa", "beta": ""}
    return Candidate("stress-softening", component, (coordinate,), parameters, units=units)
