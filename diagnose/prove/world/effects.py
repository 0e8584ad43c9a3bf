# ruff: noqa: ARG001 - every change is called alike, also where the bench does not matter
"""The hidden effects: how each changes reality, in a form of its own, at a strength from 0 on.

Strengths are scaled so that 1 is a plain effect and the answer nearly linear below. most : what a real part can have.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnose.prove.world.bench import Bench
from diagnose.prove.world.channels import Stray
from diagnose.prove.world.laws import Damage, Film, Glue, Layer, Made, Spectrum, bulk_modulus, relaxation, shear_modulus
from diagnose.prove.world.noise import Filter
from diagnose.prove.world.reality import Reality, baseline

GLUE_MM = 0.02
BULK_OVER_SHEAR = 29.0 / 3.0  # of a soft compressible glue, whose Poisson's ratio is 0.45
RELAXES_S = 0.4


@dataclass(frozen=True)
class Effect:
    """mechanism, component : as the vocabulary names them; mechanism "" for what it does not know.

    change : (reality, bench, strength) -> reality. truth : (bench, strength) -> true values by name in the verdict.
    form : how the law differs from that of the diagnosis, "" where nature leaves no choice. channels : how many
    electrodes with amplifiers of their own it needs, 0 where it is of all alike.
    """

    name: str
    mechanism: str
    component: str
    change: Callable[[Reality, Bench, float], Reality]
    truth: Callable[[Bench, float], dict[str, float]] = lambda _bench, _s: {}
    most: float = 20.0
    form: str = ""
    channels: int = 0


def _layer(made: Made, name: str, **changes: Any) -> Made:
    layers = [replace(x, **changes) if getattr(x, "name", "film") == name else x for x in made.layers]
    return replace(made, layers=tuple(layers))


def _named(made: Made, name: str) -> Layer | Film:
    found = next(x for x in made.layers if getattr(x, "name", "film") == name)
    assert isinstance(found, Layer | Film)
    return found


def _leak(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, leak_MOhm=_leak_MOhm(bench, s))


def _leak_MOhm(bench: Bench, s: float) -> float:
    return (bench.amplifier.resistance_MOhm or 10_000.0) / s


def _leak_of(channel: int) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        leaks = {**reality.wiring.leak_MOhm, channel: _leak_MOhm(bench, s)}
        return replace(reality, wiring=replace(reality.wiring, leak_MOhm=leaks))

    return change


def _slow_of(channel: int) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        slow = {**reality.wiring.slow, channel: Filter(_corner_Hz(s), 4)}
        return replace(reality, wiring=replace(reality.wiring, slow=slow))

    return change


def _tied(one: int, other: int) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        stray = Stray((one, other), _stray_pF(bench, s))
        return replace(reality, wiring=replace(reality.wiring, strays=(*reality.wiring.strays, stray)))

    return change


def _stray_pF(bench: Bench, s: float) -> float:
    return 0.01 * s * (bench.film_pF / len(bench.voltages) + bench.amplifier.capacitance_pF)


def _parasitic(reality: Reality, bench: Bench, s: float) -> Reality:
    have = reality.amplifier
    return replace(reality, amplifier=replace(have, capacitance_pF=have.capacitance_pF + _extra_pF(bench, s)))


def _extra_pF(bench: Bench, s: float) -> float:
    return 0.1 * s * (bench.film_pF + bench.amplifier.capacitance_pF)


def _slow(reality: Reality, bench: Bench, s: float) -> Reality:
    have = reality.amplifier
    return replace(reality, amplifier=replace(have, filters=(*have.filters, Filter(_corner_Hz(s), 4))))


def _corner_Hz(s: float) -> float:
    return 30.0 / s


def _limit(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, amplifier=replace(reality.amplifier, limit_V=_limit_V(bench, s)))


def _limit_V(bench: Bench, s: float) -> float:
    return bench.peak_V / (0.8 + 0.2 * s)


def _hum(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, amplifier=replace(reality.amplifier, hum_V=0.01 * s * bench.peak_V))


def _warm(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, heat=(0.1 * s, 0.3))


def _touch(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, touch_pC=0.02 * s * bench.peak_V * bench.film_pF)


def _relaxing(name: str) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        return replace(reality, made=_layer(reality.made, name, spectrum=Spectrum(0.1 * s, RELAXES_S)))

    return change


def _relaxed(_bench: Bench, s: float) -> dict[str, float]:
    """1 - G(10 s) / G(0.1 s)."""
    early, late = relaxation(Spectrum(0.1 * s, RELAXES_S), np.array([0.1, 10.0]))
    return {"relaxed_fraction": float(1.0 - late / early)}


def _softening(name: str) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        energy = 0.01 * _named(reality.made, name).modulus_MPa
        return replace(reality, made=_layer(reality.made, name, damage=Damage(0.1 * s, energy)))

    return change


def _stiffening(name: str) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        return replace(reality, made=_layer(reality.made, name, gent_limit=GENT / s))

    return change


GENT = 4.0


def _glued(medium: str) -> Callable[[Reality, Bench, float], Reality]:
    """Glue in the place of the medium's skin beside the film, in series with what that skin gives way itself."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        skin = _named(reality.made, medium)
        added = 0.01 * s / GLUE_MM  # of shear, 1/MPa
        shear = 1.0 / (1.0 / shear_modulus(skin) + added)
        bulk = 1.0 / (1.0 / bulk_modulus(skin) + added / BULK_OVER_SHEAR)
        glue = Glue(GLUE_MM, 9.0 * bulk * shear / (3.0 * bulk + shear), 0.5 - 1.5 * shear / (3.0 * bulk + shear))
        layers = list(_layer(reality.made, medium, thickness_mm=skin.thickness_mm - GLUE_MM).layers)
        place = next(n for n, x in enumerate(layers) if isinstance(x, Film)) + (medium == "medium1")
        return replace(reality, made=replace(reality.made, layers=(*layers[:place], glue, *layers[place:])))

    return change


def _factor(name: str, quantity: str, per_s: float) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        layer, factor = _named(reality.made, name), 1.0 + per_s * s
        return replace(reality, made=_layer(reality.made, name, **{quantity: factor * getattr(layer, quantity)}))

    return change


def _foamed(name: str) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        return replace(reality, made=_layer(reality.made, name, poisson_ratio=_poisson_ratio(s)))

    return change


def _poisson_ratio(s: float) -> float:
    return 0.495 - 0.03 * s


def _weak_film(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, sensitivity=1.0 - 0.02 * s)


def _sides(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, made=replace(reality.made, spring_N_per_mm3=200.0 / s))


def _loosened(reality: Reality, bench: Bench, s: float) -> Reality:
    """The base comes off from the rims inwards."""
    return replace(reality, made=replace(reality.made, loose_from_mm=0.5 * _bonded_mm(bench, s)))


def _bonded_mm(bench: Bench, s: float) -> float:
    return bench.made.length_mm * (1.0 - 0.05 * s)


def _loosened_side(reality: Reality, bench: Bench, s: float) -> Reality:
    """The base comes off from its right rim inwards."""
    loosened = _loosened(reality, bench, s)
    return replace(loosened, made=replace(loosened.made, one_sided=True))


def _offset(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, made=replace(reality.made, offset_mm=0.1 * s**0.5))


def _stretched(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, made=_layer(reality.made, "film", prestretch=1e-3 * s))


def _yielding(reality: Reality, bench: Bench, s: float) -> Reality:
    film = _layer(reality.made, "film", yield_MPa=_yield_MPa(s), hardening_MPa=HARDENS_MPA)
    return replace(reality, made=film)


def _yield_MPa(s: float) -> float:
    return 55.0 / (1.0 + 0.1 * s)


HARDENS_MPA = 40.0  # a fiftieth of the film's modulus


def _round(reality: Reality, bench: Bench, s: float) -> Reality:
    """A dot where a ridge is believed; there is no half of it."""
    return replace(reality, made=replace(reality.made, dot="cap"))


def _field(name: str, scale: float) -> Callable[[Reality, Bench, float], Reality]:
    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        values: dict[str, Any] = {name: scale * s}
        return replace(reality, **values)

    return change


def _pickup(reality: Reality, bench: Bench, s: float) -> Reality:
    return replace(reality, pickup=0.002 * s * bench.peak_V)


def _is(name: str, scale: float, start: float = 0.0) -> Callable[[Bench, float], dict[str, float]]:
    return lambda _bench, s: {name: start + scale * s}


def _crosstalk(one: int, other: int) -> Effect:
    """Between two channels, numbered from 1."""
    return Effect(
        f"crosstalk-{one}-{other}",
        "crosstalk",
        f"channel-{one}-channel-{other}",
        _tied(one - 1, other - 1),
        lambda b, s: {"capacitance_pF": _stray_pF(b, s)},
        60.0,
        form="behind a resistance where a capacitance alone is fitted",
        channels=max(one, other),
    )


BESSEL_FORM = "Bessel of order four where order two is fitted"
FRACTIONAL_FORM = "fractional Zener where Prony is fitted"
FOAM_FORM = "compressible neo-Hooke where a hyperfoam is fitted"
GENT_FORM, TANH_FORM = "Gent where Yeoh is fitted", "Dorfmann-Ogden where Ogden-Roxburgh is fitted"
FILM_BOND, UPPER_BOND = "bond-film-medium2", "bond-medium1-film"
LISTED = (
    Effect("leakage", "charge-leakage", "readout", _leak, lambda b, s: {"resistance_MOhm": _leak_MOhm(b, s)}),
    Effect("low-pass", "low-pass", "readout", _slow, form=BESSEL_FORM, most=8.0),
    Effect("relaxing-medium2", "viscoelasticity", "medium2", _relaxing("medium2"), _relaxed, 5.0, FRACTIONAL_FORM),
    Effect("gap", "contact-gap", "dot", _field("gap_mm", 0.004), _is("gap_mm", 0.004), 15.0),
    Effect(
        "soft-rig",
        "rig-compliance",
        "rig",
        _field("compliance_mm_per_N", 5e-4),
        _is("compliance_mm_per_N", 5e-4),
        40.0,
    ),
    Effect("glue-below", "adhesive-compliance", FILM_BOND, _glued("medium2"), form="resolved glue", most=50.0),
    Effect(
        "stiffening-medium1", "hyperelastic-stiffening", "medium1", _stiffening("medium1"), form=GENT_FORM, most=8.0
    ),
    Effect(
        "modulus-medium2",
        "property-error",
        "medium2",
        _factor("medium2", "modulus_MPa", 0.05),
        _is("modulus_factor", 0.05, 1.0),
    ),
    Effect("weak-film", "property-error", "film", _weak_film, _is("d31_factor", -0.02, 1.0), 30.0),
    Effect(
        "cable",
        "parasitic-capacitance",
        "readout",
        _parasitic,
        lambda b, s: {"capacitance_pF": _extra_pF(b, s)},
        40.0,
    ),
    Effect("elastic-case", "elastic-sides", "sides", _sides, lambda _b, s: {"stiffness_N_per_mm3": 200.0 / s}, 40.0),
    Effect("beside", "dot-offset", "dot", _offset, most=16.0),
    Effect("hum", "mains-hum", "readout", _hum, form="off its frequency, with a harmonic", most=30.0),
    Effect("warm", "pyroelectric-drift", "film", _warm, form="diffusion where an exponential is fitted", most=50.0),
    Effect("clipped", "saturation", "readout", _limit, form="another soft knee", most=10.0),
    Effect(
        "stiffening-effector", "hyperelastic-stiffening", "effector", _stiffening("effector"), form=GENT_FORM, most=4.0
    ),
    Effect("softened-medium2", "stress-softening", "medium2", _softening("medium2"), form=TANH_FORM, most=5.0),
    Effect("relaxing-medium1", "viscoelasticity", "medium1", _relaxing("medium1"), _relaxed, 5.0, FRACTIONAL_FORM),
    Effect("charged", "contact-electrification", "film", _touch, form="power of the area", most=30.0),
    Effect("stretched", "film-prestretch", "film", _stretched, _is("strain_x", 1e-3), 10.0),
    Effect("glue-above", "adhesive-compliance", UPPER_BOND, _glued("medium1"), form="resolved glue", most=50.0),
    Effect(
        "modulus-effector",
        "property-error",
        "effector",
        _factor("effector", "modulus_MPa", -0.04),
        _is("modulus_factor", -0.04, 1.0),
        15.0,
    ),
    Effect(
        "foam-medium2",
        "foam-densification",
        "medium2",
        _foamed("medium2"),
        lambda _b, s: {"poisson_ratio": _poisson_ratio(s)},
        15.0,
        FOAM_FORM,
    ),
    Effect(
        "loose-base",
        "delamination",
        "bond-base",
        _loosened,
        lambda b, s: {"bonded_diameter_mm": _bonded_mm(b, s)},
        16.0,
        "a floor that pushes as a stiff wall",
    ),
    Effect("mass", "inertia", "rig", _field("mass_g", 200.0), _is("moving_mass_g", 200.0), 20.0),
    *(_crosstalk(one, other) for one, other in ((1, 2), (2, 3), (1, 3))),
    Effect(
        "leakage-2",
        "charge-leakage",
        "channel-2",
        _leak_of(1),
        lambda b, s: {"resistance_MOhm": _leak_MOhm(b, s)},
        channels=2,
    ),
    Effect("low-pass-3", "low-pass", "channel-3", _slow_of(2), form=BESSEL_FORM, most=8.0, channels=3),
    Effect(
        "guide",
        "guide-friction",
        "rig",
        _field("guide_N", 0.02),
        _is("sliding_friction_N", 0.02),
        50.0,
        "Dahl's law where sliders are fitted",
    ),
    Effect(
        "yielding",
        "film-yield",
        "film",
        _yielding,
        lambda _b, s: {"yield_stress_MPa": _yield_MPa(s)},
        12.0,
        "hardens where a film without hardening is fitted",
    ),
    Effect("round", "dimension-reduction", "dot", _round),
    Effect(
        "loose-side",
        "delamination",
        "bond-base",
        _loosened_side,
        most=16.0,
        form="on one side where a rim all around is fitted",
    ),
    Effect("fatigue", "", "film", _field("fatigue", 0.01), most=30.0),
    Effect("warm-gain", "", "readout", _field("drift", 0.05), most=20.0),
    Effect("clock-jump", "", "readout", _field("jump_s", 0.004), most=20.0),
    Effect("pick-up", "", "readout", _pickup, most=30.0),
)
EFFECTS: Mapping[str, Effect] = {effect.name: effect for effect in LISTED}
KNOWN = tuple(effect.name for effect in EFFECTS.values() if effect.mechanism)
UNKNOWN = tuple(effect.name for effect in EFFECTS.values() if not effect.mechanism)
STAGED = 8
"""The first so many of the known ones come first."""


def applied(reality: Reality, bench: Bench, strengths: Mapping[str, float]) -> Reality:
    """Reality with these effects, name -> strength, in order."""
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
