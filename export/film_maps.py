"""Maps of the film: its strain, and where its charge arises."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from export.cutaway import is_slice
from export.nodal_values import largest_principal
from export.recovery import film_patches
from export.skin import MM_PER_M, PC_PER_MM2_PER_C_PER_M2
from export.view import (
    COLOUR_MAP,
    DIVERGING,
    DPI,
    HEIGHT_IN,
    INK,
    WIDTH_IN,
)
from foundation.arrays import Floats, Ints
from geometry.electrode_outlines import electrode_corners
from geometry.parameters import Electrode
from mesh.types import TetMesh
from solve.result import FilmPeak, Step

if TYPE_CHECKING:
    from matplotlib.figure import Figure


SMALL_STRAIN, SMALL_DENSITY_PC_PER_MM2 = 1e-3, 0.1


@dataclass(frozen=True)
class FilmMap:
    """Film values, means through the thickness, at the nodes of its upper face.

    x_mm, y_mm, deflection_mm : (n,) deformed place and movement against z; undeformed_x_mm : (n,)
    triangles : (t, 3); strain_percent, charge_pC_per_mm2 : (n,)
    """

    x_mm: Floats
    y_mm: Floats
    undeformed_x_mm: Floats
    deflection_mm: Floats
    triangles: Ints
    strain_percent: Floats
    charge_pC_per_mm2: Floats


@dataclass(frozen=True)
class Scale:
    """The meaning of a colour or a height: label with unit, ends, name of the colour map."""

    label: str
    low: float
    high: float
    colours: str

    @property
    def top(self) -> float:
        """The upper end; one where all is zero, at rest."""
        return self.high or 1.0

    def beyond(self, values: Floats) -> str:
        """Which ends of a colour bar have values beyond them, in matplotlib's words."""
        under, over = bool(values.min() < self.low), bool(values.max() > self.top)
        return {(True, True): "both", (True, False): "min", (False, True): "max"}.get((under, over), "neither")


def film_map(tet_mesh: TetMesh, step: Step) -> FilmMap:
    """Values of the film at the nodes of its upper face, as every picture and file has them."""
    facets = tet_mesh.facets["film-top"]
    nodes, local = np.unique(facets, return_inverse=True)
    local = local.reshape(facets.shape)
    place = tet_mesh.points_mm[nodes] + step.fields.displacement_m[nodes] * MM_PER_M
    corners = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
    patches, count = film_patches(tet_mesh), len(tet_mesh.points_mm)
    return FilmMap(
        place[:, 0],
        place[:, 1],
        tet_mesh.points_mm[nodes, 0],
        -step.fields.displacement_m[nodes, 2] * MM_PER_M,
        local[:, corners].reshape(-1, 3),
        100 * largest_principal(patches.at_nodes(step.fields.film_strain, count)[nodes]),
        PC_PER_MM2_PER_C_PER_M2 * patches.at_nodes(step.fields.charge_density_C_per_m2, count)[nodes],
    )


def film_figure(tet_mesh: TetMesh, step: Step, peak: FilmPeak, electrodes: Sequence[Electrode] = ()) -> "Figure":
    """Strain and charge of the film: two maps from above, or for a plane-strain slice two lines along x.

    In the range of the stated largest values; those beyond it, at a held rim, have the colour of its end.
    electrodes : drawn with their names.
    """
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    shown = film_map(tet_mesh, step)
    figure = Figure(
        figsize=(WIDTH_IN, HEIGHT_IN * 0.85),
        dpi=DPI,
        facecolor="white",
        layout=ConstrainedLayoutEngine(w_pad=0.12, h_pad=0.12),
    )
    title = f"Film at {step.indentation_m * MM_PER_M:.3g} mm"
    figure.suptitle(title, x=0.04, ha="left", fontsize=15, fontweight="bold", color=INK)
    left, right = figure.subplots(1, 2)
    draw = _draw_line if is_slice(tet_mesh) else _draw_map
    factor, unit = strain_unit(peak.strain)
    strain = Scale(f"largest principal strain ({unit})", 0.0, factor * peak.strain, COLOUR_MAP)
    draw(figure, left, shown, 0.01 * factor * shown.strain_percent, strain)
    most = PC_PER_MM2_PER_C_PER_M2 * max(abs(density) for density in peak.charge_density_C_per_m2)
    factor, unit = (1e3, "fC/mm²") if most < SMALL_DENSITY_PC_PER_MM2 else (1.0, "pC/mm²")
    most *= factor
    charge = Scale(f"charge density ({unit})", -most, most, DIVERGING)
    draw(figure, right, shown, factor * shown.charge_pC_per_mm2, charge)
    for axes in (left, right):
        _draw_electrodes(axes, electrodes, is_slice(tet_mesh), axes is right)
    return figure


def _draw_electrodes(axes: Any, electrodes: Sequence[Electrode], sliced: bool, named: bool) -> None:
    """Draw outlines of electrodes at rest on a map, or as bars below the line of a slice; named : and their names."""
    from matplotlib.patches import Polygon

    for electrode in electrodes:
        corners = np.array(electrode_corners(electrode))
        name = electrode.name.removeprefix("segment-")
        if sliced:
            ends = corners[:, 0].min(), corners[:, 0].max()
            axes.plot(ends, (0.02, 0.02), transform=axes.get_xaxis_transform(), color=INK, lw=3, solid_capstyle="butt")
            axes.text(np.mean(ends), 0.035, name, transform=axes.get_xaxis_transform(), ha="center", fontsize=9)
            continue
        axes.add_patch(Polygon(corners, fill=False, edgecolor=INK if named else "white", lw=1.2, ls=(0, (4, 2))))
        if named:
            place = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
            box = {"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 1.0}
            axes.text(*place, name, ha="center", va="center", fontsize=9, color=INK, bbox=box)


def strain_unit(strain: float) -> tuple[float, str]:
    """Factor and unit in which a strain is easily read.

    >>> strain_unit(0.02), strain_unit(9e-6)
    ((100.0, '%'), (1000000.0, 'µm/m'))
    """
    return (1e6, "µm/m") if abs(strain) < SMALL_STRAIN else (100.0, "%")


def _draw_map(figure: Any, axes: Any, shown: FilmMap, values: Floats, scale: Scale) -> None:
    """Draw colours on the deformed film, with lines of equal deflection."""
    drawn = axes.tripcolor(
        shown.x_mm,
        shown.y_mm,
        shown.triangles,
        values,
        shading="gouraud",
        cmap=scale.colours,
        vmin=scale.low,
        vmax=scale.top,
        rasterized=True,
    )
    bar = figure.colorbar(drawn, ax=axes, location="bottom", shrink=0.9, pad=0.03, extend=scale.beyond(values))
    bar.set_label(scale.label, fontsize=12, color=INK)
    if scale.low < 0.0:
        bar.ax.axvline(0.0, color=INK, lw=1.2)
    bar.ax.tick_params(labelsize=11)
    bar.ax.locator_params(nbins=5)
    if np.ptp(shown.deflection_mm) > 1e-6:
        lines = axes.tricontour(
            shown.x_mm,
            shown.y_mm,
            shown.triangles,
            shown.deflection_mm,
            levels=4,
            colors=INK if scale.low < 0.0 else "white",
            linewidths=0.7,
        )
        axes.clabel(lines, fmt="%.3g mm", fontsize=8)
    axes.set_aspect("equal")
    axes.set_xlabel("x (mm)", fontsize=12)
    axes.set_ylabel("y (mm)", fontsize=12)
    axes.tick_params(labelsize=11)


def _draw_line(_figure: Any, axes: Any, shown: FilmMap, values: Floats, scale: Scale) -> None:
    """Draw the value along x, for a slice, in which nothing varies across."""
    x, group = np.unique(np.round(shown.undeformed_x_mm, 6), return_inverse=True)
    mean = np.bincount(group, values) / np.bincount(group)
    axes.plot(x, mean, color="#b5263b", lw=1.6)
    axes.axhline(0, color=INK, lw=0.6)
    axes.set_xlabel("x (mm)", fontsize=12)
    axes.set_ylabel(scale.label, fontsize=12)
    axes.set_ylim(1.05 * scale.low, 1.05 * scale.top)
    axes.grid(alpha=0.3)
    axes.locator_params(nbins=5)
    axes.tick_params(labelsize=11)
