"""Content of verdict.json, what a diagnosis found for other programs. Units stand beside the values."""

from collections.abc import Sequence
from typing import Any

from diagnose.findings import Findings, Fit, FittedModel, Grade, Interval, Remainder
from diagnose.next_press.choose import NextPress, surviving_models
from diagnose.verdict.names import model_words
from diagnose.verdict.resimulation import Resimulation
from diagnose.verdict.where_it_fails import significant_places

FORMAT = "softdot-verdict/1"


def verdict(
    findings: Findings,
    summary: Sequence[str],
    following: Sequence[NextPress],
    resimulated: Sequence[Resimulation],
    warnings: Sequence[str],
) -> dict[str, Any]:
    """Whole content of verdict.json. summary : sentences for people; following : the next presses, best first.

    What is only the main part has a key of its own: missing_physics is empty unless it explains everything.
    """
    told = findings.best if findings.grade in (Grade.IDENTIFIED, Grade.MAIN_PART) else None
    whole = findings.grade is Grade.IDENTIFIED
    return {
        "format": FORMAT,
        "summary": list(summary),
        "grade": str(findings.grade),
        "mismatch": findings.mismatch,
        "detection": _detection_table(findings),
        "where": _places_table(findings),
        "component_shares": dict(findings.shares),
        "missing_physics": _mechanisms_table(told) if told is not None and whole else [],
        "main_part": _mechanisms_table(told) if told is not None and not whole else [],
        "remainder": _remainder_table(findings.remainder),
        "kind": findings.kind or None,
        "alternatives": [_alternative_table(model) for model in findings.models if model is not told],
        "ambiguous_with": ambiguous_groups(findings),
        "unexplained": findings.unexplained,
        "reasons": list(findings.reasons),
        "fit": {
            "train": _fit_table(findings.train),
            "held_out": _fit_table(findings.held_out),
            "held_out_best_unnamed": _fit_table(findings.unnamed),
            "engine": findings.engine,
            "engine_error_percent": {
                _quantity_name(name): 100.0 * share for name, share in findings.engine_accuracy.items()
            },
            "resimulated": [_resimulation_table(each) for each in resimulated],
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


def _remainder_table(left: Remainder | None) -> dict[str, Any] | None:
    """Share that a main part explains, and where the rest lies; None without a main part."""
    if left is None:
        return None
    return {"share_explained_held_out": left.share, "share_left_by_phase": dict(left.by_phase)}


def _quantity_name(channel: str) -> str:
    """Quantity of a channel without its unit: force_N -> force."""
    return channel.rpartition("_")[0]


def _detection_table(findings: Findings) -> dict[str, Any]:
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


def _places_table(findings: Findings) -> list[dict[str, Any]]:
    """Places with a significant excess; none where there is no mismatch."""
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
        for place in (significant_places(findings) if findings.mismatch else [])
    ]


def _mechanisms_table(model: FittedModel) -> list[dict[str, Any]]:
    """Mechanisms of a model with parameters and intervals, and as a configuration has them."""
    return [
        {
            "mechanism": setting.candidate.mechanism,
            "component": setting.candidate.component,
            "parameters": {name: _interval_table(interval) for name, interval in intervals.items()},
            "configuration": setting.candidate.parameters(setting.values),
            "probability": model.probability,
        }
        for setting, intervals in zip(model.settings, model.parameters, strict=True)
    ]


def _interval_table(interval: Interval) -> dict[str, Any]:
    return {
        "value": interval.value,
        "low": interval.low,
        "high": interval.high,
        "unit": interval.unit,
        "bounded": interval.limited_by_search,
        "low_is_limit_of_search": interval.low_searched,
        "high_is_limit_of_search": interval.high_searched,
        "fixed": interval.fixed,
    }


def _alternative_table(model: FittedModel) -> dict[str, Any]:
    names = _mechanism_names(model)
    return {
        "mechanism": " + ".join(each["mechanism"] for each in names),
        "component": " + ".join(each["component"] for each in names),
        "mechanisms": names,
        "words": model_words(model),
        "probability": model.probability,
        "log_score_gain_per_press": model.gain,
        "error_left": model.error_left,
    }


def _mechanism_names(model: FittedModel) -> list[dict[str, str]]:
    pairs = (setting.candidate.name for setting in model.settings)
    return [{"mechanism": mechanism, "component": component} for mechanism, component in pairs]


def ambiguous_groups(findings: Findings) -> list[list[dict[str, Any]]]:
    """Groups of two or more models that the recordings cannot tell apart; a pair of mechanisms is one member."""
    groups = [[findings.models[number] for number in group] for group in findings.groups if len(group) > 1]
    return [[_model_names(model) for model in group] for group in groups]


def _model_names(model: FittedModel) -> dict[str, str]:
    names = _mechanism_names(model)
    return {key: " + ".join(each[key] for each in names) for key in ("mechanism", "component")}


def _fit_table(fit: Fit | None) -> dict[str, Any] | None:
    if fit is None:
        return None
    return {
        "nrmse_before": fit.nrmse_before,
        "nrmse_after": fit.nrmse_after,
        "log_score_gain_per_press": fit.log_score_gain_per_press,
        "noise_floor_nrmse": fit.noise_floor_nrmse,
        "presses": list(fit.presses),
    }


def _resimulation_table(one: Resimulation) -> dict[str, Any]:
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
    """Next press, and under "then" those to make after it; without one, a sentence and null."""
    if not following:
        nothing: dict[str, Any] = {"changes": {}, "separates": [], "leaves_together": [], "then": []}
        return {"text": reason_without_press(findings), **nothing, "expected_separation_sigma": None}
    first, *others = [_press_table(press, waveform_file(number)) for number, press in enumerate(following)]
    return {**first, "then": others}


def waveform_file(number: int) -> str:
    """Name of the file with the motion of a proposed press, numbered from 0."""
    return f"next-press-{number + 1}.csv" if number else "next-press.csv"


def _press_table(press: NextPress, file: str) -> dict[str, Any]:
    return {
        "text": press.text,
        "as_in": press.run.label,
        "changes": dict(press.changes),
        "separates": [_model_names(model) for model in press.rivals],
        "leaves_together": [[_model_names(press.rivals[number]) for number in group] for group in press.alike],
        "expected_separation_sigma": press.separation,
        "waveform": file,
    }


def reason_without_press(findings: Findings) -> str:
    """Sentence on why there is no next press, and what to do instead."""
    if not findings.mismatch:
        return "No press is needed: simulation and recordings agree."
    if len(surviving_models(findings)) > 1:
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
