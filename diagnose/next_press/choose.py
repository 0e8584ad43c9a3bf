"""The press by which the surviving rivals part most, in sigma, after all that may float has floated."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnose.findings import Findings, Model
from diagnose.forward import Engine
from diagnose.next_press.judge import Judge
from diagnose.next_press.proposals import Proposal, base_setup, repeats
from diagnose.next_press.variations import variations
from diagnose.recording import Recording, Run
from diagnose.statistics.design import best_press
from diagnose.statistics.separation import least_separation

MOST_RIVALS = 3
PLAUSIBLE = 0.01  # a model below this probability is no rival
LEAST = 1.0  # sigma: a press that parts rivals by less tells no more than its noise
CONFUSED = 0.05  # chance of choosing the wrong one that is taken for settled


@dataclass(frozen=True)
class NextPress:
    """text : what to do. changes : key -> value. rivals : the models it parts, their names by settings.

    separation : sigma between the least separated two of them.
    """

    text: str
    changes: Mapping[str, Any]
    rivals: tuple[Model, ...]
    separation: float
    run: Run


def next_press(recording: Recording, engine: Engine, findings: Findings) -> NextPress | None:
    """The best press to make next; None where fewer than two models are left, or no press parts them by LEAST."""
    rivals = surviving(findings)
    found = _found(recording, engine, findings, rivals) if len(rivals) > 1 else None
    return found if found is not None and found.separation >= LEAST else None


def _found(recording: Recording, engine: Engine, findings: Findings, rivals: tuple[Model, ...]) -> NextPress | None:
    """The best press, with one change or, where that does not settle it, with two."""
    judge = Judge(recording, engine, rivals, {name: value for name, (value, _) in findings.nuisances.items()})
    setup = base_setup(recording)
    if setup is None:
        return _best(judge, rivals, repeats(recording))
    first = _best(judge, rivals, [*repeats(recording), *(each.proposal() for each in (setup, *variations(setup)))])
    if first is None or first.separation >= least_separation(CONFUSED):
        return first
    again = [second for one in variations(setup) if one.changes == first.changes for second in variations(one)]
    second = _best(judge, rivals, [each.proposal() for each in again])
    return second if second is not None and second.separation > first.separation else first


def surviving(findings: Findings) -> tuple[Model, ...]:
    """What is left to tell apart: the group of the best model, else the best model and its rivals."""
    if not findings.mismatch:
        return ()
    group = findings.groups[0] if findings.groups else ()
    chosen = [findings.models[number] for number in group]
    if len(chosen) < 2:
        chosen = [model for model in findings.models if model.probability >= PLAUSIBLE]
    return tuple(chosen[:MOST_RIVALS])


def _best(judge: Judge, rivals: tuple[Model, ...], presses: Sequence[Proposal]) -> NextPress | None:
    """The press whose least separated rivals are farthest apart; None where the engine can tell of none."""
    told = []
    for press in presses:
        try:
            told.append((press, judge.separations(press)))
        except ValueError:  # beyond what the model was prepared for
            continue
    if not told:
        return None
    best, separation = told[best_press(np.array([each for _, each in told]))]
    return NextPress(best.text, best.changes, rivals, float(separation.min()), best.run)
