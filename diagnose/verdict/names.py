"""Words for mechanisms, components and quantities as a bench engineer calls them."""

from collections.abc import Sequence
from math import ceil, isfinite, log10

from diagnose.figures import figure
from diagnose.findings import FittedModel, Interval
from diagnose.forward import Candidate, Setting
from diagnose.vocabulary.base import vocabulary
from solve.mechanisms.base import channels_of

COMPONENT_WORDS = {
    "effector": "the effector",
    "medium1": "medium 1",
    "medium2": "medium 2",
    "film": "the film",
    "readout": "the amplifier",
    "sides": "the held sides",
    "dot": "the dot",
    "rig": "the rig",
    "specimen": "the specimen",
    "bond-effector-medium1": "the bond between effector and medium 1",
    "bond-medium1-film": "the bond between medium 1 and film",
    "bond-film-medium2": "the bond between film and medium 2",
    "bond-base": "the bond to the base",
}
MOST_DIGITS = 6
UNIT_SYMBOLS = {"MOhm": "MΩ", "um": "µm", "N_per_mm3": "N/mm³", "mm_per_N": "mm/N", "1": "", "-": ""}


def component_words(component: str) -> str:
    """Words for a component, medium1 -> medium 1; a name without words of its own stays, without hyphens."""
    channels = [f"channel {number}" for number in channels_of(component)]
    return join_words(channels) if channels else COMPONENT_WORDS.get(component, component.replace("-", " "))


def mechanism_words(mechanism: str, component: str) -> str:
    """Half a sentence on what a mechanism does at a component."""
    known = vocabulary().get(mechanism)
    if known is not None and known.words_of_two and len(two := channels_of(component)) > 1:
        return known.words_of_two.format(*(f"channel {number}" for number in two))
    words = mechanism.replace("-", " ") + " of {}" if known is None else known.words
    return words.format(component_words(component))


def setting_words(setting: Setting) -> str:
    """Half a sentence on a mechanism with its values: a law may do the opposite of what it is named for.

    What would be the very same element of the model is told with it.
    """
    mechanism, component = setting.candidate.name
    known = vocabulary().get(mechanism)
    if known is not None and known.below_one is not None:
        ratio, words = known.below_one
        if setting.candidate.derived(setting.values).get(ratio, 1.0) < 1.0:
            return words.format(component_words(component))
    same = [mechanism_words(*name) for name in setting.candidate.identical_to]
    return join_words([mechanism_words(mechanism, component), *same], "or, which is the same here,")


def model_words(model: FittedModel) -> str:
    """Half a sentence on all mechanisms of a model."""
    return join_words([setting_words(setting) for setting in model.settings])


def common_words(explanations: Sequence[Sequence[Setting]]) -> str:
    """Half a sentence that is true of all explanations, each of one or more mechanisms; "" without one.

    It has the mechanisms that several explanations share, and what the others have in common.
    """
    names = [[one.candidate.name for one in explanation] for explanation in explanations]
    first = names[0] if len(names) > 1 else []
    shared = [name for name in first if all(name in others for others in names)]
    rest = _shared_words(
        [one for explanation in explanations for one in explanation if one.candidate.name not in shared]
    )
    return join_words([*(mechanism_words(*name) for name in shared), rest or "something else"]) if shared else rest


def _shared_words(settings: Sequence[Setting]) -> str:
    """Half a sentence that is true of all settings, by their kind, or of several by their component; "" without one."""
    each = [_kinds(one) for one in settings]
    for kind in each[0] if each else ():
        if all(kind in others for others in each):
            return kind
    components = {one.candidate.component for one in settings}
    shared = len(components) == 1 and len(settings) > 1
    return f"{component_words(components.pop())} behaves otherwise than stated" if shared else ""


def _kinds(setting: Setting) -> list[str]:
    known = vocabulary().get(setting.candidate.mechanism)
    return known.kinds(setting) if known is not None else []


def short_name(candidates: Sequence[Candidate]) -> str:
    """Names of candidates as mechanism (component), joined by +."""
    return " + ".join(f"{each.mechanism} ({each.component})" for each in candidates)


def quantity_words(name: str, unit: str) -> str:
    """Words for a parameter without its unit: resistance_MOhm -> resistance, mu_MPa[0] -> mu (term 1)."""
    stem, _, index = name.removesuffix("]").partition("[")
    words = (stem.removesuffix(f"_{_unit_in_names(unit)}") if unit else stem).replace("_", " ")
    return f"{words} (term {int(index) + 1})" if index else words


def unit_words(unit: str) -> str:
    """Symbol of a unit: MOhm -> MΩ."""
    return UNIT_SYMBOLS.get(_unit_in_names(unit), unit.replace("_per_", "/"))


def _unit_in_names(unit: str) -> str:
    """Unit as it ends the name of a parameter: N/mm3 -> N_per_mm3."""
    return unit.replace("/", "_per_")


def interval_words(name: str, interval: Interval) -> str:
    """Words for a parameter: resistance 0.9 MΩ (90 % interval 0.7 to 1.2); what was not fitted has no interval."""
    value, low, high = interval_figures(interval)
    words = " ".join(each for each in (quantity_words(name, interval.unit), value, unit_words(interval.unit)) if each)
    if interval.fixed:
        return words
    remark = interval_remark(interval)
    return f"{words} (90 % interval {low} to {high}{f'; {remark}' if remark else ''})"


def interval_figures(interval: Interval) -> tuple[str, str, str]:
    """Value, low and high end as text, with enough digits to show half the width of the interval."""
    digits = _digits(interval)
    return figure(interval.value, digits), figure(interval.low, digits), figure(interval.high, digits)


def interval_remark(interval: Interval) -> str:
    """Remark on ends of an interval that the recordings do not set; "" where they set both."""
    if interval.fixed:
        return "not fitted"
    value, low, high = interval_figures(interval)
    ends = {"lower": (low, interval.low_searched), "upper": (high, interval.high_searched)}
    searched = [name for name, (_, limited) in ends.items() if limited]
    same = [name for name, (end, limited) in ends.items() if end == value and not limited]
    said = [_ends_words(searched, "a limit of the search, not of the data", "limits of the search, not of the data")]
    said.append(_ends_words(same, *2 * ("the same as the value in the digits shown",)))
    return "; ".join(each for each in said if each)


def _ends_words(which: list[str], one: str, two: str) -> str:
    if not which:
        return ""
    return f"both ends are {two}" if len(which) == 2 else f"the {which[0]} end is {one}"


def _digits(interval: Interval) -> int:
    width, size = interval.high - interval.low, max(abs(interval.low), abs(interval.high))
    if not (isfinite(width) and isfinite(size) and width > 0.0):
        return 3
    return min(max(2, ceil(log10(2.0 * size / width)) + 1), MOST_DIGITS)


def join_words(words: Sequence[str], last: str = "and") -> str:
    """Words joined as a, b and c."""
    head, tail = ", ".join(words[:-1]), words[-1] if words else ""
    return f"{head} {last} {tail}" if head else tail
