"""A medium that is a foam: how compressible it is, and how far its exponent is above rubber's 2."""

from collections.abc import Iterator, Sequence
from math import exp, log
from typing import Any

from diagnose.engines.coupon.tested_layer import SPECIMEN, PartOfLayer
from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import STIFFNESS, Vocabulary, register
from diagnose.vocabulary.scene import CouponScene, Scene
from solve.materials.parameters import Hyperfoam, Material
from solve.mechanisms.base import MEDIA
from solve.mechanisms.layers.foam_densification import FOAM_DENSIFICATION

FREELY_COMPRESSIBLE = 3.0  # 3 (1 - 2 nu) = E / K of nu = 0
STEEPEST = log(10.0)  # exponent of a foam over that of rubber, 2: measured foams have 8 to 20
COMPRESSIBLE = 0.45  # Poisson's ratio below which a coupon may be a foam
LARGEST_EXPONENT = 60.0  # of a coupon


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for the media that this rig has."""
    for component in MEDIA:
        material = scene.model.materials.get(component)
        if material is not None:
            yield from _foam(component, material)


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """Yield candidates for what is compressible."""
    if scene.point.poisson_ratio < COMPRESSIBLE:
        material = scene.material
        yield _of_specimen(material if isinstance(material, Hyperfoam) else _as_foam(material))


def _foam(component: str, material: Material) -> Iterator[Candidate]:
    """Young's modulus stays. Of a rubber: compressibility, and how far the exponent is above rubber's 2.

    A declared foam stays as compressible as it is; its exponents change.
    """
    if isinstance(material, Hyperfoam):
        yield _steeper(component, material)
        return
    shear, ratio = material.shear_modulus_MPa, material.poisson_ratio
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

    yield Candidate(
        FOAM_DENSIFICATION.name,
        component,
        coordinates,
        parameters,
        units=_FOAM,
        compared="force_ratio",
        together="fading",
    )


def _steeper(component: str, material: Hyperfoam) -> Candidate:
    coordinate = Coordinate("log_exponent", -STEEPEST, STEEPEST, (0.5, -0.5), (-STEEPEST, -0.8, 0.8, STEEPEST))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        alpha = tuple(a * exp(values[0]) for a in material.alpha)
        return {"mu_MPa": material.mu_MPa, "alpha": alpha, "poisson_ratio": material.poisson_ratio}

    return Candidate(
        FOAM_DENSIFICATION.name,
        component,
        (coordinate,),
        parameters,
        units=_FOAM,
        compared="force_ratio",
        together="fading",
    )


_FOAM = {"mu_MPa": "MPa", "alpha": "", "poisson_ratio": "", "force_ratio": ""}


def _of_specimen(material: Hyperfoam) -> Candidate:
    """Another exponent: the higher, the earlier and flatter the plateau. The small-strain moduli stay.

    mu is not told, since the modulus that is fitted beside it multiplies it.
    """
    most = log(min(20.0, max(LARGEST_EXPONENT / max(map(abs, material.alpha)), 1.2)))
    coordinate = Coordinate("log_alpha", -log(20.0), most, (0.5 * most, -log(2.0)))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {
            "mu_MPa": list(material.mu_MPa),
            "alpha": [exp(values[0]) * alpha for alpha in material.alpha],
            "poisson_ratio": list(material.poisson_ratio),
        }

    def told(values: Sequence[float]) -> dict[str, Any]:
        return {name: each for name, each in parameters(values).items() if name != "mu_MPa"}

    units = {"mu_MPa": "MPa", "alpha": "", "poisson_ratio": ""}
    return PartOfLayer(FOAM_DENSIFICATION.name, SPECIMEN, (coordinate,), parameters, units=units, told=told)


def _as_foam(material: Material) -> Hyperfoam:
    """The foam with the small-strain moduli of another compressible law, and like it where it is hardly strained."""
    ratio = material.poisson_ratio
    assert not isinstance(ratio, tuple)
    return Hyperfoam(mu_MPa=(material.shear_modulus_MPa,), alpha=(2.0,), poisson_ratio=(ratio,))


register(
    Vocabulary(
        FOAM_DENSIFICATION,
        "{} is a foam, which collapses and then densifies",
        of_segment=of_segment,
        of_coupon=of_coupon,
        kind=STIFFNESS,
    )
)
