"""Maps of the film: where it is stretched and where the charge comes from."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from export.annotations import COLOUR_MAP
from export.nodal_fields import largest_principal, split_nodes
from export.units import MM_PER_M, PC_PER_MM2_PER_C_PER_M2
from export.view import DPI, HEIGHT_IN, INK, WIDTH_IN, save
from mesh.types import Floats, Ints, TetMesh
from solve.result import Step


@dataclass(frozen=True)
class FilmMap:
    """Film values averaged through the thickness, at the nodes of its upper face.

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


def film_map(tet_mesh: TetMesh, step: Step) -> FilmMap:
    """Average the film's tetrahedra column by column (one column under each upper facet), then to nodes."""
    facets = tet_mesh.facets["film-top"]
    column, weight = _columns(tet_mesh, step.fields.film_tets)
    strain = _column_mean(step.fields.film_strain, column, weight, len(facets))
    charge = _column_mean(step.fields.charge_density_C_per_m2[:, None], column, weight, len(facets))[:, 0]
    nodes, local = np.unique(facets, return_inverse=True)
    local = local.reshape(facets.shape)
    place = tet_mesh.points_mm[nodes] + step.fields.displacement_m[nodes] * MM_PER_M
    corners = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
    area = _areas(tet_mesh.points_mm, facets)
    return FilmMap(
        place[:, 0],
        place[:, 1],
        tet_mesh.points_mm[nodes, 0],
        -step.fields.displacement_m[nodes, 2] * MM_PER_M,
        local[:, corners].reshape(-1, 3),
        100 * _to_nodes(largest_principal(strain), area, local),
        PC_PER_MM2_PER_C_PER_M2 * _to_nodes(charge, area, local),
    )


def draw_film(tet_mesh: TetMesh, step: Step, title: str, path: Path, slice_: bool) -> None:
    """Two maps from above, or for a plane-strain slice two lines along x."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    shown = film_map(tet_mesh, step)
    figure = Figure(
        figsize=(WIDTH_IN, HEIGHT_IN * 0.85),
        dpi=DPI,
        facecolor="white",
        layout=ConstrainedLayoutEngine(w_pad=0.12, h_pad=0.12),
    )
    figure.suptitle(title, x=0.04, ha="left", fontsize=15, fontweight="bold", color=INK)
    for axes, values, label in zip(
        figure.subplots(1, 2),
        (shown.strain_percent, shown.charge_pC_per_mm2),
        ("largest principal strain (%)", "charge density (pC/mm²)"),
        strict=True,
    ):
        (_line if slice_ else _map)(figure, axes, shown, values, label)
    save(figure, path)


def _map(figure: Any, axes: Any, shown: FilmMap, values: Floats, label: str) -> None:
    """Colours on the deformed film, with lines of equal deflection."""
    drawn = axes.tripcolor(
        shown.x_mm, shown.y_mm, shown.triangles, values, shading="gouraud", cmap=COLOUR_MAP, rasterized=True
    )
    bar = figure.colorbar(drawn, ax=axes, location="bottom", shrink=0.9, pad=0.03)
    bar.set_label(label, fontsize=12, color=INK)
    bar.ax.tick_params(labelsize=11)
    bar.ax.locator_params(nbins=5)
    if np.ptp(shown.deflection_mm) > 1e-6:
        lines = axes.tricontour(
            shown.x_mm,
            shown.y_mm,
            shown.triangles,
            shown.deflection_mm,
            levels=4,
            colors="white",
            linewidths=0.7,
        )
        axes.clabel(lines, fmt="%.3g mm", fontsize=8)
    axes.set_aspect("equal")
    axes.set_xlabel("x (mm)", fontsize=12)
    axes.set_ylabel("y (mm)", fontsize=12)
    axes.tick_params(labelsize=11)


def _line(_figure: Any, axes: Any, shown: FilmMap, values: Floats, label: str) -> None:
    """A slice has nothing across: the value along x."""
    x, group = np.unique(np.round(shown.undeformed_x_mm, 6), return_inverse=True)
    mean = np.bincount(group, values) / np.bincount(group)
    axes.plot(x, mean, color="#b5263b", lw=1.6)
    axes.axhline(0, color=INK, lw=0.6)
    axes.set_xlabel("x (mm)", fontsize=12)
    axes.set_ylabel(label, fontsize=12)
    axes.grid(alpha=0.3)
    axes.tick_params(labelsize=11)


def _columns(tet_mesh: TetMesh, film_tets: Ints) -> tuple[Ints, Floats]:
    """For each film tetrahedron the upper facet above its centroid (k,), and its volume (k,)."""
    from matplotlib.tri import Triangulation

    facets = tet_mesh.facets["film-top"]
    nodes, local = np.unique(facets[:, :3], return_inverse=True)
    x, y = tet_mesh.points_mm[nodes, 0], tet_mesh.points_mm[nodes, 1]
    find = Triangulation(x, y, local.reshape(-1, 3)).get_trifinder()
    centroid = tet_mesh.points_mm[tet_mesh.tets[film_tets, :4]].mean(axis=1)
    column = np.asarray(find(centroid[:, 0], centroid[:, 1]), np.int64)
    return column, split_nodes(tet_mesh).weight[film_tets]


def _column_mean(values: Floats, column: Ints, weight: Floats, count: int) -> Floats:
    """Volume-weighted mean (count, c) of values (k, c) over each column."""
    inside = column >= 0
    column, weight, values = column[inside], weight[inside], values[inside]
    total = np.bincount(column, weight, count)
    sums = np.column_stack([np.bincount(column, weight * part, count) for part in values.T])
    return np.asarray(sums / np.where(total > 0, total, 1.0)[:, None])


def _to_nodes(values: Floats, area: Floats, local: Ints) -> Floats:
    """Area-weighted mean at the facets' nodes."""
    weight, flat = np.repeat(area, local.shape[1]), local.ravel()
    total = np.bincount(flat, weight * np.repeat(values, local.shape[1]))
    return np.asarray(total / np.bincount(flat, weight))


def _areas(points_mm: Floats, facets: Ints) -> Floats:
    """Areas (k,) of the flat corner triangles."""
    a, b, c = (points_mm[facets[:, i]] for i in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)
