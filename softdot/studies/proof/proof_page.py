"""The page of a proof: rates with their intervals, by sizes and mechanisms, and those of rivals."""

from collections.abc import Mapping
from typing import Any

from softdot.studies.proof.rates import ABOVE_FLAWS, CLEAR, share

HEAD = {
    "false_names_without_effect": "something named without any effect",
    "clear_named_or_grouped": f"effects of size {CLEAR:g} or more: named, or in a fair group",
    "clear_exact": f"effects of size {CLEAR:g} or more: exactly named",
    "clear_component": f"effects of size {CLEAR:g} or more: component right",
    "clear_right": f"effects of size {CLEAR:g} or more: exactly named, all of it or its main part",
    "clear_right_or_grouped": f"effects of size {CLEAR:g} or more: the same, or in a fair group",
    "clear_wrong": f"effects of size {CLEAR:g} or more: a wrong name at either grade",
    "above_flaws_right": f"effects of {ABOVE_FLAWS:g} times the flaws of the rig or more: right, or in a fair group",
    "above_flaws_wrong": f"effects of {ABOVE_FLAWS:g} times the flaws of the rig or more: a wrong name",
    "below_flaws_right": "smaller effects on rigs with flaws: right, or in a fair group",
    "below_flaws_wrong": "smaller effects on rigs with flaws: a wrong name",
    "names_right": "of all names given, at either grade: right",
    "main_parts_without_effect": "a main part named without any effect",
    "main_parts_of_unknown": "a main part named of what is not among the candidates",
    "abstention_left_out": "mechanism left out of the candidates: nothing named",
    "abstention_outside": "effect outside the list of mechanisms: nothing named",
    "pairs_exact": "two effects at once: both named",
    "ambiguous_told": "designed ambiguity: reported, or nothing named",
    "next_press_narrows": "several explanations as good, proposed press made: fewer are, and the truth is one",
    "next_press_resolves": "the same: only the truth is named",
    "held_out_on_floor": "held-out error within 1.2 times the noise floor, where named exactly",
    "covered": "90 % intervals that contain the true value",
}
OURS, SPARSE = "softdot diagnose", "sparse regression"


def percent(rate: Mapping[str, Any]) -> str:
    """3 of 40, 7.5 % (2.6 to 20)."""
    if not rate["of"]:
        return "no case"
    share, low, high = (f"{round(100.0 * rate[end], 1):g}" for end in ("rate", "low", "high"))
    return f"{rate['count']} of {rate['of']}, {share} % ({low} to {high})"


def text(summary: Mapping[str, Any]) -> str:
    """The whole page of a proof in Markdown, from the content of its summary."""
    rates = summary["rates"]
    ended = ", ".join(f"{count} {status}" for status, count in summary["ended"].items())
    rigs = ", ".join(summary["rigs"])
    what = f"{summary['cases']} cases, seed {summary['seed']}, {rigs}: {ended}."
    lines = ["# Concealed proof", "", f"{what} In brackets: Wilson's 95 % intervals.", "", "| | |", "|---|---|"]
    lines += [f"| {words} | {percent(rates[name])} |" for name, words in HEAD.items()]
    lines += [
        f"| mean size of a fair group | {_figure(rates['mean_group'])} |",
        f"| mean overlap of the places of the excess | {_figure(rates['mean_overlap'])} |",
        "",
    ]
    if rates["by_size"]:
        lines += [*_sizes(rates), "", *_mechanisms(rates), "", "![detection and naming](detection.png)", ""]
    return "\n".join([*lines, *_others(summary), ""])


def _sizes(rates: Mapping[str, Any]) -> list[str]:
    lines = ["| size of the effect | detected | named or fair group | wrong name |", "|---|---|---|---|"]
    for one in rates["by_size"]:
        reach = f"{one['from']:g} to {one['to']:g}" if one["to"] is not None else f"above {one['from']:g}"
        lines.append(f"| {reach} | {percent(one['detected'])} | {percent(one['named'])} | {percent(one['wrong'])} |")
    return lines


def _mechanisms(rates: Mapping[str, Any]) -> list[str]:
    lines = [f"| mechanism | size {CLEAR:g} or more | all sizes |", "|---|---|---|"]
    return lines + [
        f"| {name} | {percent(one['clear'])} | {percent(one['all'])} |" for name, one in rates["by_mechanism"].items()
    ]


def _others(summary: Mapping[str, Any]) -> list[str]:
    rates = summary["rates"]
    unknown = [rates["abstention_left_out"], rates["abstention_outside"]]
    count, of = (sum(one[key] for one in unknown) for key in ("count", "of"))
    ours = share(count, of)
    head = ("", "named without effect", "clear effects exactly named", "unknown effects not named")
    lines = [f"| {' | '.join(head)} |", "|---|---|---|---|"]
    lines.append(
        f"| {OURS} | {percent(rates['false_names_without_effect'])} | {percent(rates['clear_exact'])} | "
        f"{percent(ours)} |"
    )
    for name, one in summary["rivals"].items():
        lines.append(
            f"| {name} | {percent(one['false_names_without_effect'])} | {percent(one['clear_exact'])} | "
            f"{percent(one['unknown_not_named'])} |"
        )
    if SPARSE not in summary["rivals"]:
        lines.append(f"| {SPARSE} | not run: pysindy is not installed | | |")
    return lines


def _figure(value: float | None) -> str:
    return "no case" if value is None else f"{value:.2f}"
