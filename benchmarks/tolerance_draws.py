"""A tolerance budget by draws beside full presses: python -m benchmarks.tolerance_draws CONFIG [PRESSES].

PRESSES : 200 if not given, drawn as the budget draws, each pressed on the mesh of the configuration itself, moved to
its sizes. Printed are the 5, 50 and 95 % points of both, their sampling error (the jackknife over tenths of the
presses), and the linear budget: nominal, and root of the sum of the squares of the effects. A stopped run goes on.
"""

import sys
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from softdot.config.loading import load_config
from softdot.differentiation import value_of, with_changes
from softdot.executors import executor_for
from softdot.tolerances.budget import tolerance_budget
from softdot.tolerances.draws import SHARES, ToleranceBox
from softdot.tolerances.factors import with_factors
from softdot.tolerances.questions import Question, answer_all
from softdot.tolerances.responses import coarser_press
from softdot.tolerances.tolerances import tolerances

SEED = 4711


def jackknife(values: Floats, share: float, parts: int = 10) -> float:
    """Standard error of a percentile from those without a tenth of the values each."""
    left = [np.quantile(np.delete(values, np.arange(n, len(values), parts)), share) for n in range(parts)]
    return float(np.sqrt((parts - 1) * np.var(left)))


def main(config_path: Path, count: int) -> None:
    """Print both, and the linear budget."""
    config = load_config(config_path)
    own = coarser_press(config, 1.0)
    factored = with_factors(own)
    box = ToleranceBox.of(tolerances(config), lambda key: value_of(factored, key))
    places = np.random.default_rng(SEED).uniform(-1.0, 1.0, (count, len(box.rows)))
    asked = {str(n): Question(own, (), with_changes(factored, box.changes(place))) for n, place in enumerate(places)}
    with executor_for() as executor:
        budget = tolerance_budget(config, executor=executor)
        pressed = answer_all(asked, executor, lambda done, all_, _: print(f"{done} of {all_}", end="\r", flush=True))
    drawn = budget.drawn
    assert drawn is not None
    for part, name in enumerate(("force_N", "voltage_V")):
        found = np.array([pressed[key][part] for key in asked])
        for share, ours in zip(SHARES, drawn[name].values(), strict=True):
            full = float(np.quantile(found, share))
            print(
                f"{name} {100 * share:g} %: draws {ours:.4g}, {count} presses {full:.4g} "
                f"± {jackknife(found, share):.2g}, off by {100 * (ours / full - 1):+.1f} %"
            )
        print(f"{name} linear: {budget.nominal[part]:.4g} ± {budget.total[part]:.4g}; {drawn['left_out_error']}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 200)
