# ruff: noqa: ARG001 - every switch is called alike, also where the component is the only one
"""Switch a mechanism on in a model. With its off value every one of them gives the model back unchanged in effect."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from geometry.dot import resolve_dot
from solve.materials.inelastic import Prony, Softening
from solve.materials.parameters import (
    Hyperfoam,
    Linear,
    Material,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    PiezoelectricFilm,
    Yeoh,
)
from solve.mechanisms import Mechanism
from solve.model import BondLine, Delamination, Model, Pyroelectric, Yield
from solve.parameters import Readout
from solve.readout.filters import Filter, Saturation
from solve.terms.springs import layer_stiffness


def with_mechanisms(model: Model, mechanisms: Iterable[Mechanism]) -> Model:
    """The model with these mechanisms, one after the other. ValueError where the model has no such component."""
    for mechanism in mechanisms:
        model = SWITCHES[mechanism.name](model, mechanism.component, mechanism.values())
    return model


def _readout(model: Model, **changes: Any) -> Model:
    return replace(model, readout=(model.readout or Readout()).model_copy(update=changes))


def _leakage(model: Model, component: str, values: Any) -> Model:
    have = (model.readout or Readout()).input_resistance_MOhm
    conductance = 1.0 / values.resistance_MOhm + (1.0 / have if have is not None else 0.0)
    return _readout(model, input_resistance_MOhm=1.0 / conductance)


def _parasitic(model: Model, component: str, values: Any) -> Model:
    have = (model.readout or Readout()).input_capacitance_pF
    return _readout(model, input_capacitance_pF=have + values.capacitance_pF)


def _low_pass(model: Model, component: str, values: Any) -> Model:
    own = Filter(values.cutoff_Hz, values.order, quality=values.quality, delay_s=values.delay_s)
    return _physics(model, low_pass=(*model.physics.low_pass, own))


def _saturation(model: Model, component: str, values: Any) -> Model:
    sharpness = np.inf if values.sharpness is None else values.sharpness
    return _physics(model, saturation=(*model.physics.saturation, Saturation(values.limit_V, sharpness)))


def _hum(model: Model, component: str, values: Any) -> Model:
    return _physics(model, hum=(*model.physics.hum, (values.frequency_Hz, values.amplitude_V)))


def _crosstalk(model: Model, component: str, values: Any) -> Model:
    channel = int(component.removeprefix("channel-"))
    return _physics(model, crosstalk={**model.physics.crosstalk, channel: values.coupling})


def _physics(model: Model, **changes: Any) -> Model:
    return replace(model, physics=replace(model.physics, **changes))


def _pyroelectric(model: Model, component: str, values: Any) -> Model:
    return _physics(model, pyroelectric=Pyroelectric(values.temperature_step_K, values.time_constant_s))


def _electrification(model: Model, component: str, values: Any) -> Model:
    return _physics(model, contact_charge_pC=values.charge_pC)


def _viscoelasticity(model: Model, component: str, values: Any) -> Model:
    series = Prony(values.relative_moduli, values.relaxation_times_s)
    on = {component: series} if sum(series.relative_moduli) > 0.0 else {}
    return _physics(model, viscosity={**model.physics.viscosity, **on})


def _softening(model: Model, component: str, values: Any) -> Model:
    law = Softening(values.loss_ratio, values.energy_MPa, values.beta)
    on = {component: law} if law.loss > 0.0 else {}
    return _physics(model, softening={**model.physics.softening, **on})


def _yield(model: Model, component: str, values: Any) -> Model:
    return _physics(model, film_yield=Yield(values.yield_stress_MPa, values.hardening_modulus_MPa))


def _adhesive(model: Model, component: str, values: Any) -> Model:
    normal, shear = values.normal_stiffness_N_per_mm3, values.shear_stiffness_N_per_mm3
    if normal is None:
        normal, shear = layer_stiffness(values.thickness_um, values.youngs_modulus_MPa, values.poisson_ratio)
    return _physics(model, bonds={**model.physics.bonds, component: BondLine(normal, shear)})


def _delamination(model: Model, component: str, values: Any) -> Model:
    if values.diameter_mm == 0.0:
        return model
    patch = Delamination(component, values.center_mm, values.diameter_mm)
    return _physics(model, delaminations=(*model.physics.delaminations, patch))


def _friction(model: Model, component: str, values: Any) -> Model:
    return _physics(model, friction=values.coefficient)


def _rig_compliance(model: Model, component: str, values: Any) -> Model:
    return _physics(model, rig_compliance_mm_per_N=values.compliance_mm_per_N)


def _inertia(model: Model, component: str, values: Any) -> Model:
    return _physics(model, moving_mass_g=values.moving_mass_g)


def _prestretch(model: Model, component: str, values: Any) -> Model:
    return _physics(model, prestretch=(values.strain_x, values.strain_y))


def _sides(model: Model, component: str, values: Any) -> Model:
    changes = {"boundary": "elastic", "side_stiffness_N_per_mm3": values.stiffness_N_per_mm3}
    return replace(model, segment=model.segment.model_copy(update=changes))


def _dot(model: Model, **changes: Any) -> Model:
    return replace(model, dot=model.dot.model_copy(update=changes))


def _offset(model: Model, component: str, values: Any) -> Model:
    x, y = model.dot.offset_mm
    return _dot(model, offset_mm=(x + values.offset_mm[0], y + values.offset_mm[1]))


def _gap(model: Model, component: str, values: Any) -> Model:
    return _dot(model, gap_mm=model.dot.gap_mm + values.gap_mm)


def _reduced(model: Model, component: str, values: Any) -> Model:
    if model.dot.shape == "plate":
        raise ValueError("name = 'dimension-reduction': a plate is the same in both")
    shape, section = ("ridge", "plane-strain") if model.dot.shape == "cap" else ("cap", "solid")
    return _dot(replace(model, segment=model.segment.model_copy(update={"section": section})), shape=shape)


def _stiffening(model: Model, component: str, values: Any) -> Model:
    old = _layer_material(model, component)
    common = {"poisson_ratio": _poisson_ratio(old), "density_kg_m3": old.density_kg_m3}
    c10 = values.c10_MPa if values.c10_MPa is not None else 0.5 * shear_modulus_MPa(old)
    new: Material
    if values.mu_MPa is not None:
        new = Ogden(mu_MPa=values.mu_MPa, alpha=values.alpha, **common)
    elif values.c01_MPa is not None:
        new = MooneyRivlin(c10_MPa=c10, c01_MPa=values.c01_MPa, **common)
    else:
        new = Yeoh(c10_MPa=c10, c20_MPa=values.c20_MPa or 0.0, c30_MPa=values.c30_MPa or 0.0, **common)
    return _layer(model, component, new)


def _foam(model: Model, component: str, values: Any) -> Model:
    density = _layer_material(model, component).density_kg_m3
    new = Hyperfoam(mu_MPa=values.mu_MPa, alpha=values.alpha, poisson_ratio=values.poisson_ratio, density_kg_m3=density)
    return _layer(model, component, new)


def _layer_material(model: Model, component: str) -> Material:
    if component not in model.materials:
        raise ValueError(f"component = '{component}': this segment has none")
    return model.materials[component]


def _layer(model: Model, component: str, material: Material) -> Model:
    return replace(model, materials={**model.materials, component: material})


def _poisson_ratio(material: Material) -> float:
    ratio = material.poisson_ratio
    return ratio[0] if isinstance(ratio, tuple) else ratio


def shear_modulus_MPa(material: Material) -> float:
    """Small-strain shear modulus of a medium."""
    if isinstance(material, NeoHookean | Linear):
        return material.youngs_modulus_MPa / (2.0 * (1.0 + material.poisson_ratio))
    if isinstance(material, MooneyRivlin):
        return 2.0 * (material.c10_MPa + material.c01_MPa)
    if isinstance(material, Yeoh):
        return 2.0 * material.c10_MPa
    if isinstance(material, Ogden):
        return 0.5 * sum(m * a for m, a in zip(material.mu_MPa, material.alpha, strict=True))
    if isinstance(material, Hyperfoam):
        return sum(material.mu_MPa)
    raise ValueError(f"{material.model} is not a medium")


def _property(model: Model, component: str, values: Any) -> Model:
    if component == "dot":
        return _dot(model, **_scaled_dot(model, values.radius_factor, values.height_factor))
    material = _layer_material(model, component)
    changed = material.model_copy(update=_scaled_constants(material, values))
    return _thicker(_layer(model, component, changed), component, values.thickness_factor)


def _scaled_constants(material: Material, values: Any) -> dict[str, Any]:
    """Every modulus times modulus_factor and, of a film, every piezoelectric constant times d31_factor."""
    changes: dict[str, Any] = {}
    for name in type(material).model_fields:
        value = getattr(material, name)
        if name.endswith("_MPa") and name != "yield_stress_MPa" and value is not None:
            factor = values.modulus_factor
            changes[name] = tuple(factor * v for v in value) if isinstance(value, tuple) else factor * value
    if isinstance(material, PiezoelectricFilm):
        for name in ("d31_pC_per_N", "d32_pC_per_N", "d33_pC_per_N"):
            changes[name] = values.d31_factor * getattr(material, name)
    return changes


def _thicker(model: Model, component: str, factor: float) -> Model:
    key = {"film": "thickness_um", "effector": "height_mm"}.get(component, "thickness_mm")
    layer = getattr(model.segment, component)
    changed = layer.model_copy(update={key: factor * getattr(layer, key)})
    return replace(model, segment=model.segment.model_copy(update={component: changed}))


def _scaled_dot(model: Model, radius_factor: float, height_factor: float) -> dict[str, Any]:
    if radius_factor == height_factor == 1.0:
        return {}
    shape = resolve_dot(model.dot, model.segment)
    return {
        "standard": None,
        "base_diameter_mm": None,
        "radius_mm": radius_factor * shape.radius_mm,
        "height_mm": height_factor * shape.height_mm,
    }


Switch = Callable[[Model, str, Any], Model]

SWITCHES: dict[str, Switch] = {
    "charge-leakage": _leakage,
    "parasitic-capacitance": _parasitic,
    "low-pass": _low_pass,
    "saturation": _saturation,
    "mains-hum": _hum,
    "pyroelectric-drift": _pyroelectric,
    "contact-electrification": _electrification,
    "viscoelasticity": _viscoelasticity,
    "hyperelastic-stiffening": _stiffening,
    "foam-densification": _foam,
    "stress-softening": _softening,
    "film-yield": _yield,
    "adhesive-compliance": _adhesive,
    "delamination": _delamination,
    "friction": _friction,
    "elastic-sides": _sides,
    "dot-offset": _offset,
    "contact-gap": _gap,
    "rig-compliance": _rig_compliance,
    "film-prestretch": _prestretch,
    "inertia": _inertia,
    "crosstalk": _crosstalk,
    "property-error": _property,
    "dimension-reduction": _reduced,
}
