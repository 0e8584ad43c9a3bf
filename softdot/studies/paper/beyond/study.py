"""Everything that this part solves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from foundation.executor import Executor
from softdot.progress import Progress
from softdot.studies.paper.beyond.comparison import compare
from softdot.studies.paper.beyond.elastic_sides import Curve, solve_curves
from softdot.studies.paper.beyond.ranking import Ranking, rank
from softdot.studies.paper.beyond.search import GOALS, Search, search
from softdot.studies.paper.beyond.trials import DesignTrial


@dataclass(frozen=True)
class Beyond:
    """What was solved. compared: model -> the paper's final design, then the best one for each of GOALS."""

    curves: Mapping[str, Curve]
    ranking: Ranking
    search: Search
    compared: Mapping[str, Sequence[DesignTrial]]


def solve_beyond(progress: Progress, executor: Executor) -> Beyond:
    """Solve what is not remembered. NotSolvedError."""
    progress.stage("between free and clamped")
    curves = solve_curves(progress, executor)
    progress.stage("what predicts the output")
    ranking = rank(progress, executor)
    progress.stage("design search")
    found = search(progress, executor, dict(ranking.constants))
    progress.stage("designs compared")
    return Beyond(curves, ranking, found, compare([found.best(goal).design for goal in GOALS], progress, executor))
