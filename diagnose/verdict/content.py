"""verdict.json: what a diagnosis found, for other programs. Units stand beside the values."""

from collections.abc import Sequence
from typing import Any

from diagnose.findings import Findings, Fit, FittedModel, Grade, Interval, Remainder
from diagnose.next_press.choose import NextPress, surviving
from diagnose.verdict.names import model_words
from diagnose.verdict.resimulation import Resimulated
from diagnose.verdict.where_it_fails import significant

FORMAT = "softdot-verdict/1"


def verdict(
    findings: Findings,
    summary: Sequence[str],
    following: Sequence[NextPress],
    resimulated: Sequence[Resimulated],
    warnings: Sequence[str],
) -> dict[str, Any]:
    """The whole content. summary : sentences for people; following : the next presses, best first.

    What is only the main part has a key of its own: missing_physics is empty unless it explains everything.
    """
    told = findings.best if findings.grade in (Grade.IDENTIFIED, Grade.MAIN_PART) else None
    whole = findings.grade is Grade.IDENTIFIED
    return {
        "format": FORMAT,
        "summary": list(summary),
        "grade": str(findings.grade),
        "mismatch": findings.mismatch,
        "detection": _detection(findings),
        "where": _where(findings),
        "component_shares": dict(findings.shares),
        "missing_physics": _missing(told) if told is not None and whole else [],
        "main_part": _missing(told) if told is not None and not whole else [],
        "remainder": _remainder(findings.remainder),
        "kind": findings.kind or None,
        "alternatives": [_alternative(model) for model in findings.models if model is not told],
        "ambiguous_with": ambiguous(findings),
        "unexplained": findings.unexplained,
        "reasons": list(findings.reasons),
        "fit": {
            "train": _fit(findings.train),
            "held_out": _fit(findings.held_out),
            "held_out_best_unnamed": _fit(findings.unnamed),
            "engine": findings.engine,
            "engine_error_percent": {_kind(name): 100.0 * share for name, share in findings.engine_accuracy.items()},
            "resimulated": [_resimulated(each) for each in resimulated],
        },
        "black_box_gain_over_best_per_press": findings.black_box_gain,
        "nuisances": {name: {"value": v, "one_sigma": s} for name, (v, s) in findings.nuisances.items()},
        "screened": [
            {"mechanism": mechanism, "component": component, "p_value": p}
            for (mechanism, component), p in sorted(findings.screened.items(), key=lambda item: item[1])
        ],
        "next_experiment": next_experiment(findings, following),
        "warnings": [*findings.warnings, *warnings],
    }


def _remainder(left: Remainder | None) -> dict[str, Any] | None:
    """What a main part leaves."""
    if left is None:
        return None
    return {"share_explained_held_out": left.share, "share_left_by_phase": dict(left.by_phase)}


def _kind(channel: str) -> str:
    """force_N -> force."""
    return channel.rpartition("_")[0]


def _detection(findings: Findings) -> dict[str, Any]:
    noise: dict[str, dict[str, Any]] = {}
    for (label, channel), summary in findings.detection.noise.items():
        noise.setdefault(label, {})[channel] = dict(summary)
    return {
        "statistic": findings.detection.statistic,
        "p_value_family_wise": findings.detection.p_value,
        "least_p_value": findings.detection.least_p_value,
        "level": findings.detection.level,
        "noise_model": noise,
    }


def _where(findings: Findings) -> list[dict[str, Any]]:
    """Nothing where there is no mismatch."""
    return [
        {
            "run": place.run,
            "channel": place.channel,
            "phase": place.phase,
            "press": place.press,
            "band_hz": list(place.band_Hz),
            "share_of_excess": place.share,
            "component": place.component,
            "score": place.score,
            "p_value_family_wise": place.p_value,
        }
        for place in (significant(findings) if findings.mismatch else [])
    ]


def _missing(model: FittedModel) -> list[dict[str, Any]]:
    return [
        {
            "mechanism": setting.candidate.mechanism,
            "component": setting.candidate.component,
            "parameters": {name: _interval(interval) for name, interval in intervals.items()},
            "configuration": setting.candidate.parameters(setting.values),
            "probability": model.probability,
        }
        for setting, intervals in zip(model.settings, model.parameters, strict=True)
    ]


def _interval(interval: Interval) -> dict[str, Any]:
    return {
        "value": interval.value,
        "low": interval.low,
        "high": interval.high,
        "unit": interval.unit,
        "bounded": interval.bounded,
        "low_is_limit_of_search": interval.low_searched,
        "high_is_limit_of_search": interval.high_searched,
        "fixed": interval.fixed,
    }


def _alternative(model: FittedModel) -> dict[str, Any]:
    names = _names(model)
    return {
        "mechanism": " + ".join(each["mechanism"] for each in names),
        "component": " + ".join(each["component"] for each in names),
        "mechanisms": names,
        "words": model_words(model),
        "probability": model.probability,
        "log_score_gain_per_press": model.gain,
        "p_value_left": model.p_left,
    }


def _names(model: FittedModel) -> list[dict[str, str]]:
    pairs = (setting.candidate.name for setting in model.settings)
    return [{"mechanism": mechanism, "component": component} for mechanism, component in pairs]


def ambiguous(findings: Findings) -> list[list[dict[str, Any]]]:
    """Groups of two or more models that the recordings cannot tell apart; a pair of mechanisms is one member."""
    groups = [[findings.models[number] for number in group] for group in findings.groups if len(group) > 1]
    return [[_member(model) for model in group] for group in groups]


def _member(model: FittedModel) -> dict[str, str]:
    names = _names(model)
    return {key: " + ".join(each[key] for each in names) for key in ("mechanism", "component")}


def _fit(fit: Fit | None) -> dict[str, Any] | None:
    if fit is None:
        return None
    return {
        "nrmse_before": fit.nrmse_before,
        "nrmse_after": fit.nrmse_after,
        "log_score_gain_per_press": fit.log_score_gain_per_press,
        "noise_floor_nrmse": fit.noise_floor_nrmse,
        "presses": list(fit.presses),
    }


def _resimulated(one: Resimulated) -> dict[str, Any]:
    return {
        "run": one.run,
        "role": one.role,
        "engine": one.engine,
        "nrmse_before": dict(one.before),
        "nrmse_after": dict(one.after),
        "nrmse_before_all_channels": one.before_all,
        "nrmse_after_all_channels": one.after_all,
        "reduced_against_full_nrmse": dict(one.reduced_error),
    }


def next_experiment(findings: Findings, following: Sequence[NextPress]) -> dict[str, Any]:
    """The next press, and under "then" those to make after it; without one, a sentence and null."""
    if not following:
        nothing: dict[str, Any] = {"changes": {}, "separates": [], "leaves_together": [], "then": []}
        return {"text": without_press(findings), **nothing, "expected_separation_sigma": None}
    first, *others = [_press(press, waveform(number)) for number, press in enumerate(following)]
    return {**first, "then": others}


def waveform(number: int) -> str:
    """File of the motion of a proposed press, numbered from 0."""
    return f"next-press-{number + 1}.csv" if number else "next-press.csv"


def _press(press: NextPress, file: str) -> dict[str, Any]:
    return {
        "text": press.text,
        "as_in": press.run.label,
        "changes": dict(press.changes),
        "separates": [_member(model) for model in press.rivals],
        "leaves_together": [[_member(press.rivals[number]) for number in group] for group in press.alike],
        "expected_separation_sigma": press.separation,
        "waveform": file,
    }


def without_press(findings: Findings) -> str:
    """Why there is no next press, and what to do instead."""
    if not findings.mismatch:
        return "No press is needed: simulation and recordings agree."
    if len(surviving(findings)) > 1:
        return (
            "None of the presses that were tried tells them apart: they act alike in this rig. Measure one part by "
            "itself, such as the amplifier without the sensor, or a coupon of the material."
        )
    if findings.grade is Grade.MAIN_PART:
        return (
            "Put it into your configuration, as improved.toml does, and look at what is left: change one thing at a "
            "time (speed, depth, load resistor, position) and diagnose again."
        )
    if findings.best is not None:
        return "No press is needed: only one explanation is left."
    return (
        "There are no two explanations to tell apart. Change one thing at a time (speed, depth, load resistor, "
        "position) and diagnose again: whatever changes the misfit shows where to look."
    )
