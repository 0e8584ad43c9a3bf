"""Trials that nobody solved: the corrected parameters play the solver, for tests of words, figures and the search."""

from collections.abc import Sequence

import numpy as np

from softdot.studies.paper.beyond.comparison import MODELS
from softdot.studies.paper.beyond.designs import PAPERS, Design, papers_variables, sample
from softdot.studies.paper.beyond.elastic_sides import PAIRS, STIFFNESS_N_PER_MM3, Curve
from softdot.studies.paper.beyond.predictors import clamped_deflection, clamped_voltage_V, columns, free_force_N_per_mm
from softdot.studies.paper.beyond.predictors import free_voltage_V as free_V
from softdot.studies.paper.beyond.ranking import FOUR, SEVEN, Halves, Ranking, fit
from softdot.studies.paper.beyond.search import GOALS, Search, capacitance_pF, limits_of
from softdot.studies.paper.beyond.study import Beyond
from softdot.studies.paper.beyond.surrogate import Surrogate
from softdot.studies.paper.beyond.trials import DesignPress, DesignTrial

CONSTANTS = {"tension_share": 0.25, "give": 0.4, "rest": 0.35}


def trials(designs: Sequence[Design]) -> list[DesignTrial]:
    """What the formulas give, with a film stress of the mean tension."""
    c = columns(designs)
    free, held = free_V(c, CONSTANTS["tension_share"]), clamped_voltage_V(c, CONSTANTS["give"], CONSTANTS["rest"])
    pushes = (free_force_N_per_mm(c), clamped_deflection(c, CONSTANTS["give"], CONSTANTS["rest"])[1])
    capacitance = capacitance_pF(designs)
    presses = [
        [
            DesignPress(float(force), float(volts), float(volts * farads), float(farads), float(0.1 * volts / um))
            for force, volts, farads, um in zip(push, voltages, capacitance, c.film, strict=True)
        ]
        for push, voltages in zip(pushes, (free, held), strict=True)
    ]
    return [DesignTrial(*parts) for parts in zip(designs, *presses, strict=True)]


def curve(free_V: float, clamped_V: float) -> Curve:
    """A voltage that rises evenly with the logarithm of the stiffness."""
    between = np.linspace(free_V, clamped_V, len(STIFFNESS_N_PER_MM3) + 2)
    presses = [DesignPress(volts / 10.0, volts, 24.0 * volts, 24.0, volts / 2.0) for volts in map(float, between)]
    return Curve(presses[0], presses[1:-1], presses[-1])


def ranking() -> Ranking:
    """Samples whose voltages are those of the formulas."""
    samples = {}
    for name, designs in {FOUR: papers_variables(4, 1), SEVEN: sample(4, 2)}.items():
        found = trials(designs)
        samples[name] = Halves(found[:8], found[8:])
    training = [trial for halves in samples.values() for trial in halves.fitted]
    return Ranking(samples, 32, fit(training, 1.0), fit(training, 0.0))


def study() -> Beyond:
    """A whole study."""
    papers, *found = trials([PAPERS, *sample(5, 3)])
    searched = Search(papers, found, limits_of(papers), Surrogate([papers, *found], CONSTANTS))
    optima = [searched.best(goal).design for goal in GOALS]
    compared = {model: trials([PAPERS, *optima]) for model in MODELS}
    return Beyond({name: curve(10.0, 100.0) for name in PAIRS}, ranking(), searched, compared)
