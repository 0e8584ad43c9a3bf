"""Tables 3 and 4 of the paper from its formulas, each printed value beside ours.

Medium 1 and film as one beam, in numbers.

The formulas that stand in the paper's running text.

Figures of the analytical part: the segment, the shares of softness, stretch against bending.
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from softdot.studies.paper.analytical.formulas import (
    FILM,
    H1_MM,
    Lamina,
    bending_softness,
    bending_stiffness_Nm,
    index_of_modulus,
    index_of_thickness,
    medium1,
    middle_curvature_per_m,
    middles_m,
    neutral_axis_m,
    output_m,
    regime,
    shares,
    softness,
    stretch_of_deflected_strip,
)
from softdot.studies.paper.published import H2_MM, INDENTATION_MM, LENGTH_MM, Published, published, table_rows
from softdot.studies.paper.section import (
    CLAMPED,
    FREE,
    LAYER_COLOURS,
    PAPER,
    SOFT,
    Answer,
    Cell,
    PaperTable,
    bars,
    label,
    new_figure,
    save,
)

MM, MPA, PER_MPA = 1e-3, 1e6, 1e6
Row = Mapping[str, float]


def softness_per_MPa(thickness_mm: float, modulus_MPa: float) -> float:
    """Eq. (6) for the segment's length, in 1e-6/Pa."""
    return PER_MPA * softness(MM * thickness_mm, MM * LENGTH_MM, MPA * modulus_MPa)


def bending_softness_per_MPa(height_mm: float, modulus_MPa: float) -> float:
    """Eq. (11) for the segment's length, in 1e-6/Pa."""
    return PER_MPA * bending_softness(MM * LENGTH_MM, MPA * modulus_MPa, MM * height_mm)


def _s1(row: Row) -> float:
    return softness_per_MPa(row["h1_mm"], row["E1_MPa"])


def _s2(row: Row) -> float:
    return softness_per_MPa(row["h2_mm"], row["E2_MPa"])


FORMULAS: dict[str, Callable[[Row], float]] = {
    "f": lambda row: index_of_thickness(row["h1_mm"], row["h2_mm"]),
    "e": lambda row: index_of_modulus(row["E1_MPa"], row["E2_MPa"]),
    "S1": _s1,
    "S2": _s2,
    "S2/S1": lambda row: _s2(row) / _s1(row),
    "S1b": lambda row: bending_softness_per_MPa(row["h1_mm"], row["E1_MPa"]),
}
HEADS = {"S1": "S₁ (10⁻⁶/Pa)", "S2": "S₂ (10⁻⁶/Pa)", "S2/S1": "S₂/S₁", "S1b": "S₁b (10⁻⁶/Pa)"}


def recomputed(table: str) -> dict[str, dict[str, float]]:
    """Case -> column -> value by its formula, for "table3" or "table4"."""
    return {
        case: {column: FORMULAS[column](row) for column in row if column in FORMULAS}
        for case, row in table_rows(table).items()
    }


def answers(table: str) -> dict[str, Answer]:
    """Our values of a table's cells; what the authors chose is taken over."""
    ours = recomputed(table)
    return {
        f"{table}.{case}.{column}": Answer(ours[case].get(column, printed))
        for case, row in table_rows(table).items()
        for column, printed in row.items()
    }


def comparison(table: str) -> PaperTable:
    """One row a case; a printed value that the formula does not give is marked beside ours."""
    rows = table_rows(table)
    columns = [column for column in next(iter(rows.values())) if column in FORMULAS]
    ours = recomputed(table)
    given = ["h1_mm", "E2_MPa"]
    return PaperTable(
        f"paper-{table}",
        f"Table {table[-1]} of the paper, from its formulas",
        ["case", "h₁ (mm)", "E₂ (MPa)", *(HEADS.get(column, column) for column in columns)],
        [
            [case, *(row[name] for name in given), *(_cell(f"{table}.{case}.{c}", ours[case][c]) for c in columns)]
            for case, row in rows.items()
        ],
        "E₁ = 5 MPa and h₂ = 2 mm in every case. A cell with an arrow: printed value → value by the paper's own "
        "formula; all others agree within the digits that are printed.",
    )


def regime_table() -> PaperTable:
    """Eq. (8) for the free cases, with both unknown factors taken as 1."""
    words = {"medium1": "S₂ ≫ S₁: medium 1 alone", "both": "S₂ ≈ S₁: both", "medium2": "S₁ ≫ S₂: medium 2 alone"}
    rows: list[list[Cell]] = []
    for case, row in recomputed("table3").items():
        pair = row["S1"], row["S2"]
        rows.append([case, row["S2/S1"], words[regime(*pair)], float(f"{output_m(1.0, *pair):.4g}")])
    return PaperTable(
        "free-regimes",
        "Which line of Eq. (8) holds for the free cases",
        ["case", HEADS["S2/S1"], "line of Eq. (8)", "predicted output / (α u₂)"],
        rows,
        "The paper gives no number for ≫; ten times is taken. Its factors α₁, α₂ are unknown and taken as 1.",
    )


def _cell(key: str, ours: float) -> Cell:
    number = published()[key]
    return f"{number.value:g} → {ours:.3g} (misprint)" if misprinted(number, ours) else float(f"{ours:.6g}")


def misprinted(number: Published, ours: float) -> bool:
    """Whether the printed digits are not those of our value, rounded."""
    digits = f"{number.value:g}"
    decimals = len(digits.partition(".")[2])
    return abs(ours - number.value) > 0.5000001 * 10.0**-decimals


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
    """What the film does to the beam."""
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


def scalar_answers() -> dict[str, Answer]:
    """Our values of the formulas that stand in the running text."""
    film = PER_MPA * bending_softness(1e-3 * LENGTH_MM, FILM.modulus_Pa, FILM.thickness_m)
    criterion = published()["section4.criterion"].value
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


LAYERS = (
    ("medium2", "medium 2", 2.0),
    ("film", "film", 0.028),
    ("medium1", "medium 1", 0.8),
    ("effector", "effector", 1.0),
)
"""Key of its colour, name and height in mm, from the base upwards."""


def draw_segment(folder: Path) -> Path:
    """The stack under its dot, with free and with held sides, to scale."""
    figure, panels = new_figure(2, height_in=3.9)
    for panel, held in zip(panels, (False, True), strict=True):
        _stack(panel, held)
    return save(figure, folder, "segment")


def _stack(panel: Any, held: bool) -> None:
    from matplotlib.patches import Circle, Rectangle

    wall: dict[str, Any] = {"facecolor": SOFT, "hatch": "////", "edgecolor": PAPER, "lw": 0}
    bottom = 0.0
    for name, words, height in LAYERS:
        drawn = max(height, 0.05)  # the film would be a hairline
        panel.add_patch(Rectangle((-1.25, bottom), 2.5, drawn, facecolor=LAYER_COLOURS[name], edgecolor=PAPER, lw=0.6))
        where = (1.55, bottom + drawn / 2)
        panel.annotate(words, (1.25, where[1]), where, fontsize=10, va="center")
        if held and name != "medium2":
            for side in (-1.37, 1.25):
                panel.add_patch(Rectangle((side, bottom), 0.12, drawn, **wall))
        bottom += height
    panel.add_patch(Rectangle((-1.45, -0.15), 2.9, 0.15, **wall))
    panel.add_patch(Circle((0, bottom + 1.15), 1.15, facecolor="#d9dde1", edgecolor=PAPER, lw=0.8))
    panel.annotate("dot, pushed down\nby 0.3 mm", (0, bottom + 0.75), ha="center", fontsize=10)
    panel.annotate("", (0, bottom + 0.12), (0, bottom + 0.68), arrowprops={"arrowstyle": "->", "color": PAPER})
    panel.set(xlim=(-1.7, 2.9), ylim=(-0.2, bottom + 1.6), aspect="equal")
    words = "clamped: case holds the sides" if held else "free: only the base is fixed"
    panel.set_title(words, fontsize=11, loc="left")
    panel.axis("off")


def draw_shares(folder: Path) -> Path:
    """S_A and S_B against S_2 / S_1, the free cases marked."""
    import numpy as np

    figure, (panel,) = new_figure(height_in=3.3)
    ratio = np.geomspace(0.1, 1000.0, 200)
    share_a, share_b = np.array([shares(1.0, value) for value in ratio]).T
    panel.semilogx(ratio, share_a, color=FREE, lw=2, label="$S_A$, share of medium 1")
    panel.semilogx(ratio, share_b, color=CLAMPED, lw=2, label="$S_B$, share of medium 2")
    panel.axvspan(0.1, 10.0, color="#eef1f4", zorder=0)
    panel.text(1.0, 1.06, "both count", ha="center", fontsize=10, color=PAPER)
    panel.text(100.0, 1.06, "medium 1 alone", ha="center", fontsize=10, color=PAPER)
    for case, row in recomputed("table3").items():
        x = row["S2/S1"]
        panel.plot(x, shares(1.0, x)[0], "o", color=FREE)
        panel.annotate(case, (x, shares(1.0, x)[0]), (0, 7), textcoords="offset points", ha="center", fontsize=9)
    panel.set_ylim(0, 1.15)
    label(panel, "$S_2 / S_1$", "share of the deflection")
    panel.legend(frameon=False, fontsize=10, loc="center right")
    return save(figure, folder, "softness-shares")


def draw_stiffness(folder: Path) -> Path:
    """Stiffness in the plane and in bending, with and without the film."""
    figure, (plane, bending) = new_figure(2)
    names = ["film", *(f"{h1:g} mm" for h1 in H1_MM)]
    heights = [1e-3 * lamina.membrane_stiffness_N_per_m for lamina in (FILM, *map(medium1, H1_MM))]
    bars(plane, names, heights, [LAYER_COLOURS["film"], *[LAYER_COLOURS["medium1"]] * len(H1_MM)], "{:.3g}")
    label(plane, "film; medium 1 by its thickness", "stiffness in the plane E h (kN/m)", "stretching")
    ratios = [bending_stiffness_Nm([FILM, medium1(h)]) / medium1(h).own_bending_stiffness_Nm for h in H1_MM]
    bars(bending, names[1:], ratios, [SOFT] * len(H1_MM), "{:.2f}")
    bending.axhline(1.0, color=PAPER, lw=1, ls="--")
    label(bending, "thickness of medium 1", "bending stiffness with film / without", "bending")
    return save(figure, folder, "film-stiffness")
