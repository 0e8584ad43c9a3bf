"""The page of part 1: the paper's formulas beside its tables, and what they leave out."""

from pathlib import Path

from foundation.executor import Executor
from softdot.progress import Progress
from softdot.studies.paper.analytical import figures
from softdot.studies.paper.analytical.claims import claims
from softdot.studies.paper.analytical.composite_table import STRETCH, composite_rows, composite_table
from softdot.studies.paper.analytical.scalars import scalar_answers
from softdot.studies.paper.analytical.stack import stiffness_ratio
from softdot.studies.paper.analytical.tables import answers, comparison, formula_values, regime_table
from softdot.studies.paper.section import Block, Figure, Heading, Section


def section(progress: Progress, folder: Path, _executor: Executor) -> Section:
    """Formulas only: takes no time. Figures go to folder / "figures"."""
    progress.stage("formulas")
    return Section(
        name="analytical-model",
        title="The paper's formulas",
        findings=[
            "The printed softness values follow from the paper's formulas except the bending softness of the "
            "thinnest clamped segment (6.10e-6 /Pa, printed 5.2e-6) and smaller slips, each marked below.",
            "The formulas leave out the stiffness of the film in its own plane, which is "
            f"{stiffness_ratio(0.8):.0f} times that of the 0.8 mm layer above it: where the sides are held, the "
            "film gives its signal because it is stretched, not because it is bent.",
        ],
        blocks=_blocks(folder),
        numbers=numbers(),
        claims=claims(),
        answers={**answers("table3"), **answers("table4"), **scalar_answers()},
    )


def numbers() -> dict[str, object]:
    """Calculated values for paper.json."""
    return {
        "table3": formula_values("table3"),
        "table4": formula_values("table4"),
        "composite_beam": composite_rows(),
        "stretch_at_full_depth": STRETCH,
        "scalars": {key: answer.ours for key, answer in scalar_answers().items()},
    }


def _blocks(folder: Path) -> list[Block]:
    return [
        "The segment is a stack. From below: medium 2, a soft layer on a fixed base; the film, 28 µm of piezoelectric "
        "PVDF; medium 1, a harder layer; and the effector, a soft skin that the dot touches. A PVDF film frees "
        "electric charge when it is strained. The paper asks which thicknesses h and Young's moduli E of the two "
        "media give the largest voltage, with free sides and with sides clamped to the case.",
        Figure(
            figures.draw_segment(folder),
            "The segment",
            "Drawn to scale for h₁ = 0.8 mm and h₂ = 2 mm, the film thickened to be seen. Height of the effector and "
            "radius of the dot are not in the paper; the values drawn are those that we use in cross-section.",
        ),
        Heading("Softness, for free sides"),
        "Two ratios come first: f = h₁/h₂ (Eq. 3) and e = E₁/E₂ (Eq. 4). The softness of a layer is how far it gives: "
        "S = h/E by an earlier work (Eq. 5), S = h/(l E) here (Eq. 6), with the length l = 2.5 mm. Pushed by u₂, the "
        "layers share the depth like two springs in series (Eq. 7): δ₁ = α₁ S_A u₂ and δ₂ = α₂ S_B u₂, with "
        "S_A = S₁/(S₁ + S₂) and S_B = S₂/(S₁ + S₂) (Eq. 9). The voltage is said to follow δ₁, δ₁ + δ₂ or δ₂ as S₂ is "
        "much larger than S₁, about equal, or much smaller (Eq. 8).",
        comparison("table3"),
        Figure(
            figures.draw_shares(folder),
            "Shares of the deflection by softness",
            "The six free cases lie on S_A. By Eq. (8) the soft-backed cases F4 to F6 should give little. S_A and S_B "
            "always add up to 1, so Eq. (8) has no maximum at S₂/S₁ = 1, where the paper sees one.",
        ),
        regime_table(),
        Heading("Bending softness, for clamped sides"),
        "With held sides medium 1 is taken as a beam. Its deflection grows with l³/(48 E I) (Eq. 10), and so the "
        "bending softness is S₁b = l³/(E₁ h₁³) (Eq. 11); the voltage is said to be proportional to it (Eq. 12). The "
        "factor 48 belongs to ends that can turn; clamped ends have 192, four times stiffer. A ratio between two "
        "designs does not depend on that factor.",
        comparison("table4"),
        Heading("What the formulas leave out"),
        "The film is thin but 400 times harder than medium 1. Its bending softness (356e-6 /Pa) is large, and the "
        "paper concludes that the film may be neglected. That holds for bending by itself. In its plane the film is "
        "the stiffest part of the stack, and it draws the neutral axis of the beam towards it.",
        composite_table(),
        Figure(
            figures.draw_stiffness(folder),
            "The film in the plane and in bending",
            "Left: the film is stiffer in its plane than any medium 1 of the paper. Right: glued on one side of "
            "medium 1 it makes the beam some four times stiffer in bending than its bending softness says.",
        ),
        "With both ends clamped a second thing happens. The film bends one way under the dot and the other way at "
        "the ends; over the whole length the two cancel exactly. One electrode over the whole film collects the "
        "mean, so bending adds nothing to its charge. What remains is stretch: the deflected film is longer than the "
        "straight one, by about 2 (u/l)². That grows with the square of the depth, and no formula of the paper, and "
        "no calculation with small deformations, contains it.",
    ]
