"""The page of part 4: between free and clamped, what softness really predicts, and a better design."""

from dataclasses import asdict
from pathlib import Path

import numpy as np

from foundation.executor import Executor
from softdot.progress import Progress
from softdot.studies.paper.beyond import figures, tables
from softdot.studies.paper.beyond.claims import claims
from softdot.studies.paper.beyond.comparison import MESHERS
from softdot.studies.paper.beyond.designs import HIGH, LOW, PAPERS
from softdot.studies.paper.beyond.elastic_sides import STIFFNESS_N_PER_MM3, WALLS, Curve
from softdot.studies.paper.beyond.ranking import CORRECTED, FOUR, SEVEN, correlations, scatter
from softdot.studies.paper.beyond.search import CABLE_PF, FIRST_TRIALS, FORCE_MARGIN, GOALS, STRESS_MARGIN
from softdot.studies.paper.beyond.study import Beyond, solve_beyond
from softdot.studies.paper.beyond.tolerance import COPIES, made_worse_V
from softdot.studies.paper.beyond.trials import BOUNDARIES, DesignTrial
from softdot.studies.paper.section import Block, Figure, Heading, Section


def section(progress: Progress, folder: Path, executor: Executor) -> Section:
    """Solve what is not remembered. Figures go to folder / "figures". NotSolvedError."""
    return section_of(solve_beyond(progress, executor), folder)


def section_of(study: Beyond, folder: Path) -> Section:
    """The section from presses that are solved."""
    return Section(
        name="beyond",
        title="Beyond the paper",
        findings=[_finding_sides(study), _finding_softness(study), _finding_design(study)],
        blocks=[*_sides(study, folder), *_softness(study, folder), *_design(study, folder)],
        numbers=numbers(study),
        claims=claims(study),
    )


def _finding_sides(study: Beyond) -> str:
    curve = study.curves["final design"]
    shared, _, printed = (curve.voltage_at_V(stiffness) for stiffness in WALLS.values())
    return (
        f"The clamped voltage of the paper's final design needs a hard case: sides shared with neighbours of silicone "
        f"give {_share(curve, shared)} of the way from free to clamped, a printed resin frame {_share(curve, printed)}."
    )


def _share(curve: Curve, voltage_V: float) -> str:
    gain = curve.clamped.voltage_V - curve.free.voltage_V
    return f"{100 * (voltage_V - curve.free.voltage_V) / gain:.0f} %"


def _finding_softness(study: Beyond) -> str:
    free, clamped = (correlations(study.ranking, FOUR, side) for side in BOUNDARIES)
    wide = correlations(study.ranking, SEVEN, "clamped")
    return (
        f"The paper's S₂/S₁ does not order free outputs (rank correlation {free['S₂/S₁']:.2f}), its bending softness "
        f"hardly the clamped ones ({clamped['S₁b']:.2f}). Softnesses that add up do, with load spreading, bonded "
        f"rubber and the stretched film counted: {free[CORRECTED]:.2f} and {clamped[CORRECTED]:.2f} on designs that no "
        f"constant was fitted to ({wide[CORRECTED]:.2f} clamped, when effector and film vary too)."
    )


def _finding_design(study: Beyond) -> str:
    pairs = [(study.compared[mesher][1], study.compared[mesher][0]) for mesher in MESHERS]
    gains = " and ".join(f"{best.worse_V() / papers.worse_V():.2g}" for best, papers in pairs)
    stress = " and ".join(f"{best.film_stress_MPa / papers.film_stress_MPa:.2f}" for best, papers in pairs)
    return (
        f"A searched design gives {gains} times the voltage of the paper's final design in the worse boundary, in a "
        f"true segment solved by two meshers, at {stress} times its film stress; {_finding_cable(study)}."
    )


def _finding_cable(study: Beyond) -> str:
    """Whether the order changes behind a cable."""
    papers, best, other = study.compared["layered"]
    ratio, own = (trial.worse_V(CABLE_PF) / papers.worse_V(CABLE_PF) for trial in (best, other))
    words = "another design is better there" if own > 1.05 * ratio else "no other design is better there"
    return f"behind {CABLE_PF:g} pF of cable it gives {ratio:.2g} times, and {words} ({own:.2g} times)"


def _sides(study: Beyond, folder: Path) -> list[Block]:
    halves = ", ".join(f"{curve.half_way_N_per_mm3():.2g} ({name})" for name, curve in study.curves.items())
    return [
        "The paper concludes that a real sensor lies between its two boundaries, but simulates "
        "nothing between them. This section does, applies the softness parameters of the paper to designs that it "
        "never tried, and searches for a better design.",
        Heading("From free to clamped"),
        "The sides of effector, medium 1 and film are held by springs, of a stiffness in newtons per square millimetre "
        "of side and millimetre of way. Zero is the paper's free boundary, infinity its clamped one.",
        Figure(
            figures.draw_curves(study.curves, folder),
            "Voltage and force against the stiffness of the sides",
            "Circles and squares: the paper's free and clamped cases. Dotted: silicone shared with the neighbours, a "
            "frame of thermoplastic polyurethane, a frame of printed resin.",
        ),
        tables.sides(study.curves),
        f"Half of the gain needs {halves} N/mm³. The force is nearly that of the clamped case long before the voltage "
        "is: soft springs stop the rubber, but only stiff ones stop the thin film.",
    ]


def _softness(study: Beyond, folder: Path) -> list[Block]:
    ranking = study.ranking
    solved = sum(len(part) for halves in ranking.samples.values() for part in (halves.fitted, halves.held_out))
    constants = ", ".join(f"{name.replace('_', ' ')} {value:.2f}" for name, value in ranking.constants.items())
    factors = ", ".join(
        f"{scatter(halves.held_out, side, ranking):.2g} ({side}, {name})"
        for name, halves in ranking.samples.items()
        for side in BOUNDARIES
    )
    return [
        Heading("Which softness predicts the output"),
        f"{ranking.asked} designs that fill the space evenly (scrambled Sobol sequence, logarithmic), each free and "
        f"clamped, in cross-section: half vary the paper's h₁, E₁, h₂, E₂ alone, half the effector and the film too. "
        f"{solved} converged. Constants were fitted to one half of each sample; everything shown is the other half.",
        Figure(
            figures.draw_correlations(ranking, folder),
            "How well each parameter orders the designs",
            "1 is perfect, 0 is chance. Signs are in the table.",
        ),
        tables.ranks(ranking),
        "The corrected free parameter is the paper's own Eq. (7) taken seriously: softnesses add up, and the film's "
        "pull goes with the force. Two corrections: the load spreads by 45° from the width of the contact, and rubber "
        "bonded between base and film is stiffer by the shape factor 1 + (l/2h₂)². The voltage is then g₃₁ N with a "
        "film tension N in proportion to the force. The thickness of the film drops out, as it is so much stiffer than "
        "the rubber that it takes the whole tension.",
        "The corrected clamped parameter solves one equation for the deflection w of the film: the local softness "
        "above it against shear of the held layers, medium 2 as a foundation, and the stretch of the film, which "
        "grows with w³. The voltage follows from the strain (8/3)(w/l)² and the film's thickness.",
        f"Fitted: {constants} (film tension over force; a factor on the local softness; its share where the whole "
        f"length is loaded). Typical factor between predicted and solved voltage, held out: {factors}.",
        Figure(
            figures.draw_predicted(ranking, folder),
            "Predicted and solved voltage of held-out designs",
            "Line: equal; dotted: a factor of two.",
        ),
    ]


def _design(study: Beyond, folder: Path) -> list[Block]:
    search, limits = study.search, study.search.limits
    optima = [trial.design for trial in study.compared[MESHERS[0]][1:]]
    named = tables.named_designs(optima, list(GOALS))
    labels = [name.replace(", ", ",\n") for name in named]
    return [
        Heading("A better design"),
        "Searched: the largest voltage in the worse of the two boundaries, in a true segment of 2.5 × 2.5 mm under a "
        f"round dot. Free: {_ranges()}, and the films that are sold. Limits, in both boundaries: the force and the "
        f"largest film stress of the paper's final design, which is below yield. The search keeps "
        f"{100 * FORCE_MARGIN:.0f} and {100 * STRESS_MARGIN:.0f} % of them ({limits.force_N:.2g} N, "
        f"{limits.film_stress_MPa:.2g} MPa on its coarse mesh), as another mesh gives slightly other numbers.",
        f"After {FIRST_TRIALS} designs that fill the space, Gaussian processes of voltage, force and stress, with the "
        "corrected parameters as trend, name the designs with the largest expected improvement; "
        "each is solved and teaches them.",
        Figure(
            figures.draw_search(search, folder),
            "The search",
            f"Left: every design tried, in order (dotted: end of the first {FIRST_TRIALS}). Crosses break a limit. "
            "Right: free against clamped; above the dotted diagonal the free boundary is the worse one.",
        ),
        tables.designs(named),
        Figure(
            figures.draw_final(study.compared, labels, folder),
            "The designs solved again on finer meshes",
            "Blue free, red clamped; strong pytetwild, pale layered.",
        ),
        tables.final(study.compared, list(named)),
        _uncertainty(study),
        f"{_finding_cable(study)[0].upper()}{_finding_cable(study)[1:]}: a thick film gives voltage by its thickness, "
        "not charge, and a cable shares out the charge.",
    ]


def _ranges() -> str:
    words = {"h1_mm": "h₁", "e1_MPa": "E₁", "h2_mm": "h₂", "e2_MPa": "E₂", "effector_height_mm": "effector height",
             "effector_MPa": "effector E"}  # fmt: skip
    return ", ".join(
        f"{word} {getattr(LOW, key):g} to {getattr(HIGH, key):g} {key.split('_')[-1]}" for key, word in words.items()
    )


def _uncertainty(study: Beyond) -> str:
    """Paragraph on how sure the improvement is when segments are made."""
    best, papers = (made_worse_V(study.search.surrogate, design) for design in (_best(study).design, PAPERS))
    low, high, papers_low, papers_high = (
        float(np.quantile(values, level)) for values in (best, papers) for level in (0.05, 0.95)
    )
    return (
        f"Made with thicknesses within 10 % and moduli within 30 %, the best design gives {low:.2g} to {high:.2g} V in "
        f"its worse boundary and the paper's {papers_low:.2g} to {papers_high:.2g} V (90 % of {COPIES} copies, by the "
        "surrogate with its own uncertainty, coarse mesh); the best design is ahead in "
        f"{100 * (best > papers).mean():.0f} % of pairs that err alike. The film's d₃₁, ±20 % from "
        "lot to lot, moves both alike."
    )


def _best(study: Beyond) -> DesignTrial:
    return study.search.best("open circuit")


def numbers(study: Beyond) -> dict[str, object]:
    """Solved values for paper.json."""
    ranking, search = study.ranking, study.search
    return {
        "sides": {
            name: {
                "stiffness_N_per_mm3": [0.0, *STIFFNESS_N_PER_MM3, None],
                "presses": [asdict(press) for press in curve.presses],
                "half_way_N_per_mm3": curve.half_way_N_per_mm3(),
            }
            for name, curve in study.curves.items()
        },
        "ranking": {
            "constants": ranking.constants,
            "constants_without_film": ranking.constants_without_film,
            "rank_correlation": {
                sample: {side: correlations(ranking, sample, side) for side in BOUNDARIES} for sample in ranking.samples
            },
            "samples": {sample: asdict(halves) for sample, halves in ranking.samples.items()},
        },
        "search": {
            "limits": asdict(search.limits),
            "papers": asdict(search.papers),
            "trials": [asdict(trial) for trial in search.trials],
        },
        "compared": {model: [asdict(trial) for trial in trials] for model, trials in study.compared.items()},
    }
