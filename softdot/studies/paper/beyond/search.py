"""A design search: the largest voltage in the worse of the two boundaries, under limits on force and film stress."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from foundation.arrays import Floats
from foundation.executor import Executor
from softdot.progress import Progress
from softdot.reading.designs.search import choose_apart, steps_beside
from softdot.studies.paper.beyond.designs import FILMS_UM, PAPERS, Design, coordinates, design_at, sample
from softdot.studies.paper.beyond.predictors import film
from softdot.studies.paper.beyond.surrogate import Surrogate
from softdot.studies.paper.beyond.trials import DesignTrial, solve_trials
from softdot.studies.paper.segment import LENGTH_MM
from solve.materials.parameters import VACUUM_PERMITTIVITY

MESH = {"element_size_mm": 0.8, "contact_element_size_mm": 0.4, "mesher": "layered"}
"""Coarse: some 10 % off in voltage. What the search finds is solved again on finer meshes."""
CABLE_PF = 100.0
GOALS = {"open circuit": 0.0, "behind 100 pF": CABLE_PF}
"""What the voltage is taken behind: nothing, or a metre of cable with an amplifier that loses no charge."""
FIRST_TRIALS, SEARCH_ROUNDS, TRIALS_A_ROUND = 8, 8, 3
FORCE_MARGIN, STRESS_MARGIN = 0.98, 0.9
"""Shares of the limits that the search uses: by so much force and film stress differ between meshes."""
CANDIDATES_LOG2, NEAR = 11, 1024
DRAWS, APART = 64, 0.15


@dataclass(frozen=True)
class Limits:
    """What a design must not exceed, in either boundary."""

    force_N: float
    film_stress_MPa: float

    def allow(self, trial: DesignTrial) -> bool:
        """Whether a design keeps them."""
        return trial.force_N <= self.force_N and trial.film_stress_MPa <= self.film_stress_MPa

    def share(self, trial: DesignTrial) -> float:
        """Share of its voltage that a design keeps when all of it is softened, in proportion, until it keeps to these
        limits.
        """
        return min(1.0, self.force_N / trial.force_N, self.film_stress_MPa / trial.film_stress_MPa)


@dataclass(frozen=True)
class Search:
    """What was tried, in order: the paper's final design, FIRST_TRIALS designs that fill the space, then the rounds."""

    papers: DesignTrial
    trials: Sequence[DesignTrial]
    limits: Limits
    surrogate: Surrogate
    """Of all trials."""

    def best(self, goal: str) -> DesignTrial:
        """The best design within the limits; the paper's own when none is better."""
        return to_beat([self.papers, *self.trials], self.limits, GOALS[goal])


def search(progress: Progress, executor: Executor, constants: dict[str, float], seed: int = 2) -> Search:
    """Search in 3D under a round dot. constants : of the corrected parameters, which carry the trend."""
    papers, *trials = solve_trials([PAPERS, *sample(6, seed)[:FIRST_TRIALS]], "solid", MESH, progress, executor)
    limits = limits_of(papers)
    for number in range(SEARCH_ROUNDS):
        surrogate = Surrogate([papers, *trials], constants)
        chosen = propose(surrogate, [papers, *trials], limits, number)
        trials += solve_trials(chosen, "solid", MESH, progress, executor)
    return Search(papers, trials, limits, Surrogate([papers, *trials], constants))


def limits_of(papers: DesignTrial) -> Limits:
    """Limits of a search: not more than the paper's final design, with the margin for the mesh, and never yield."""
    stress = min(papers.film_stress_MPa, film().yield_stress_MPa or np.inf)
    return Limits(FORCE_MARGIN * papers.force_N, STRESS_MARGIN * stress)


def to_beat(trials: Sequence[DesignTrial], limits: Limits, cable_pF: float) -> DesignTrial:
    """The best design within the limits, or the paper's, the first of trials, which stands at the bare limits."""
    inside = [trial for trial in trials[1:] if limits.allow(trial)]
    return max([trials[0], *inside], key=lambda trial: trial.worse_V(cable_pF))


def propose(surrogate: Surrogate, trials: Sequence[DesignTrial], limits: Limits, number: int) -> list[Design]:
    """TRIALS_A_ROUND designs for every goal with the largest expected improvement on the best so far."""
    pool = candidates(trials, limits, number)
    known = [trial.design for trial in trials]
    for cable_pF in GOALS.values():
        gains = expected_gain(surrogate, pool, trials, limits, cable_pF)
        chosen = choose_apart(gains, coordinates(pool), coordinates(known), TRIALS_A_ROUND, APART)
        known += [pool[one] for one in chosen]
    return known[len(trials) :]


def candidates(trials: Sequence[DesignTrial], limits: Limits, number: int) -> list[Design]:
    """Designs all over the space, and near the most promising ones so far; to two digits, as one would make them.

    Promising: much voltage when everything is softened until the limits are kept.
    """
    random = np.random.default_rng(number)
    near = []
    for cable_pF in GOALS.values():
        promising = max(trials, key=lambda trial: limits.share(trial) * trial.worse_V(cable_pF))
        near.append(steps_beside(coordinates([promising.design])[0], NEAR, random))
    films = random.choice(len(FILMS_UM), 2 * NEAR)
    points = np.concatenate(near)
    points[:, -1] = (films + 0.5) / len(FILMS_UM)
    return [round_design(design) for design in [*sample(CANDIDATES_LOG2, 100 + number), *map(design_at, points)]]


def round_design(design: Design) -> Design:
    """The design with every variable to two digits; the film as it is sold."""
    values = {name: float(f"{value:.2g}") for name, value in vars(design).items()}
    return replace(design, **{**values, "film_um": design.film_um})


def expected_gain(
    surrogate: Surrogate, designs: Sequence[Design], trials: Sequence[DesignTrial], limits: Limits, cable_pF: float
) -> Floats:
    """Mean gain (n,) over the best so far, relative to it; draws that break a limit gain nothing."""
    guess = surrogate.draw(designs, DRAWS, seed=0)
    within = (guess.force_N <= limits.force_N) & (guess.film_stress_MPa <= limits.film_stress_MPa)
    worse = (guess.charge_pC / (capacitance_pF(designs) + cable_pF)).min(axis=0)
    so_far = to_beat(trials, limits, cable_pF).worse_V(cable_pF)
    gain: Floats = np.where(within.all(axis=0), np.maximum(worse / so_far - 1.0, 0.0), 0.0).mean(axis=0)
    return gain


def capacitance_pF(designs: Sequence[Design]) -> Floats:
    """Capacitance (n,) of the whole film of each design."""
    area_m2 = (1e-3 * LENGTH_MM) ** 2
    thickness_m = 1e-6 * np.array([design.film_um for design in designs])
    return np.asarray(1e12 * VACUUM_PERMITTIVITY * film().relative_permittivity * area_m2 / thickness_m)
