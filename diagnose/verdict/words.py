"""The verdict in sentences that a bench engineer understands, each with a word on what it is about."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from diagnose.findings import Findings, Fit, Model
from diagnose.next_press.choose import NextPress, surviving
from diagnose.recording import Recording
from diagnose.verdict.content import without_press
from diagnose.verdict.names import figure, interval_words, listed, model_words, percent
from diagnose.verdict.resimulation import Resimulated
from diagnose.verdict.where import where_words


@dataclass(frozen=True)
class Sentence:
    """label : what it is about, "" where the text speaks for itself."""

    label: str
    text: str

    def __str__(self) -> str:
        return f"{self.label}: {self.text}" if self.label else self.text


def sentences(
    recording: Recording, findings: Findings, following: NextPress | None, resimulated: Sequence[Resimulated]
) -> list[Sentence]:
    """From what is off to what to do next."""
    if not findings.mismatch:
        return _agreement(recording, findings)
    opening = [Sentence("", where_words(recording, findings))]
    if findings.best is None or findings.unexplained:
        return [*opening, *_unexplained(findings), *_next(findings, following)]
    return [*opening, *_named(findings, findings.best), *_proof(resimulated), *_next(findings, following)]


def _agreement(recording: Recording, findings: Findings) -> list[Sentence]:
    presses = sum(len(found.presses) for found in recording.phases)
    runs = len(recording.runs)
    return [
        Sentence("", "Your simulation and the recordings agree: what is left is as large as noise makes it."),
        Sentence(
            "How sure",
            f"in {_count(presses, 'press')} of {_count(runs, 'run')} nothing stands out (family-wise p = "
            f"{figure(findings.detection.p_value)}; a mismatch would be below {figure(findings.detection.level)}).",
        ),
        Sentence("Keep", "the model as it is; improved.toml is your own configuration."),
    ]


def _named(findings: Findings, best: Model) -> Iterator[Sentence]:
    yield Sentence("Left out", f"{model_words(best)}{_numbers(best)}.")
    fit = findings.held_out
    if fit is not None:
        yield Sentence("With it", f"the error on presses that it was not fitted to falls {_errors(fit)}.")
    rivals = [findings.models[n] for group in findings.groups[:1] for n in group if findings.models[n] is not best]
    if rivals:
        words = listed([f"that {model_words(rival)}" for rival in rivals], "or")
        yield Sentence("Not excluded", f"{words}; these recordings cannot tell.")


def _errors(fit: Fit) -> str:
    noise = percent(fit.noise_floor_nrmse)
    return f"from {percent(fit.nrmse_before)} to {percent(fit.nrmse_after)} (noise alone makes {noise})"


def _numbers(model: Model) -> str:
    """Of a law with many constants only what they come to."""
    words = []
    for setting, intervals in zip(model.settings, model.parameters, strict=True):
        derived = setting.candidate.derived(setting.values)
        words += [interval_words(name, each) for name, each in intervals.items() if not derived or name in derived]
    return f"; {', '.join(words)}" if words else ""


def _unexplained(findings: Findings) -> Iterator[Sentence]:
    yield Sentence("Left out", "something that none of the known mechanisms explains. Nothing is named.")
    if findings.reasons:
        yield Sentence("Why nothing is named", " ".join(findings.reasons))
    if findings.unnamed is not None and findings.unnamed.nrmse_after < findings.unnamed.nrmse_before:
        text = f"With the best, the error on presses that it was not fitted to would go {_errors(findings.unnamed)}."
        yield Sentence("How far off", text)


def _proof(resimulated: Sequence[Resimulated]) -> Iterator[Sentence]:
    for one in resimulated[:2]:
        before, after = max(one.before.values(), default=0.0), max(one.after.values(), default=0.0)
        yield Sentence(
            "Pressed again",
            f"in “{one.run}” ({one.role}) the full model is {percent(after)} off with it, {percent(before)} without.",
        )


def _next(findings: Findings, following: NextPress | None) -> Iterator[Sentence]:
    if following is not None:
        apart = f"Expected to part them by {figure(following.separation)} sigma."
        yield Sentence("To settle it", f"{following.text} {apart}")
    elif findings.unexplained or len(surviving(findings)) > 1:
        yield Sentence("To settle it", without_press(findings))


def _count(number: int, what: str) -> str:
    plural = f"{what}es" if what.endswith("s") else f"{what}s"
    return f"{number} {what if number == 1 else plural}"
