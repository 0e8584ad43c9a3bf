"""A design search: the largest voltage in the worse of the two boundaries, under limits on force and film stress.

The search's optima and the paper's final design on finer meshes, in 3D by both meshers, and in cross-section.

What making a segment does to a design: thicknesses and moduli off their nominal values.

Between free and clamped: sides held by springs, from none to rigid, with the paper's cases as end points.

Everything that this part solves.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geometry.arrays import Floats
from geometry.executor import Executor
from softdot.config import Config
from softdot.console import Progress
from softdot.studies.paper.beyond.designs import (
    FILMS_UM,
    PAPERS,
    Design,
    DesignPress,
    DesignTrial,
    coordinates,
    design_at,
    film,
    press_of,
    sample,
    solve_trials,
)
from softdot.studies.paper.beyond.ranking import SLICE_MESH, Ranking, Surrogate, rank
from softdot.studies.paper.published import LENGTH_MM, Reading, segment_config
from softdot.studies.paper.section import NotSolvedError, solve_named
from solve.materials.parameters import VACUUM_PERMITTIVITY

MESH = {"element_size_mm": 0.8, "contact_element_size_mm": 0.4, "mesher": "layered"}
"""Coarse: some 10 % off in voltage. What the search finds is solved again on finer meshes."""
CABLE_PF = 100.0
GOALS = {"open circuit": 0.0, "behind 100 pF": CABLE_PF}
"""What the voltage is taken behind: nothing, or a metre of cable with an amplifier that loses no charge."""
FIRST, ROUNDS, EACH = 8, 8, 3
FORCE_MARGIN, STRESS_MARGIN = 0.98, 0.9
"""Shares of the limits that the search uses: by so much force and film stress differ between meshes."""
CANDIDATES_LOG2, NEAR, STEP = 11, 1024, 0.12
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
        """What is left of a design's voltage when all of it is softened, in proportion, until it keeps them."""
        return min(1.0, self.force_N / trial.force_N, self.film_stress_MPa / trial.film_stress_MPa)


@dataclass(frozen=True)
class Search:
    """What was tried, in order: the paper's final design, FIRST designs that fill the space, then the rounds."""

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
    papers, *trials = solve_trials([PAPERS, *sample(6, seed)[:FIRST]], "solid", MESH, progress, executor)
    limits = limits_of(papers)
    for number in range(ROUNDS):
        surrogate = Surrogate([papers, *trials], constants)
        chosen = propose(surrogate, [papers, *trials], limits, number)
        trials += solve_trials(chosen, "solid", MESH, progress, executor)
    return Search(papers, trials, limits, Surrogate([papers, *trials], constants))


def limits_of(papers: DesignTrial) -> Limits:
    """Not more than the paper's final design, with the margin for the mesh, and never yield."""
    stress = min(papers.film_stress_MPa, film().yield_stress_MPa or np.inf)
    return Limits(FORCE_MARGIN * papers.force_N, STRESS_MARGIN * stress)


def to_beat(trials: Sequence[DesignTrial], limits: Limits, cable_pF: float) -> DesignTrial:
    """The best design within the limits, or the paper's, the first of trials, which stands at the bare limits."""
    inside = [trial for trial in trials[1:] if limits.allow(trial)]
    return max([trials[0], *inside], key=lambda trial: trial.worse_V(cable_pF))


def propose(surrogate: Surrogate, trials: Sequence[DesignTrial], limits: Limits, number: int) -> list[Design]:
    """EACH designs for every goal with the largest expected improvement on the best so far."""
    pool = candidates(trials, limits, number)
    known = [trial.design for trial in trials]
    for cable_pF in GOALS.values():
        gains = expected_gain(surrogate, pool, trials, limits, cable_pF)
        for _ in range(EACH):
            free = far_from(pool, known)
            known.append(pool[int(np.argmax(np.where(free, gains, -np.inf)))])
    return known[len(trials) :]


def candidates(trials: Sequence[DesignTrial], limits: Limits, number: int) -> list[Design]:
    """Designs all over the space, and near the most promising ones so far; to two digits, as one would make them.

    Promising: much voltage when everything is softened until the limits are kept.
    """
    random = np.random.default_rng(number)
    near = []
    for cable_pF in GOALS.values():
        promising = max(trials, key=lambda trial: limits.share(trial) * trial.worse_V(cable_pF))
        centre = coordinates([promising.design])
        near.append(np.clip(centre + STEP * random.standard_normal((NEAR, 7)), 0.0, 1.0))
    films = random.choice(len(FILMS_UM), 2 * NEAR)
    points = np.concatenate(near)
    points[:, -1] = (films + 0.5) / len(FILMS_UM)
    return [rounded(design) for design in [*sample(CANDIDATES_LOG2, 100 + number), *map(design_at, points)]]


def rounded(design: Design) -> Design:
    """Every variable to two digits; the film as it is sold."""
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


def far_from(designs: Sequence[Design], known: Sequence[Design]) -> Floats:
    """Which designs (n,) are no near copies of known ones."""
    steps = coordinates(designs)[:, None] - coordinates(known)[None]
    apart: Floats = np.linalg.norm(steps, axis=2).min(axis=1) > APART
    return apart


def capacitance_pF(designs: Sequence[Design]) -> Floats:
    """Of the whole film (n,)."""
    area_m2 = (1e-3 * LENGTH_MM) ** 2
    thickness_m = 1e-6 * np.array([design.film_um for design in designs])
    return np.asarray(1e12 * VACUUM_PERMITTIVITY * film().relative_permittivity * area_m2 / thickness_m)


FINER = {"element_size_mm": 0.5, "contact_element_size_mm": 0.25}
MODELS: Mapping[str, tuple[Reading, Mapping[str, Any]]] = {
    "pytetwild": ("solid", {**FINER, "mesher": "pytetwild"}),
    "layered": ("solid", {**FINER, "mesher": "layered"}),
    "cross-section": ("plane-strain", SLICE_MESH),
}
MESHERS = ("pytetwild", "layered")


def compare(optima: Sequence[Design], progress: Progress, executor: Executor) -> dict[str, list[DesignTrial]]:
    """Model -> the paper's final design and the optima, in this order. NotSolvedError."""
    designs = [PAPERS, *optima]
    found = {}
    for model, (reading, mesh) in MODELS.items():
        found[model] = solve_trials(designs, reading, mesh, progress, executor)
        if [trial.design for trial in found[model]] != designs:
            raise NotSolvedError(f"one of the designs of the final comparison did not converge, {model}")
    return found


def beats(optimum: DesignTrial, papers: DesignTrial, cable_pF: float = 0.0) -> bool:
    """More voltage in the worse boundary, with no more film stress and no more force."""
    return (
        optimum.worse_V(cable_pF) > papers.worse_V(cable_pF)
        and optimum.film_stress_MPa <= papers.film_stress_MPa
        and optimum.force_N <= papers.force_N
    )


MODULUS_SPREAD, THICKNESS_SPREAD = 0.15, 0.05
"""Standard deviations: castable silicones within 30 %, half a millimetre of cast sheet within 0.05 mm, at two sigma."""
COPIES = 400


def made(design: Design, copies: int, seed: int) -> list[Design]:
    """Copies of a design as they would come out; the same seed errs alike for every design. The film is bought."""
    luck = np.random.default_rng(seed).standard_normal((copies, 6))
    spread = [THICKNESS_SPREAD, MODULUS_SPREAD] * 3
    factors = np.exp(luck * spread)
    names = ("h1_mm", "e1_MPa", "h2_mm", "e2_MPa", "effector_height_mm", "effector_MPa")
    nominal = np.array([getattr(design, name) for name in names])
    return [replace(design, **dict(zip(names, map(float, row), strict=True))) for row in factors * nominal]


def made_worse_V(surrogate: Surrogate, design: Design, cable_pF: float = 0.0) -> Floats:
    """Worse voltage (COPIES,) of the copies by the surrogate, with its own uncertainty; the k-th err alike."""
    copies = made(design, COPIES, seed=0)
    guess = surrogate.draw(copies, COPIES, seed=1)
    worse = (guess.charge_pC / (capacitance_pF(copies) + cable_pF)).min(axis=0)
    one_draw_each: Floats = np.diagonal(worse)
    return one_draw_each


STIFFNESS_N_PER_MM3 = tuple(float(f"{k:.2g}") for k in np.geomspace(0.1, 1e4, 11))
"""Two a decade. A wall of modulus E and thickness t gives about E / t."""
PAIRS = {"final design": (0.5, 1.0), "C1 and F4": (0.8, 0.05), "C2 and F1": (0.8, 5.0)}
"""Segments of which the paper gives both ends: h1 in mm, E2 in MPa."""
WALLS = {
    "silicone shared with the neighbours, 0.5 mm of 1 MPa": 1.0 / 0.5,
    "thermoplastic polyurethane frame, 0.4 mm of 30 MPa": 30.0 / 0.4,
    "printed resin frame, 0.4 mm of 2 GPa": 2000.0 / 0.4,
}


@dataclass(frozen=True)
class Curve:
    """One segment from free to clamped; between[i] belongs to STIFFNESS_N_PER_MM3[i]."""

    free: DesignPress
    between: Sequence[DesignPress]
    clamped: DesignPress

    @property
    def presses(self) -> list[DesignPress]:
        """All, from stiffness 0 to infinity."""
        return [self.free, *self.between, self.clamped]

    def voltage_at_V(self, stiffness: float) -> float:
        """Voltage at a stiffness in N/mm³ within the range, linear in its logarithm."""
        voltages = [press.voltage_V for press in self.between]
        return float(np.interp(np.log(stiffness), np.log(STIFFNESS_N_PER_MM3), voltages))

    def half_way_N_per_mm3(self) -> float:
        """Stiffness at which half of the voltage between free and clamped is first reached; nan when never."""
        half = (self.free.voltage_V + self.clamped.voltage_V) / 2.0
        gains = np.array([press.voltage_V for press in self.between]) - half
        k = int(np.argmax(gains >= 0))
        if k == 0:
            return float("nan")
        share = gains[k - 1] / (gains[k - 1] - gains[k])
        low, high = np.log(STIFFNESS_N_PER_MM3[k - 1]), np.log(STIFFNESS_N_PER_MM3[k])
        return float(np.exp(low + share * (high - low)))


def solve_curves(progress: Progress, executor: Executor) -> Mapping[str, Curve]:
    """The curves of PAIRS in cross-section. NotSolvedError."""
    configs = {(name, side): config for name in PAIRS for side, config in _sides(name).items()}
    found = {key: press_of(outcome) for key, outcome in solve_named(configs, progress, executor).items()}
    return {
        name: Curve(found[name, "free"], [found[name, str(k)] for k in STIFFNESS_N_PER_MM3], found[name, "clamped"])
        for name in PAIRS
    }


def _sides(name: str) -> dict[str, Config]:
    """Name of the sides -> configuration, of one segment."""
    ends = {"free": segment_config("free", *PAIRS[name]), "clamped": segment_config("clamped", *PAIRS[name])}
    return {**ends, **{str(k): elastic(ends["clamped"], k) for k in STIFFNESS_N_PER_MM3}}


def elastic(config: Config, stiffness: float) -> Config:
    """The segment with the sides of its held layers on springs, in N/mm³."""
    changes = {"boundary": "elastic", "side_stiffness_N_per_mm3": stiffness}
    return config.model_copy(update={"segment": config.segment.model_copy(update=changes)})


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
