"""The presses to make next, at most three: those by which the surviving rivals part most."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnose.findings import Findings, FittedModel
from diagnose.forward import Engine
from diagnose.next_press.parting import PressJudge
from diagnose.next_press.proposals import PressSetup, Proposal, base_setup, repeats
from diagnose.next_press.variations import variations
from diagnose.signals.recording import Recording, Run
from diagnose.statistics.best_press import best_press, linked_groups
from diagnose.statistics.separation import Group, least_separation
from foundation.arrays import Floats

MOST_RIVALS, MOST_PRESSES = 6, 3
PLAUSIBLE = 0.01  # a model below this probability is no rival
LEAST = 1.0  # sigma: a press that parts rivals by less tells no more than its noise
CONFUSED = 0.05  # chance of choosing the wrong one that is taken for settled
SETTLED = least_separation(CONFUSED)


@dataclass(frozen=True)
class NextPress:
    """text : what to do. changes : key -> value. rivals : the models it is to part, their names by settings.

    separations : (pairs,) sigma between each two rivals in it. separation : the least of those that are settled by it,
    with the presses before; the largest where none is. alike : those that are expected to stay together after it, in
    groups of numbers of rivals.
    """

    text: str
    changes: Mapping[str, Any]
    rivals: tuple[FittedModel, ...]
    separations: Floats
    separation: float
    alike: tuple[Group, ...]
    run: Run


def next_presses(recording: Recording, engine: Engine, findings: Findings) -> tuple[NextPress, ...]:
    """The best press to make next, and what to press after it; none where fewer than two models are left.

    Each parts what those before it are not expected to part: separations of presses add as squares. None is proposed
    that parts no two of these by LEAST.
    """
    rivals = surviving(findings)
    if len(rivals) < 2:
        return ()
    judge = PressJudge(recording, engine, rivals)
    search, known = PressSearch(judge, recording), np.zeros(len(rivals) * (len(rivals) - 1) // 2)
    found: list[NextPress] = []
    while len(found) < MOST_PRESSES and known.min() < SETTLED:
        best = search.best(known)
        if best is None:
            break
        press, separations = best
        before, known = known, np.hypot(known, separations)
        settled = separations[(before < SETTLED) & (known >= SETTLED)]
        sigma = float(settled.min() if len(settled) else separations.max())
        alike = linked_groups(len(rivals), known < SETTLED)
        found.append(NextPress(press.text, press.changes, rivals, separations, sigma, alike, press.run))
    return tuple(found)


def surviving(findings: Findings) -> tuple[FittedModel, ...]:
    """What is left to tell apart: the group of the best model, else the best model and its rivals."""
    if not findings.mismatch:
        return ()
    group = findings.groups[0] if findings.groups else ()
    chosen = [findings.models[number] for number in group]
    if len(chosen) < 2:
        chosen = [model for model in findings.models if model.probability >= PLAUSIBLE]
    return tuple(chosen[:MOST_RIVALS])


class PressSearch:
    """All presses of one change, each with its separations (pairs,), and presses of two changes where these help."""

    def __init__(self, judge: PressJudge, recording: Recording) -> None:
        self.judge, self.recording, self.setup = judge, recording, base_setup(recording)
        ones = [] if self.setup is None else [self.setup, *variations(self.setup)]
        self.singles = list(self._told([*repeats(recording), *(one.proposal() for one in ones)]))

    def best(self, known: Floats) -> tuple[Proposal, Floats] | None:
        """The one that parts most of what presses before, with separations (pairs,), do not; None where none does.

        Where one change leaves rivals together, a second one is tried on top of it.
        """
        first = _best(self.singles, known)
        if first is None or np.hypot(known, first[1]).min() >= SETTLED:
            return first
        return _best([first, *self._told(self._second(first[0]))], known)

    def _second(self, first: Proposal) -> list[Proposal]:
        if self.setup is None:
            return []
        same: list[PressSetup] = [one for one in variations(self.setup) if one.changes == first.changes]
        return [second.proposal() for one in same for second in variations(one)]

    def _told(self, proposals: Sequence[Proposal]) -> Iterator[tuple[Proposal, Floats]]:
        for proposal in proposals:
            proposal = replace(proposal, run=self.recording.as_next_run(proposal.run))
            try:
                yield proposal, self.judge.separations(proposal)
            except ValueError:  # beyond what the model was prepared for
                continue


def _best(presses: Sequence[tuple[Proposal, Floats]], known: Floats) -> tuple[Proposal, Floats] | None:
    """Of presses that part two rivals by LEAST which those before do not part."""
    useful = [press for press in presses if press[1][known < SETTLED].max() >= LEAST]
    if not useful:
        return None
    return useful[best_press(np.array([np.hypot(known, separations) for _, separations in useful]), SETTLED)]
