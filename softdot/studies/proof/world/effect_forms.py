# ruff: noqa: ARG001 - every change is called alike, also where the bench does not matter
"""The form of each hidden effect: how reality changes with its strength."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from softdot.studies.proof.world.amplifier import Filter
from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.channels import Stray
from softdot.studies.proof.world.laws import bulk_modulus, shear_modulus
from softdot.studies.proof.world.made import Damage, Film, Glue, Layer, Made, Spectrum
from softdot.studies.proof.world.memory_laws import relaxation
from softdot.studies.proof.world.reality import Reality

GLUE_MM = 0.02
BULK_OVER_SHEAR = 29.0 / 3.0  # of a soft compressible glue, whose Poisson's ratio is 0.45
RELAXES_S = 0.4


@dataclass(frozen=True)
class Effect:
    """An effect that can be hidden. mechanism, component : as the vocabulary names them; mechanism "" for what it does
    not know.

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


def _layer_named(made: Made, name: str) -> Layer | Film:
    found = next(x for x in made.layers if getattr(x, "name", "film") == name)
    assert isinstance(found, Layer | Film)
    return found


def leaking_input(reality: Reality, bench: Bench, s: float) -> Reality:
    """A resistance parallel to the input."""
    return replace(reality, leak_MOhm=leak_MOhm(bench, s))


def leak_MOhm(bench: Bench, s: float) -> float:
    """Resistance of a leak, MOhm."""
    return (bench.amplifier.resistance_MOhm or 10_000.0) / s


def leaking_channel(channel: int) -> Callable[[Reality, Bench, float], Reality]:
    """A leak at one channel, numbered from 0."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        leaks = {**reality.wiring.leak_MOhm, channel: leak_MOhm(bench, s)}
        return replace(reality, wiring=replace(reality.wiring, leak_MOhm=leaks))

    return change


def slow_channel(channel: int) -> Callable[[Reality, Bench, float], Reality]:
    """A slow filter in one channel, numbered from 0."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        slow = {**reality.wiring.slow, channel: Filter(_corner_Hz(s), 4)}
        return replace(reality, wiring=replace(reality.wiring, slow=slow))

    return change


def _tie_inputs(one: int, other: int) -> Callable[[Reality, Bench, float], Reality]:
    """Change of a reality that ties two inputs by a stray capacitance."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        stray = Stray((one, other), _stray_pF(bench, s))
        return replace(reality, wiring=replace(reality.wiring, strays=(*reality.wiring.strays, stray)))

    return change


def _stray_pF(bench: Bench, s: float) -> float:
    return 0.01 * s * (bench.film_pF / len(bench.voltages) + bench.amplifier.capacitance_pF)


def parallel_capacitance(reality: Reality, bench: Bench, s: float) -> Reality:
    """A capacitance parallel to the input."""
    have = reality.amplifier
    return replace(reality, amplifier=replace(have, capacitance_pF=have.capacitance_pF + extra_pF(bench, s)))


def extra_pF(bench: Bench, s: float) -> float:
    """Capacitance parallel to the input, pF."""
    return 0.1 * s * (bench.film_pF + bench.amplifier.capacitance_pF)


def slow_amplifier(reality: Reality, bench: Bench, s: float) -> Reality:
    """A slow filter behind the others of the amplifier."""
    have = reality.amplifier
    return replace(reality, amplifier=replace(have, filters=(*have.filters, Filter(_corner_Hz(s), 4))))


def _corner_Hz(s: float) -> float:
    return 30.0 / s


def clipping_amplifier(reality: Reality, bench: Bench, s: float) -> Reality:
    """An amplifier that clips softly."""
    return replace(reality, amplifier=replace(reality.amplifier, limit_V=_limit_V(bench, s)))


def _limit_V(bench: Bench, s: float) -> float:
    return bench.peak_V / (0.8 + 0.2 * s)


def humming_input(reality: Reality, bench: Bench, s: float) -> Reality:
    """Mains hum at the input."""
    return replace(reality, amplifier=replace(reality.amplifier, hum_V=0.01 * s * bench.peak_V))


def warming_film(reality: Reality, bench: Bench, s: float) -> Reality:
    """A film that warms from the first touch on."""
    return replace(reality, heat=(0.1 * s, 0.3))


def charge_of_touch(reality: Reality, bench: Bench, s: float) -> Reality:
    """Charge that comes with the touched area."""
    return replace(reality, touch_pC=0.02 * s * bench.peak_V * bench.film_pF)


def relaxing_layer(name: str) -> Callable[[Reality, Bench, float], Reality]:
    """A layer that relaxes by a fractional spectrum."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        return replace(reality, made=_layer(reality.made, name, spectrum=Spectrum(0.1 * s, RELAXES_S)))

    return change


def relaxed_fraction(_bench: Bench, s: float) -> dict[str, float]:
    """1 - G(10 s) / G(0.1 s)."""
    early, late = relaxation(Spectrum(0.1 * s, RELAXES_S), np.array([0.1, 10.0]))
    return {"relaxed_fraction": float(1.0 - late / early)}


def softening_layer(name: str) -> Callable[[Reality, Bench, float], Reality]:
    """A layer that softens after the largest energy."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        energy = 0.01 * _layer_named(reality.made, name).modulus_MPa
        return replace(reality, made=_layer(reality.made, name, damage=Damage(0.1 * s, energy)))

    return change


def stiffening_layer(name: str) -> Callable[[Reality, Bench, float], Reality]:
    """A layer of Gent's law."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        return replace(reality, made=_layer(reality.made, name, gent_limit=GENT / s))

    return change


GENT = 4.0


def glued_film(medium: str) -> Callable[[Reality, Bench, float], Reality]:
    """Glue in the place of the medium's skin beside the film, in series with what that skin gives way itself."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        skin = _layer_named(reality.made, medium)
        added = 0.01 * s / GLUE_MM  # of shear, 1/MPa
        shear = 1.0 / (1.0 / shear_modulus(skin) + added)
        bulk = 1.0 / (1.0 / bulk_modulus(skin) + added / BULK_OVER_SHEAR)
        glue = Glue(GLUE_MM, 9.0 * bulk * shear / (3.0 * bulk + shear), 0.5 - 1.5 * shear / (3.0 * bulk + shear))
        layers = list(_layer(reality.made, medium, thickness_mm=skin.thickness_mm - GLUE_MM).layers)
        place = next(n for n, x in enumerate(layers) if isinstance(x, Film)) + (medium == "medium1")
        return replace(reality, made=replace(reality.made, layers=(*layers[:place], glue, *layers[place:])))

    return change


def scaled_quantity(name: str, quantity: str, per_s: float) -> Callable[[Reality, Bench, float], Reality]:
    """A quantity of a layer that is 1 + per_s s times as large."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        layer, factor = _layer_named(reality.made, name), 1.0 + per_s * s
        return replace(reality, made=_layer(reality.made, name, **{quantity: factor * getattr(layer, quantity)}))

    return change


def foamed_layer(name: str) -> Callable[[Reality, Bench, float], Reality]:
    """A layer that is compressible."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        return replace(reality, made=_layer(reality.made, name, poisson_ratio=poisson_ratio_of_foam(s)))

    return change


def poisson_ratio_of_foam(s: float) -> float:
    """Poisson's ratio of a layer that is a foam."""
    return 0.495 - 0.03 * s


def weak_film(reality: Reality, bench: Bench, s: float) -> Reality:
    """A film of less charge."""
    return replace(reality, sensitivity=1.0 - 0.02 * s)


def springy_sides(reality: Reality, bench: Bench, s: float) -> Reality:
    """Sides that springs hold."""
    return replace(reality, made=replace(reality.made, spring_N_per_mm3=200.0 / s))


def loosened_base(reality: Reality, bench: Bench, s: float) -> Reality:
    """The base comes off from the rims inwards."""
    return replace(reality, made=replace(reality.made, loose_from_mm=0.5 * bonded_mm(bench, s)))


def bonded_mm(bench: Bench, s: float) -> float:
    """Length of the base that is still bonded, mm."""
    return bench.made.length_mm * (1.0 - 0.05 * s)


def loosened_on_one_side(reality: Reality, bench: Bench, s: float) -> Reality:
    """The base comes off from its right rim inwards."""
    loosened = loosened_base(reality, bench, s)
    return replace(loosened, made=replace(loosened.made, one_sided=True))


def offset_dot(reality: Reality, bench: Bench, s: float) -> Reality:
    """A dot beside the middle."""
    return replace(reality, made=replace(reality.made, offset_mm=0.1 * s**0.5))


def stretched_film(reality: Reality, bench: Bench, s: float) -> Reality:
    """A film that was stretched before it was bonded."""
    return replace(reality, made=_layer(reality.made, "film", prestretch=1e-3 * s))


def yielding_film(reality: Reality, bench: Bench, s: float) -> Reality:
    """A film that yields."""
    film = _layer(reality.made, "film", yield_MPa=yield_stress_MPa(s), hardening_MPa=HARDENS_MPA)
    return replace(reality, made=film)


def yield_stress_MPa(s: float) -> float:
    """Yield stress of the film, MPa."""
    return 55.0 / (1.0 + 0.1 * s)


HARDENS_MPA = 40.0  # a fiftieth of the film's modulus


def round_dot(reality: Reality, bench: Bench, s: float) -> Reality:
    """A dot where a ridge is believed; there is no half of it."""
    return replace(reality, made=replace(reality.made, dot="cap"))


def growing_field(name: str, scale: float) -> Callable[[Reality, Bench, float], Reality]:
    """A field of the reality that grows with the strength."""

    def change(reality: Reality, bench: Bench, s: float) -> Reality:
        values: dict[str, Any] = {name: scale * s}
        return replace(reality, **values)

    return change


def picked_up_voltage(reality: Reality, bench: Bench, s: float) -> Reality:
    """A voltage that is picked up while the dot moves."""
    return replace(reality, pickup=0.002 * s * bench.peak_V)


def growing_value(name: str, scale: float, start: float = 0.0) -> Callable[[Bench, float], dict[str, float]]:
    """The true value of a parameter that grows with the strength."""
    return lambda _bench, s: {name: start + scale * s}


def crosstalk_of_pair(one: int, other: int) -> Effect:
    """Effects of a stray capacitance between two channels, numbered from 1."""
    return Effect(
        f"crosstalk-{one}-{other}",
        "crosstalk",
        f"channel-{one}-channel-{other}",
        _tie_inputs(one - 1, other - 1),
        lambda b, s: {"capacitance_pF": _stray_pF(b, s)},
        60.0,
        form="behind a resistance where a capacitance alone is fitted",
        channels=max(one, other),
    )
