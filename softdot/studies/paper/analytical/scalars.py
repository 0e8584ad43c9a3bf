"""The formulas that stand in the paper's running text."""

from softdot.studies.paper.analytical.beam import bending_softness
from softdot.studies.paper.analytical.stack import FILM
from softdot.studies.paper.analytical.tables import PER_MPA, bending_softness_per_MPa, softness_per_MPa
from softdot.studies.paper.published import published_numbers
from softdot.studies.paper.section import Answer
from softdot.studies.paper.segment import H2_MM, INDENTATION_MM, LENGTH_MM


def scalar_answers() -> dict[str, Answer]:
    """Our values of the formulas that stand in the running text."""
    film = PER_MPA * bending_softness(1e-3 * LENGTH_MM, FILM.modulus_Pa, FILM.thickness_m)
    criterion = published_numbers()["section4.criterion"].value
    return {
        "section4.bending-softness-0.8": Answer(bending_softness_per_MPa(0.8, 5.0)),
        "section4.bending-softness-2": Answer(bending_softness_per_MPa(2.0, 5.0)),
        "section4.bending-softness-0.5": Answer(bending_softness_per_MPa(0.5, 5.0)),
        "section4.film-bending-softness": Answer(film),
        "section4.bending-softness-limit": Answer(film / 10.0),
        "section4.softness1-0.5": Answer(softness_per_MPa(0.5, 5.0)),
        "section4.softness2-1": Answer(softness_per_MPa(H2_MM, 1.0)),
        "fig10.S2": Answer(1e-6 * softness_per_MPa(H2_MM, 1.0)),
        "section4.criterion.per-mm": Answer(1e-3 * criterion / INDENTATION_MM),
        "section4.length-over-height.section2": Answer(16.0 / 6.0, "rubber case; 3.02 with the OHP sheet"),
        "section4.length-over-height.low": Answer(LENGTH_MM / (4.0 + H2_MM)),
        "section4.length-over-height.high": Answer(LENGTH_MM / (0.8 + H2_MM), "the largest, at h₁ = 0.8 mm"),
    }
