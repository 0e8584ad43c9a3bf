"""The folder of a proof: commitments before, records after; at the end the table of rates and detection.png."""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from diagnose.prove.score import ABOVE_FLAWS, ALIKE, CLEAR, share
from diagnose.prove.score import rate as counted
from diagnose.prove.trial import verified
from diagnose.prove.world.cases import LEFT_OUT, NONE, OUTSIDE, SINGLE, SIZES, Case
from geometry.cache import read_checked, write_checked
from softdot.json_files import plain, write_json
from softdot.output import Product, check_output

FORMAT = "softdot-proof/1"
COMMITMENTS, CASES, TABLE, CURVE = "commitments", "cases", "proof.md", "detection.png"
PROOF = Product(FORMAT, "proof.json", frozenset({"proof.json", ".proof.json.part", COMMITMENTS, CASES, TABLE, CURVE}))
"""With what a proof leaves that was killed while it wrote."""


def check(out: Path) -> Path:
    """The folder, which may be missing yet or hold an earlier proof. InputError."""
    return check_output(out, PROOF)


def begin(place: Path) -> None:
    """Make the folder where it is missing; an earlier proof in it stays."""
    place.mkdir(parents=True, exist_ok=True)
    if not (place / PROOF.summary).exists():  # first of all: it tells whose folder this is
        write_json(place / PROOF.summary, {"format": FORMAT, "complete": False})
    for name in (COMMITMENTS, CASES):
        (place / name).mkdir(exist_ok=True)


def commit(place: Path, name: str, digest: str) -> None:
    """Publish a digest. An earlier one, of a case that was stopped, is replaced together with its record."""
    (place / CASES / f"{name}.json").unlink(missing_ok=True)
    write_json(place / COMMITMENTS / f"{name}.json", {"recording": name, "sha256": digest})


def keep(place: Path, name: str, record: dict[str, Any]) -> None:
    """Write a record, whole or not at all; its truth to the last digit, since the digest is of that."""
    write_checked(place / CASES / f"{name}.json", {**plain(record), "truth": record["truth"]})


def kept(place: Path, case: Case, program: str) -> dict[str, Any] | None:
    """The record of an earlier proof of the same case by the same program, whose commitment it fulfils; else None."""
    record = read_checked(place / CASES / f"{case.name}.json", "the case is made again")
    if record is None:
        return None
    with suppress(OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        committed = json.loads((place / COMMITMENTS / f"{case.name}.json").read_text("utf-8"))["sha256"]
        same = Case(**{**record["case"], "effects": tuple(record["case"]["effects"])}) == case
        ended = record["program"] == program and record["status"] == "scored"
        if same and ended and verified(record["truth"], record["salt"], committed):
            return record
    return None


def records(place: Path) -> Iterator[dict[str, Any]]:
    """All that are there, in order; a damaged one of an earlier proof is left out with a warning."""
    for path in sorted((place / CASES).glob("case-*.json")):
        record = read_checked(path, "is left out of the table")
        if record is not None:
            yield record


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


def rival_rates(records: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Of every rival: false names without effect, clear effects named, unknown ones left unnamed, held-out error."""
    scored = [record for record in records if record["score"] is not None]
    names = sorted({name for record in scored for name in record["rivals"]})
    return {name: _of_rival(name, scored) for name in names}


def _of_rival(name: str, records: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    asked = [r for r in records if name in r["rivals"]]

    def rate(kinds: tuple[str, ...], least: float, holds: Any) -> dict[str, Any]:
        inside = [r for r in asked if r["truth"]["kind"] in kinds and r["truth"]["whitened_rms"] >= least]
        return counted(inside, lambda r: holds(r["rivals"][name], r))

    clear = [
        r["rivals"][name]["after"]
        for r in asked
        if r["truth"]["kind"] == SINGLE and r["truth"]["whitened_rms"] >= CLEAR
    ]
    return {
        "false_names_without_effect": rate((NONE,), 0.0, lambda o, _: o["named"] is not None),
        "clear_exact": rate((SINGLE,), CLEAR, lambda o, r: _is(o["named"], r)),
        "unknown_not_named": rate((LEFT_OUT, OUTSIDE), 0.0, lambda o, _: o["named"] is None),
        "held_out_over_noise": sorted(clear)[len(clear) // 2] if clear else None,
    }


def _is(named: Any, record: Mapping[str, Any]) -> bool:
    true = [(one["mechanism"], one["component"]) for one in record["truth"]["mechanisms"]]
    return named is not None and true == [ALIKE.get(tuple(named), tuple(named))]


def percent(rate: Mapping[str, Any]) -> str:
    """3 of 40, 7.5 % (2.6 to 20)."""
    if not rate["of"]:
        return "no case"
    share, low, high = (f"{round(100.0 * rate[end], 1):g}" for end in ("rate", "low", "high"))
    return f"{rate['count']} of {rate['of']}, {share} % ({low} to {high})"


def text(summary: Mapping[str, Any]) -> str:
    """The whole page."""
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


CURVES = (
    ("detected", "detected", "#7a7a7a"),
    ("named", "named, or in a fair group", "#0a5c8a"),
    ("wrong", "wrongly named", "#b3412e"),
)


def draw(by_size: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Rates with Wilson's intervals, one point for each bin of sizes."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 3.8), layout="constrained")
    axes = figure.subplots()
    for shift, (key, words, colour) in enumerate(CURVES):
        place = [one["median"] * (1.0 + 0.03 * (shift - 1)) for one in by_size]
        rates = [100.0 * one[key]["rate"] for one in by_size]
        reach = [
            [max(0.0, 100.0 * (one[key]["rate"] - one[key]["low"])) for one in by_size],
            [max(0.0, 100.0 * (one[key]["high"] - one[key]["rate"])) for one in by_size],
        ]
        axes.errorbar(
            place, rates, reach, color=colour, marker="o", markersize=4, capsize=2, linewidth=1.2, label=words
        )
    axes.set(
        xscale="log",
        ylim=(-3, 103),
        xlabel="size of the effect: whitened rms per sample, nuisances removed",
        ylabel="share of cases, %",
    )
    axes.set_xticks(SIZES, labels=[f"{size:g}" for size in SIZES])
    axes.minorticks_off()
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.savefig(path, dpi=150)
