"""A tolerance budget by draws beside full presses: python -m benchmarks.tolerance_draws CONFIG [PRESSES].

PRESSES : 200 if not given, drawn as the budget draws, each pressed on the mesh of the configuration itself, moved to
its sizes. The process of the budget answers the same draws, so that no chance of sampling is between the two. Printed
are the 5, 50 and 95 % points of both, with what the sampling alone would make of them (the jackknife over tenths of
the presses), the error of single draws, and the linear budget: nominal, and root of the sum of the squares of the
effects. Both leave out what the budget knows at both ends alone: a dot beside its place, which has no mirror planes and
takes four times as long. A stopped run goes on.
"""

import sys
from pathlib import Path
from unittest.mock import patch

import numpy as np

from foundation.arrays import Floats
from foundation.executor import Executor
from softdot.config.loading import load_config
from softdot.config.schema import Config
from softdot.differentiation import value_of
from softdot.executors import executor_for
from softdot.tolerances import budget as budgets
from softdot.tolerances.draws import SHARES, BoxProcess, ToleranceBox, box_questions
from softdot.tolerances.factors import with_factors
from softdot.tolerances.questions import Question, answer_all, coarser_press
from softdot.tolerances.tolerances import tolerances

SEED = 4711


def jackknife(values: Floats, share: float, parts: int = 10) -> float:
    """Standard error of a percentile from those without a tenth of the values each."""
    left = [np.quantile(np.delete(values, np.arange(n, len(values), parts)), share) for n in range(parts)]
    return float(np.sqrt((parts - 1) * np.var(left)))


def box_process(config: Config, box: ToleranceBox, executor: Executor) -> BoxProcess:
    """The process as the budget makes it, from presses that it has kept."""
    fine, coarse = (coarser_press(config, factor) for factor in (budgets.MESH_FACTOR, budgets.CHECK_FACTOR))
    keys = tuple(sorted({key for row in tolerances(config) for key in row.slopes}))
    asked = {"fine": Question(fine, keys), "coarse": Question(coarse, keys), **box_questions(coarse, box, keys)}
    finer, *coarser = answer_all(asked, executor, lambda *_: None).values()
    return BoxProcess(box, finer, coarser)


def main(config_path: Path, count: int) -> None:
    """Print both, and the linear budget."""
    config = load_config(config_path)
    own = coarser_press(config, 1.0)
    factored = with_factors(own)
    box = ToleranceBox.of(tolerances(config), lambda key: value_of(factored, key))
    places = np.random.default_rng(SEED).uniform(-1.0, 1.0, (count, len(box.rows)))
    asked = {str(n): Question(own, changes=box.changes(place)) for n, place in enumerate(places)}
    with executor_for() as executor, patch.object(budgets, "shifts", lambda _: []):
        budget = budgets.tolerance_budget(config, executor=executor)
        pressed = answer_all(asked, executor, lambda done, all_, _: print(f"{done} of {all_}", end="\r", flush=True))
        process = box_process(config, box, executor)
    answered = np.exp(process.logs(places))
    for part, name in enumerate(("force_N", "voltage_V")):
        found = np.abs([pressed[key].nominal[part] for key in asked])
        for share in SHARES:
            full, ours = np.quantile(found, share), np.quantile(answered[:, part], share)
            print(
                f"{name} {100 * share:g} %: process {ours:.4g}, {count} presses {full:.4g}, off by "
                f"{100 * (ours / full - 1):+.1f} %; by sampling alone ± {100 * jackknife(found, share) / full:.1f} %"
            )
        single = 100 * (answered[:, part] / found - 1)
        print(f"{name}: single draws off by {single.mean():+.1f} %, {single.std():.1f} % about that")
        print(
            f"{name} linear: {budget.nominal[part]:.4g} ± {budget.total[part]:.4g}; left out {process.missed[part]:.3f}"
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 200)
