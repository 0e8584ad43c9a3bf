"""The verdict in sentences that a bench engineer understands, each with a label that says what it is about."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf, sqrt
from typing import Any

from diagnose.figures import figure, p_equals, part_percent, percent
from diagnose.findings import Findings, Fit, FittedModel
from diagnose.fit.rig_discrepancy import VISIBLE_ERROR
from diagnose.next_press.choose import NextPress, surviving_models
from diagnose.signals.recording import Recording
from diagnose.verdict.content import next_experiment, reason_without_press
from diagnose.verdict.names import interval_words, join_words, model_words, short_name
from diagnose.verdict.resimulation import Resimulation
from diagnose.verdict.where_it_fails import PHASE_WORDS, where_words

MAJORITY_SHARE = 0.5  # of what is left: a phase with more of it is named


@dataclass(frozen=True)
class Sentence:
    """A sentence of the verdict. label : what it is about, "" where the text speaks for itself."""

    label: str
    text: str

    def __str__(self) -> str:
        return f"{self.label}: {self.text}" if self.label else self.text


def sentences(
    recording: Recording, findings: Findings, following: Sequence[NextPress], resimulated: Sequence[Resimulation]
) -> list[Sentence]:
    """Sentences of the verdict, from what is off to what to do next."""
    if not findings.mismatch:
        return _agreement_sentences(recording, findings)
    opening = [Sentence("", where_words(recording, findings))]
    if findings.best is None:
        return [
            *opening,
            *_unexplained_sentences(findings),
            *_sentences_on_unstated(recording, findings),
            *_next_press_sentences(findings, following),
        ]
    told = [
        *opening,
        *_named_sentences(findings, findings.best),
        *_remainder_sentences(findings),
        *_resimulation_sentences(resimulated),
    ]
    return [*told, *_next_press_sentences(findings, following)]


def _agreement_sentences(recording: Recording, findings: Findings) -> list[Sentence]:
    presses = sum(len(found.presses) for found in recording.phases)
    runs = len(recording.runs)
    return [
        Sentence("", "Your simulation and the recordings agree: the difference is no larger than noise makes it."),
        Sentence(
            "How sure",
            f"nothing stands out in {_count_words(presses, 'press')} of {_count_words(runs, 'run')} "
            f"({detection_p_value(findings)}, taking all cells together; a mismatch is reported below "
            f"{figure(findings.detection.level)}).",
        ),
        Sentence("Next", "keep the model as it is; improved.toml repeats your own configuration."),
    ]


def detection_p_value(findings: Findings) -> str:
    """Words for the p-value of the detection, with the sign that it needs."""
    return p_equals(findings.detection.p_value, findings.detection.least_p_value)


def _named_sentences(findings: Findings, best: FittedModel) -> Iterator[Sentence]:
    left = findings.remainder
    if left is None:
        yield Sentence("Left out", f"{model_words(best)}{_parameter_words(best)}.")
    else:
        share = f"{part_percent(left.share)} of the excess over noise in conditions that it was not fitted to"
        yield Sentence(
            "Most of what is left out", f"{model_words(best)}{_parameter_words(best)}. It accounts for {share}."
        )
    fit = findings.held_out
    if fit is not None:
        change = "falls" if fit.improves else "does not fall but goes"
        yield Sentence("With it", f"on presses that took no part in the fit, the error {change} {_error_words(fit)}.")
    rivals = [findings.models[n] for group in findings.groups[:1] for n in group if findings.models[n] is not best]
    if rivals:
        words = join_words([model_words(rival) for rival in rivals], "or")
        yield Sentence("Not excluded", f"{words}. These recordings cannot tell the explanations apart.")


def _remainder_sentences(findings: Findings) -> Iterator[Sentence]:
    """Sentences on what a main part leaves, and why it is not everything."""
    if findings.remainder is None:
        return
    phase, share = max(findings.remainder.by_phase.items(), key=lambda item: item[1])
    where = f", mostly {PHASE_WORDS[phase]}," if share > MAJORITY_SHARE else ""
    yield Sentence("The rest", f"what remains{where} has no name. {' '.join(findings.reasons)}")


def _error_words(fit: Fit) -> str:
    """Words for the errors before and after a fit, of the fast model over all channels.

    The table of the report has the same numbers.
    """
    before, after, noise = (percent(share) for share in (fit.nrmse_before, fit.nrmse_after, fit.noise_floor_nrmse))
    inside = fit.nrmse_after <= fit.noise_floor_nrmse
    floor = f"no more than the estimated noise, {noise}" if inside else f"the estimated noise makes {noise}"
    return f"from {before} to {after} of the recorded signal ({floor})"


def _parameter_words(model: FittedModel) -> str:
    """Words for the parameters of a model; of a law with many constants, only the quantities derived from them."""
    words = []
    for setting, intervals in zip(model.settings, model.parameters, strict=True):
        derived = setting.candidate.derived(setting.values)
        for name, each in intervals.items():
            if not derived or name in derived:
                side = " to either side" if name.partition("[")[0] in setting.candidate.either_sign else ""
                words.append(f"{interval_words(name, each)}{side}")
    return f"; {', '.join(words)}" if words else ""


def _unexplained_sentences(findings: Findings) -> Iterator[Sentence]:
    if findings.kind:
        rivals = [model_words(findings.models[n]) for n in findings.groups[0]]
        each = (
            f"Each of these explains most: {join_words(rivals, 'or')}."
            if len(rivals) > 1
            else f"Of all that is known only this explains most, and it leaves too much for a name: {rivals[0]}."
        )
        yield Sentence("Left out", f"only its kind can be told: {findings.kind}. {each}")
    else:
        yield Sentence("Left out", _unnamed_text(findings))
        if findings.reasons:
            yield Sentence("Why nothing is named", " ".join(findings.reasons))
    if findings.unnamed is not None and findings.comes_closer:
        closest = short_name([setting.candidate for setting in findings.models[0].settings])
        text = f"with {closest}, the error on held-out presses would fall {_error_words(findings.unnamed)}."
        yield Sentence("The closest explanation", text)


def _sentences_on_unstated(recording: Recording, findings: Findings) -> Iterator[Sentence]:
    """Sentences on what every rig has a little of and rig.toml does not state, where it alone predicts better.

    That is, held-out presses better than the baseline does.
    """
    if any(run.drive != "displacement_mm" for run in recording.runs):
        return
    stated = {name for run in recording.runs for name in run.nuisance}
    for model in findings.models:
        one = model.settings[0].candidate
        if len(model.settings) == 1 and one.stated_as and one.stated_as not in stated and model.gain_lower > 0.0:
            usual = min(one.everyday.values())
            yield Sentence(
                "To be stated",
                f"every rig has a little of {short_name([one])}, and rig.toml says nothing of it. State how uncertain "
                f"it is in [runs.nuisance], {one.stated_as} = {usual:g} for a careful set-up, and diagnose again: the "
                "rest is then judged beside it.",
            )


def _unnamed_text(findings: Findings) -> str:
    """Text on a mismatch without a name, and on whether an ordinary rig makes as much."""
    fits = [fit for fit in (findings.train, findings.held_out) if fit is not None]
    excess = max((sqrt(fit.excess_before) for fit in fits), default=inf)
    if excess > VISIBLE_ERROR and findings.ambiguous:
        rivals = join_words([model_words(findings.models[n]) for n in findings.groups[0]], "or")
        return f"one of several things that these recordings cannot tell apart, so nothing is named: {rivals}."
    if excess > VISIBLE_ERROR:
        return "something that none of the known mechanisms explains, so nothing is named."
    known = (
        "Several known mechanisms explain it alike"
        if findings.ambiguous
        else "None of the known mechanisms explains it"
    )
    return (
        f"nothing large. What is off is {percent(excess)} of the recorded signal above the noise; flaws of an ordinary "
        f"rig make as much. {known}, so nothing is named."
    )


def _resimulation_sentences(resimulated: Sequence[Resimulation]) -> Iterator[Sentence]:
    for one in resimulated[:2]:
        yield Sentence(
            "Checked with the full model",
            f"in the run “{one.run}” ({one.role}) alone, the error of the full model ({one.engine}) is "
            f"{percent(one.after_all)} with it and {percent(one.before_all)} without it.",
        )


def _next_press_sentences(findings: Findings, following: Sequence[NextPress]) -> Iterator[Sentence]:
    """Sentences on the next presses, or on why there is none."""
    planned = next_experiment(findings, following)
    if following:
        yield Sentence("Next", f"{planned['text']} {separation_words(planned)}")
        for press in planned["then"]:
            yield Sentence("After that", f"{press['text']} {separation_words(press, 'Those that are left')}")
    if not following and (findings.unexplained or len(surviving_models(findings)) > 1):
        yield Sentence("Next", reason_without_press(findings))


def separation_words(press: Mapping[str, Any], rivals: str = "The explanations") -> str:
    """Sentence on how far a press, as verdict.json has it, separates the rivals, and which of them stay together."""
    sigma = figure(press["expected_separation_sigma"])
    told = f"{rivals} are expected to differ by {sigma} standard deviations in it"
    groups = press["leaves_together"]
    if not groups or len(groups[0]) == len(press["separates"]):
        return f"{told}."
    names = [join_words([f"{one['mechanism']} ({one['component']})" for one in group]) for group in groups]
    return f"{told} or more; these will not be told apart by it: {'; '.join(names)}."


def _count_words(number: int, what: str) -> str:
    plural = f"{what}es" if what.endswith("s") else f"{what}s"
    return f"{number} {what if number == 1 else plural}"
