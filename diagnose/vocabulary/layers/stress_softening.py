"""A medium that is softer once it has been strained: by its largest loss of stress, and the energy that this takes.

With the energy m = 0 of Ogden and Roxburgh's law all that counts is the ratio of an energy to the largest one; with a
large m a loss comes only where much was strained. Its coordinate is m / (m + m0), m0 in terms of Young's modulus.
A solid, whose presses down and up take minutes each, is pressed with m = 0 alone.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from diagnose.engines.coupon.point import youngs_modulus_MPa
from diagnose.engines.coupon.tested_layer import LAYER, SPECIMEN, PartOfLayer
from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import REMEMBERS, Vocabulary, register
from diagnose.vocabulary.scene import CouponScene, Scene
from solve.materials.mullins import Softening
from solve.materials.parameters import PiezoelectricFilm
from solve.mechanisms.base import MEDIA
from solve.mechanisms.layers.stress_softening import STRESS_SOFTENING
from solve.physics import laws_of

LOSS = 0.7  # filled rubber loses up to 40 % on the first press, soft tough ones more
ENERGY, BLUNTEST = 0.01, 0.8  # up to 4 % of Young's modulus: what a strain of 30 % stores
LARGEST_LOSS = 0.9  # of a coupon


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for the media that this rig has."""
    for component in MEDIA:
        if component in scene.model.materials:
            yield _softening(scene, component)


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """The specimen."""
    yield _of(PartOfLayer, SPECIMEN)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Whatever medium strains the film."""
    yield _of(Candidate, LAYER)


def _softening(scene: Scene, component: str) -> Candidate:
    """The largest loss of stress and, of a slice, the energy."""
    declared = laws_of(scene.model.physics.inelastic, Softening).get(component, Softening(0.0))
    loss = Coordinate("loss", 0.0, LOSS, (0.1, 0.4), (0.35, LOSS))
    energy = Coordinate("energy", 0.0, BLUNTEST, (0.5,), (0.4, BLUNTEST), levels_off=(False, True))
    material = scene.model.materials[component]
    assert not isinstance(material, PiezoelectricFilm)
    scale = ENERGY * youngs_modulus_MPa(material.law)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        loss_ratio = declared.loss + (1.0 - declared.loss) * values[0]
        more = scale * values[1] / (1.0 - values[1]) if len(values) > 1 else 0.0
        return {"loss_ratio": loss_ratio, "energy_MPa": declared.energy + more, "beta": declared.beta}

    units = {"loss_ratio": "", "energy_MPa": "MPa", "beta": ""}
    coordinates = (loss,) if scene.model.segment.section == "solid" else (loss, energy)
    return Candidate(
        STRESS_SOFTENING.name, component, coordinates, parameters, units=units, compared="loss_ratio", together="fading"
    )


def _of(make: type[Candidate], component: str) -> Candidate:
    """The candidate at a component."""
    coordinate = Coordinate("loss_ratio", 0.0, LARGEST_LOSS, (0.1, 0.4))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"loss_ratio": values[0]}

    return make(STRESS_SOFTENING.name, component, (coordinate,), parameters, units={"loss_ratio": ""})


register(
    Vocabulary(
        STRESS_SOFTENING,
        "{} is softer once it has been strained (stress softening)",
        of_segment=of_segment,
        of_coupon=of_coupon,
        of_unknown_geometry=of_unknown_geometry,
        kind=REMEMBERS,
    )
)
