"""The presses to make next, at most three: those by which the surviving rivals differ most."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnose.findings import Findings, FittedModel
from diagnose.forward import Engine, NoAnswerError
from diagnose.next_press.parting import PressJudge
from diagnose.next_press.proposals import PressSetup, Proposal, base_setup, repeat_proposals
from diagnose.next_press.variations import variations
from diagnose.signals.recording import Recording, Run
from diagnose.statistics.best_press import best_press, linked_groups
from diagnose.statistics.separation import Group, least_separation
from foundation.arrays import Floats

MOST_RIVALS, MOST_PRESSES = 6, 3
LEAST_RIVAL_PROBABILITY = 0.01  # a model below this probability is no rival
LEAST_SEPARATION_SIGMAS = 1.0  # a press that separates rivals by less adds no more than noise
CONFUSION_PROBABILITY = 0.05  # chance of choosing the wrong one that is taken for settled
SETTLED_SEPARATION_SIGMAS = least_separation(CONFUSION_PROBABILITY)


@dataclass(frozen=True)
class NextPress:
    """A press to make next. text : what to do. changes : key -> value. rivals : the models that it is to tell apart.

    separations : (pairs,) sigma between each two rivals in it. separation : the least of those that are settled by it,
    with the presses before; the largest where none is. alike : those that are expected to stay together after it, in
    groups of numbers of rivals. run : the press as a run without answers.
    """

    text: str
    changes: Mapping[str, Any]
    rivals: tuple[FittedModel, ...]
    separations: Floats
    separation: float
    alike: tuple[Group, ...]
    run: Run


def next_presses(recording: Recording, engine: Engine, findings: Findings) -> tuple[NextPress, ...]:
    """Best press to make next, and presses to make after it; none where fewer than two models are left.

    Each tells apart what those before it are not expected to: separations of presses add as squares. None is proposed
    that separates no two of these by LEAST_SEPARATION_SIGMAS.
    """
    judge = PressJudge(recording, engine, surviving_models(findings))
    rivals = tuple(judge.known)
    if len(rivals) < 2:
        return ()
    search, known = PressSearch(judge, recording), np.zeros(len(rivals) * (len(rivals) - 1) // 2)
    found: list[NextPress] = []
    while len(found) < MOST_PRESSES and known.min() < SETTLED_SEPARATION_SIGMAS:
        best = search.best(known)
        if best is None:
            break
        press, separations = best
        before, known = known, np.hypot(known, separations)
        settled = separations[(before < SETTLED_SEPARATION_SIGMAS) & (known >= SETTLED_SEPARATION_SIGMAS)]
        sigma = float(settled.min() if len(settled) else separations.max())
        alike = linked_groups(len(rivals), known < SETTLED_SEPARATION_SIGMAS)
        found.append(NextPress(press.text, press.changes, rivals, separations, sigma, alike, press.run))
    return tuple(found)


def surviving_models(findings: Findings) -> tuple[FittedModel, ...]:
    """Models that are left to tell apart: the group of the best model, else the best model and its rivals."""
    if not findings.mismatch:
        return ()
    group = findings.groups[0] if findings.groups else ()
    chosen = [findings.models[number] for number in group]
    if len(chosen) < 2:
        chosen = [model for model in findings.models if model.probability >= LEAST_RIVAL_PROBABILITY]
    return tuple(chosen[:MOST_RIVALS])


class PressSearch:
    """Search among presses of one change, and of two changes where these help, by their separations (pairs,)."""

    def __init__(self, judge: PressJudge, recording: Recording) -> None:
        self.judge, self.recording, self.setup = judge, recording, base_setup(recording)
        ones = [] if self.setup is None else [self.setup, *variations(self.setup)]
        self.singles = list(self._judge_all([*repeat_proposals(recording), *(one.proposal() for one in ones)]))

    def best(self, known: Floats) -> tuple[Proposal, Floats] | None:
        """Press that separates most of what presses before, with separations (pairs,), do not; None where none does.

        Where one change leaves rivals together, a second one is tried on top of it.
        """
        first = _best_proposal(self.singles, known)
        if first is None or np.hypot(known, first[1]).min() >= SETTLED_SEPARATION_SIGMAS:
            return first
        return _best_proposal([first, *self._judge_all(self._second_changes(first[0]))], known)

    def _second_changes(self, first: Proposal) -> list[Proposal]:
        if self.setup is None:
            return []
        same: list[PressSetup] = [one for one in variations(self.setup) if one.changes == first.changes]
        return [second.proposal() for one in same for second in variations(one)]

    def _judge_all(self, proposals: Sequence[Proposal]) -> Iterator[tuple[Proposal, Floats]]:
        """Proposals, as runs made after all others, each with its separations (pairs,)."""
        for proposal in proposals:
            proposal = replace(proposal, run=self.recording.as_next_run(proposal.run))
            try:
                yield proposal, self.judge.separations(proposal)
            except NoAnswerError:  # beyond what the model was prepared for
                continue


def _best_proposal(presses: Sequence[tuple[Proposal, Floats]], known: Floats) -> tuple[Proposal, Floats] | None:
    """Best press, with its separations (pairs,), of those that separate two rivals whom earlier presses do not."""
    useful = [
        press for press in presses if press[1][known < SETTLED_SEPARATION_SIGMAS].max() >= LEAST_SEPARATION_SIGMAS
    ]
    if not useful:
        return None
    return useful[
        best_press(np.array([np.hypot(known, separations) for _, separations in useful]), SETTLED_SEPARATION_SIGMAS)
    ]
