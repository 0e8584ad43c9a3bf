"""What may be missing in the material of a coupon, or in its tester.

A segment whose medium 1 is the part that was tested: what switches mechanisms on in a press does so here.

Only medium 1, the read-out and the physics of such a model are looked at; film, medium 2 and dot stand idle.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import exp, log, sinh
from typing import Any

import numpy as np

from diagnose.engines.coupon.laws import MOST_OF_COUPON, Stiffening, relaxation_times, viscoelasticity
from diagnose.engines.coupon.point import MaterialPoint
from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.signals.recording import Recording
from diagnose.vocabulary.scene import growing
from geometry.parameters import Dot, Film, Medium, Segment
from solve.materials.laws import medium_law
from solve.materials.parameters import Hyperfoam, Material, library
from solve.mechanisms import Mechanism
from solve.model import Model
from solve.parameters import Readout
from solve.switch_on import shear_modulus_MPa, with_mechanisms

LAYER = "medium1"


class PartOfLayer(Candidate):
    """A candidate whose component in the verdict is none of a segment: its mechanism acts on medium 1."""

    def switched_on(self, values: Sequence[float]) -> Mechanism:
        """The mechanism on medium 1. ValueError for values beyond its bounds."""
        return Mechanism(name=self.mechanism, component=LAYER, parameters=self.parameters(values))


def one_layer(material: Material, thickness_mm: float, readout: Readout | None = None) -> Model:
    """The model with this material in medium 1."""
    idle = Medium(thickness_mm=1.0)
    segment = Segment(medium1=Medium(thickness_mm=thickness_mm), film=Film(thickness_um=28.0), medium2=idle)
    materials = {LAYER: material, "film": library()["pvdf"], "medium2": library()["vnr"]}
    return Model(segment, materials, Dot(), readout=readout)


def switched(settings: Sequence[Setting]) -> list[Mechanism]:
    """The mechanisms of the settings that are not off."""
    return [setting.candidate.switched_on(setting.values) for setting in settings if any(setting.values)]


def with_factors_last(model: Model, mechanisms: Sequence[Mechanism]) -> Model:
    """The model with the mechanisms; a wrong modulus scales whatever law stands there in the end."""
    return with_mechanisms(model, sorted(mechanisms, key=lambda mechanism: mechanism.name == "property-error"))


SPECIMEN = "specimen"
COMPRESSIBLE = 0.45  # Poisson's ratio below which a material may be a foam
FACTOR = log(10.0)  # a modulus that is wrong by more is another material
LARGEST_LOSS = 0.9
STEEPEST = 60.0  # exponent of a foam
GRIP_G, HEAVIEST_GRIP_G = 50.0, 20_000.0
MOST_OF_TRAVEL = 0.25  # a tester that takes more than a quarter of the travel is seen to bend


def coupon_candidates(recording: Recording, material: Material, point: MaterialPoint) -> Iterator[Candidate]:
    """Every mechanism that a homogeneous coupon admits; point : the baseline, which gives the scales."""
    travel = max(float(np.nanmax(np.abs(run.channels["displacement_mm"]))) for run in recording.runs)
    force = max(float(np.nanmax(np.abs(run.channels["force_N"]))) for run in recording.runs)
    yield viscoelasticity(PartOfLayer, SPECIMEN, relaxation_times(recording), MOST_OF_COUPON)
    if not isinstance(material, Hyperfoam):
        by_force = any(run.drive == "force_N" for run in recording.runs)
        yield _stiffening(material, point, travel, by_force)
    if point.poisson_ratio < COMPRESSIBLE:
        yield _foam(material if isinstance(material, Hyperfoam) else _as_foam(material))
    yield stress_softening(PartOfLayer, SPECIMEN)
    yield _property()
    yield _compliance(travel / force)
    if all(run.drive == "displacement_mm" for run in recording.runs):
        yield _grip()


def _stiffening(material: Material, point: MaterialPoint, travel_mm: float, by_force: bool) -> Candidate:
    """force_ratio is that at the largest travel, with over without."""
    unknown = point.kinematics.start(np.array([travel_mm]), point.poisson_ratio)
    law = Stiffening(material, point.kinematics.principal_stretch(unknown[0]), point.kinematics.lateral, by_force)
    without = _force(point, travel_mm)

    def derived(values: Sequence[float]) -> dict[str, float]:
        mechanism = Mechanism(name="hyperelastic-stiffening", component=LAYER, parameters=law.parameters(values))
        stiff = with_mechanisms(one_layer(material, 1.0), [mechanism]).materials[LAYER]
        return {"force_ratio": _force(replace(point, law=medium_law(stiff).scaled(1e-6)), travel_mm) / without}

    units = {"c10_MPa": "MPa", "c20_MPa": "MPa", "c30_MPa": "MPa", "mu_MPa": "MPa", "alpha": "", "force_ratio": ""}
    return PartOfLayer("hyperelastic-stiffening", SPECIMEN, law.coordinates, law.parameters, derived, units)


def _force(point: MaterialPoint, travel_mm: float) -> float:
    """Of the elastic coupon at a travel, from rest."""
    return float(point.answer(np.array([0.0, 1.0]), np.array([0.0, travel_mm]), "displacement_mm")[1])


def _foam(material: Hyperfoam) -> Candidate:
    """Another exponent: the higher, the earlier and flatter the plateau. The small-strain moduli stay."""
    most = log(min(20.0, max(STEEPEST / max(map(abs, material.alpha)), 1.2)))
    coordinate = Coordinate("log_alpha", -log(20.0), most, (0.5 * most, -log(2.0)))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {
            "mu_MPa": list(material.mu_MPa),
            "alpha": [exp(values[0]) * alpha for alpha in material.alpha],
            "poisson_ratio": list(material.poisson_ratio),
        }

    units = {"mu_MPa": "MPa", "alpha": "", "poisson_ratio": ""}
    return PartOfLayer("foam-densification", SPECIMEN, (coordinate,), parameters, units=units)


def _as_foam(material: Material) -> Hyperfoam:
    """The foam with the small-strain moduli of another compressible law, and like it where it is hardly strained."""
    ratio = material.poisson_ratio
    assert not isinstance(ratio, tuple)
    return Hyperfoam(mu_MPa=(shear_modulus_MPa(material),), alpha=(2.0,), poisson_ratio=(ratio,))


def stress_softening(make: type[Candidate], component: str) -> Candidate:
    """The candidate at a component."""
    coordinate = Coordinate("loss_ratio", 0.0, LARGEST_LOSS, (0.1, 0.4))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"loss_ratio": values[0]}

    return make("stress-softening", component, (coordinate,), parameters, units={"loss_ratio": ""})


def _property() -> Candidate:
    """The modulus. A thickness in tension does the same, in shear and compression nearly so."""
    coordinate = Coordinate("log_modulus", -FACTOR, FACTOR, (0.2, -0.2, 1.0, -1.0))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"modulus_factor": exp(values[0])}

    return PartOfLayer("property-error", SPECIMEN, (coordinate,), parameters, units={"modulus_factor": ""})


def _compliance(scale: float) -> Candidate:
    """Of the tester; scale : largest travel over largest force, with which nothing is left to the coupon."""
    coordinate = growing("compliance", scale, MOST_OF_TRAVEL * scale, (0.05 * scale, 0.2 * scale))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"compliance_mm_per_N": scale * sinh(values[0])}

    return Candidate("rig-compliance", "rig", (coordinate,), parameters, units={"compliance_mm_per_N": "mm/N"})


def _grip() -> Candidate:
    """Mass between load cell and specimen, where the cell moves: from a clip to the grips of a large tester."""
    coordinate = growing("mass", GRIP_G, HEAVIEST_GRIP_G, (GRIP_G, 10.0 * GRIP_G))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"moving_mass_g": GRIP_G * sinh(values[0])}

    return Candidate("inertia", "rig", (coordinate,), parameters, units={"moving_mass_g": "g"})


def relative_error(name: str, parameter: str) -> Candidate:
    """A nuisance whose coordinate is the relative error of modulus or thickness, held within its bounds."""
    coordinate = Coordinate(name, -0.95, 100.0, (0.1, -0.1))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {parameter: 1.0 + min(max(values[0], coordinate.low), coordinate.high)}

    return PartOfLayer("property-error", name, (coordinate,), parameters)


def drive_error(name: str) -> Candidate:
    """A nuisance of the drive, which is no mechanism: added to it, or its relative error."""
    coordinate = Coordinate(name, -1e6 if name != "force_gain" else -0.9, 1e6, (0.01, -0.01))
    return Candidate(name, "drive", (coordinate,), lambda values: {name: values[0]})
