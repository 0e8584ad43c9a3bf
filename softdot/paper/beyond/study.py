"""Everything that this part solves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from softdot.paper.beyond.continuum import Curve, solve_curves
from softdot.paper.beyond.final import compare
from softdot.paper.beyond.ranking import Ranking, rank
from softdot.paper.beyond.search import GOALS, Search, search
from softdot.paper.beyond.trials import Trial
from softdot.progress import Progress


@dataclass(frozen=True)
class Beyond:
    """What was solved. compared: model -> the paper's final design, then the best one for each of GOALS."""

    curves: Mapping[str, Curve]
    ranking: Ranking
    search: Search
    compared: Mapping[str, Sequence[Trial]]


def solve_beyond(progress: Progress) -> Beyond:
    """Solve what is not remembered. NotSolvedError."""
    progress.stage("between free and clamped")
    curves = solve_curves(progress)
    progress.stage("what predicts the output")
    ranking = rank(progress)
    progress.stage("design search")
    found = search(progress, dict(ranking.constants))
    progress.stage("designs compared")
    return Beyond(curves, ranking, found, compare([found.best(goal).design for goal in GOALS], progress))
