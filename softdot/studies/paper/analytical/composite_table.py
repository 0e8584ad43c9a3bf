"""Medium 1 and film as one beam, in numbers."""

from softdot.studies.paper.analytical.composite import (
    Lamina,
    bending_stiffness_Nm,
    middle_curvature_per_m,
    middles_m,
    neutral_axis_m,
    stretch_of_deflected_strip,
)
from softdot.studies.paper.analytical.stack import FILM, H1_MM, medium1
from softdot.studies.paper.section import PaperTable
from softdot.studies.paper.segment import INDENTATION_MM, LENGTH_MM

LENGTH_M, U2_M = 1e-3 * LENGTH_MM, 1e-3 * INDENTATION_MM


STRETCH = stretch_of_deflected_strip(U2_M, LENGTH_M)
"""Of a film that follows the full depth with both ends held."""


def composite_rows() -> list[dict[str, float | None]]:
    """Medium 1 and film as one beam, for each thickness of medium 1."""
    return [_composite(h1_mm) for h1_mm in H1_MM]


def _composite(h1_mm: float) -> dict[str, float | None]:
    """Beams of a thickness beyond half their length are none: no bending strain for them."""
    laminae: list[Lamina] = [FILM, medium1(h1_mm)]
    away_m = neutral_axis_m(laminae) - middles_m(laminae)[0]
    strain = 100.0 * away_m * middle_curvature_per_m(U2_M, LENGTH_M)
    return {
        "h1_mm": h1_mm,
        "film_membrane_kN_per_m": 1e-3 * FILM.membrane_stiffness_N_per_m,
        "medium1_membrane_kN_per_m": 1e-3 * medium1(h1_mm).membrane_stiffness_N_per_m,
        "neutral_axis_from_film_um": 1e6 * away_m,
        "bending_stiffness_medium1_mN_m": 1e3 * medium1(h1_mm).own_bending_stiffness_Nm,
        "bending_stiffness_both_mN_m": 1e3 * bending_stiffness_Nm(laminae),
        "film_bending_strain_middle_percent": strain if h1_mm < LENGTH_MM / 2 else None,
    }


def composite_table() -> PaperTable:
    """Table of the beam of medium 1 with and without the film."""
    return PaperTable(
        "composite-beam",
        "Medium 1 and film as one beam",
        [
            "h₁ (mm)",
            "in-plane stiffness of the film (kN/m)",
            "of medium 1 (kN/m)",
            "neutral axis above the film's middle (µm)",
            "bending stiffness of medium 1 alone (mN m)",
            "with the film (mN m)",
            "local bending strain of the film (%)",
        ],
        [[None if value is None else _digits(value) for value in row.values()] for row in composite_rows()],
        "Per metre of width; a layer thicker than half its length is no beam any more. The neutral axis is the height "
        "that bending does not stretch. The local bending strain is the one under the dot if the film followed the "
        "full 0.3 mm with clamped ends; its mean over the length is zero. The stretch would then be "
        f"{100 * STRETCH:.1f} % along the whole length.",
    )


def _digits(value: float) -> float:
    return float(f"{value:.4g}")
