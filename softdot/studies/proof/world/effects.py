"""The hidden effects: how each changes reality, in a form of its own, at a strength from 0 on.

Strengths are scaled so that 1 is a plain effect and the answer nearly linear below; the most of an effect is what a
real part can have.
"""

from collections.abc import Mapping

from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.effect_forms import (
    Effect,
    bonded_mm,
    charge_of_touch,
    clipping_amplifier,
    crosstalk_of_pair,
    extra_pF,
    foamed_layer,
    glued_film,
    growing_field,
    growing_value,
    humming_input,
    leak_MOhm,
    leaking_channel,
    leaking_input,
    loosened_base,
    loosened_on_one_side,
    offset_dot,
    parallel_capacitance,
    picked_up_voltage,
    poisson_ratio_of_foam,
    relaxed_fraction,
    relaxing_layer,
    round_dot,
    scaled_quantity,
    slow_amplifier,
    slow_channel,
    softening_layer,
    springy_sides,
    stiffening_layer,
    stretched_film,
    warming_film,
    weak_film,
    yield_stress_MPa,
    yielding_film,
)
from softdot.studies.proof.world.made import Film, Layer
from softdot.studies.proof.world.reality import Reality, baseline

BESSEL_FORM = "Bessel of order four where order two is fitted"
FRACTIONAL_FORM = "fractional Zener where Prony is fitted"
FOAM_FORM = "compressible neo-Hooke where a hyperfoam is fitted"
GENT_FORM, TANH_FORM = "Gent where Yeoh is fitted", "Dorfmann-Ogden where Ogden-Roxburgh is fitted"
FILM_BOND, UPPER_BOND = "bond-film-medium2", "bond-medium1-film"
LISTED = (
    Effect("leakage", "charge-leakage", "readout", leaking_input, lambda b, s: {"resistance_MOhm": leak_MOhm(b, s)}),
    Effect("low-pass", "low-pass", "readout", slow_amplifier, form=BESSEL_FORM, most=8.0),
    Effect(
        "relaxing-medium2",
        "viscoelasticity",
        "medium2",
        relaxing_layer("medium2"),
        relaxed_fraction,
        5.0,
        FRACTIONAL_FORM,
    ),
    Effect("gap", "contact-gap", "dot", growing_field("gap_mm", 0.004), growing_value("gap_mm", 0.004), 15.0),
    Effect(
        "soft-rig",
        "rig-compliance",
        "rig",
        growing_field("compliance_mm_per_N", 5e-4),
        growing_value("compliance_mm_per_N", 5e-4),
        40.0,
    ),
    Effect("glue-below", "adhesive-compliance", FILM_BOND, glued_film("medium2"), form="resolved glue", most=50.0),
    Effect(
        "stiffening-medium1",
        "hyperelastic-stiffening",
        "medium1",
        stiffening_layer("medium1"),
        form=GENT_FORM,
        most=8.0,
    ),
    Effect(
        "modulus-medium2",
        "property-error",
        "medium2",
        scaled_quantity("medium2", "modulus_MPa", 0.05),
        growing_value("modulus_factor", 0.05, 1.0),
    ),
    Effect("weak-film", "property-error", "film", weak_film, growing_value("d31_factor", -0.02, 1.0), 30.0),
    Effect(
        "cable",
        "parasitic-capacitance",
        "readout",
        parallel_capacitance,
        lambda b, s: {"capacitance_pF": extra_pF(b, s)},
        40.0,
    ),
    Effect(
        "elastic-case", "elastic-sides", "sides", springy_sides, lambda _b, s: {"stiffness_N_per_mm3": 200.0 / s}, 40.0
    ),
    Effect("beside", "dot-offset", "dot", offset_dot, most=16.0),
    Effect("hum", "mains-hum", "readout", humming_input, form="off its frequency, with a harmonic", most=30.0),
    Effect(
        "warm", "pyroelectric-drift", "film", warming_film, form="diffusion where an exponential is fitted", most=50.0
    ),
    Effect("clipped", "saturation", "readout", clipping_amplifier, form="another soft knee", most=10.0),
    Effect(
        "stiffening-effector",
        "hyperelastic-stiffening",
        "effector",
        stiffening_layer("effector"),
        form=GENT_FORM,
        most=4.0,
    ),
    Effect("softened-medium2", "stress-softening", "medium2", softening_layer("medium2"), form=TANH_FORM, most=5.0),
    Effect(
        "relaxing-medium1",
        "viscoelasticity",
        "medium1",
        relaxing_layer("medium1"),
        relaxed_fraction,
        5.0,
        FRACTIONAL_FORM,
    ),
    Effect("charged", "contact-electrification", "film", charge_of_touch, form="power of the area", most=30.0),
    Effect("stretched", "film-prestretch", "film", stretched_film, growing_value("strain_x", 1e-3), 10.0),
    Effect("glue-above", "adhesive-compliance", UPPER_BOND, glued_film("medium1"), form="resolved glue", most=50.0),
    Effect(
        "modulus-effector",
        "property-error",
        "effector",
        scaled_quantity("effector", "modulus_MPa", -0.04),
        growing_value("modulus_factor", -0.04, 1.0),
        15.0,
    ),
    Effect(
        "foam-medium2",
        "foam-densification",
        "medium2",
        foamed_layer("medium2"),
        lambda _b, s: {"poisson_ratio": poisson_ratio_of_foam(s)},
        15.0,
        FOAM_FORM,
    ),
    Effect(
        "loose-base",
        "delamination",
        "bond-base",
        loosened_base,
        lambda b, s: {"bonded_diameter_mm": bonded_mm(b, s)},
        16.0,
        "a floor that pushes as a stiff wall",
    ),
    Effect("mass", "inertia", "rig", growing_field("mass_g", 200.0), growing_value("moving_mass_g", 200.0), 20.0),
    *(crosstalk_of_pair(one, other) for one, other in ((1, 2), (2, 3), (1, 3))),
    Effect(
        "leakage-2",
        "charge-leakage",
        "channel-2",
        leaking_channel(1),
        lambda b, s: {"resistance_MOhm": leak_MOhm(b, s)},
        channels=2,
    ),
    Effect("low-pass-3", "low-pass", "channel-3", slow_channel(2), form=BESSEL_FORM, most=8.0, channels=3),
    Effect(
        "guide",
        "guide-friction",
        "rig",
        growing_field("guide_N", 0.02),
        growing_value("sliding_friction_N", 0.02),
        50.0,
        "Dahl's law where sliders are fitted",
    ),
    Effect(
        "yielding",
        "film-yield",
        "film",
        yielding_film,
        lambda _b, s: {"yield_stress_MPa": yield_stress_MPa(s)},
        12.0,
        "hardens where a film without hardening is fitted",
    ),
    Effect("round", "dimension-reduction", "dot", round_dot),
    Effect(
        "loose-side",
        "delamination",
        "bond-base",
        loosened_on_one_side,
        most=16.0,
        form="on one side where a rim all around is fitted",
    ),
    Effect("fatigue", "", "film", growing_field("fatigue", 0.01), most=30.0),
    Effect("warm-gain", "", "readout", growing_field("drift", 0.05), most=20.0),
    Effect("clock-jump", "", "readout", growing_field("jump_s", 0.004), most=20.0),
    Effect("pick-up", "", "readout", picked_up_voltage, most=30.0),
)
EFFECTS: Mapping[str, Effect] = {effect.name: effect for effect in LISTED}
KNOWN = tuple(effect.name for effect in EFFECTS.values() if effect.mechanism)
UNKNOWN = tuple(effect.name for effect in EFFECTS.values() if not effect.mechanism)
STAGED = 8
"""Number of the known effects that come first."""


def apply_effects(reality: Reality, bench: Bench, strengths: Mapping[str, float]) -> Reality:
    """The reality with these effects, name -> strength, in order."""
    for name, strength in strengths.items():
        if strength > 0.0:
            reality = EFFECTS[name].change(reality, bench, strength)
    return reality


def fits(name: str, bench: Bench) -> bool:
    """Whether a bench can have an effect, and its presses are solved in reasonable time: in 3D only those it has."""
    held = any(isinstance(layer, Layer | Film) and layer.held for layer in bench.made.layers)
    if name in ("elastic-case", "stretched") and not held:
        return False
    if name == "round" and (bench.made.dot != "ridge" or bench.made.electrodes):
        return False
    if name == "leakage" and bench.amplifier.resistance_MOhm is None:
        return False
    if EFFECTS[name].channels > len(bench.made.electrodes):
        return False
    belief = baseline(bench)
    return bench.made.dot == "ridge" or EFFECTS[name].change(belief, bench, 1.0).made == bench.made
