"""Mechanisms, components and quantities as a bench engineer calls them."""

from collections.abc import Sequence
from math import ceil, isfinite, log10

from diagnose.findings import Interval, Model
from diagnose.forward import Candidate

WHAT = {
    "charge-leakage": "charge leaks through {}",
    "parasitic-capacitance": "a capacitance across {} takes its share of the charge",
    "low-pass": "{} flattens fast changes",
    "saturation": "{} stops at its limit",
    "mains-hum": "mains hum on {}",
    "pyroelectric-drift": "{} changes its temperature at the touch",
    "contact-electrification": "the touch leaves charge on {}",
    "viscoelasticity": "{} relaxes (viscoelasticity)",
    "hyperelastic-stiffening": "{} stiffens at large strain",
    "foam-densification": "{} is a foam that gives way, then densifies",
    "stress-softening": "{} is softer after it was strained",
    "film-yield": "{} yields",
    "adhesive-compliance": "{} gives way",
    "delamination": "{} is open in part",
    "friction": "{} rubs on the surface",
    "elastic-sides": "{} give way",
    "dot-offset": "{} stands beside its place",
    "contact-gap": "the rig travels before {} touches",
    "rig-compliance": "{} bends beyond the displacement sensor",
    "film-prestretch": "{} was stretched before it was bonded",
    "inertia": "a mass that moves ({}) adds to the force",
    "crosstalk": "other channels leak into {}",
    "property-error": "{} is not as rig.toml says",
    "dimension-reduction": "{} was calculated as a ridge but is round, or the reverse",
}
WHERE = {
    "effector": "the effector",
    "medium1": "medium 1",
    "medium2": "medium 2",
    "film": "the film",
    "readout": "the input",
    "sides": "the held sides",
    "dot": "the dot",
    "rig": "the rig",
    "specimen": "the specimen",
    "bond-effector-medium1": "the bond of effector and medium 1",
    "bond-medium1-film": "the bond of medium 1 and film",
    "bond-film-medium2": "the bond of film and medium 2",
    "bond-base": "the bond to the base",
}
SYMBOLS = {"MOhm": "MΩ", "um": "µm", "N_per_mm3": "N/mm³", "mm_per_N": "mm/N", "1": "", "-": ""}


def component_words(component: str) -> str:
    """medium1 -> medium 1; a name without words of its own stays, without hyphens."""
    return WHERE.get(component, component.replace("-", " "))


def mechanism_words(mechanism: str, component: str) -> str:
    """What happens where, as half a sentence."""
    return WHAT.get(mechanism, mechanism.replace("-", " ") + " of {}").format(component_words(component))


def model_words(model: Model) -> str:
    """All mechanisms of a model, as half a sentence."""
    return " and ".join(mechanism_words(*setting.candidate.name) for setting in model.settings)


def short_name(candidates: Sequence[Candidate]) -> str:
    """mechanism (component), joined by +."""
    return " + ".join(f"{each.mechanism} ({each.component})" for each in candidates)


def quantity_words(name: str, unit: str) -> str:
    """resistance_MOhm -> resistance."""
    return name.removesuffix(f"_{unit}").replace("_", " ") if unit else name.replace("_", " ")


def unit_words(unit: str) -> str:
    """MOhm -> MΩ."""
    return SYMBOLS.get(unit, unit.replace("_per_", "/"))


def interval_words(name: str, interval: Interval) -> str:
    """resistance 0.9 MΩ (0.7 to 1.2), with as many digits as the ends need to differ; what cannot vary has no ends."""
    digits = _digits(interval)
    value = " ".join(part for part in (figure(interval.value, digits), unit_words(interval.unit)) if part)
    words = f"{quantity_words(name, interval.unit)} {value}"
    if interval.low == interval.high:
        return words
    return f"{words} ({figure(interval.low, digits)} to {figure(interval.high, digits)})"


def _digits(interval: Interval) -> int:
    """Of the value, so that half the width of the interval shows."""
    width, size = interval.high - interval.low, max(abs(interval.low), abs(interval.high))
    if not (isfinite(width) and isfinite(size) and width > 0.0):
        return 3
    return min(max(2, ceil(log10(2.0 * size / width)) + 1), 6)


def figure(value: float, digits: int = 2) -> str:
    """A number to be read: significant digits, no exponent between 1e-4 and 1e6, the sign of minus."""
    if not isfinite(value):
        return "∞" if value > 0.0 else "−∞" if value < 0.0 else "unknown"
    if value and not 1e-4 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}".replace("-", "−")
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:.10f}".rstrip("0").rstrip(".").replace("-", "−")


def percent(share: float) -> str:
    """0.026 -> 2.6 %."""
    return f"{figure(100.0 * share)} %"


def listed(words: Sequence[str], last: str = "and") -> str:
    """a, b and c."""
    head, tail = ", ".join(words[:-1]), words[-1] if words else ""
    return f"{head} {last} {tail}" if head else tail
