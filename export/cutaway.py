"""Pictures of the segment cut open along the dot, at rest and pressed."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from export.dot_surface import placed_dot, triangle_surface
from export.skin import (
    MM_PER_M,
    Skin,
    cut_section,
    nearby_plane,
    nodal_steps,
    outer_skin,
)
from export.view import (
    COLOUR_MAP,
    INK,
    DrawnBody,
    View,
    draw_colour_bar,
    draw_ruler,
    name_parts,
    picture_box,
    picture_page,
    render,
    save_png,
)
from foundation.arrays import Floats
from geometry.dot import DotShape
from geometry.solids import PART_COLOURS
from mesh.types import TetMesh
from solve.result import Step

OPEN_VIEW, FRONT_VIEW = View(28.0, 18.0), View(0.0, 0.0)
MEDIUM_NAMES = {"medium1": "medium 1", "medium2": "medium 2"}

FAR_APART_RATIO = 30.0
"""Largest stresses of two soft parts with a ratio above this would leave one of them without colour."""


@dataclass(frozen=True)
class CutawayScene:
    """One step, ready to be drawn.

    parts : name -> undeformed pyvista surface with point arrays displacement_mm and von_mises_MPa.
    dots : closed surfaces where they stand; plane_mm : the cut's y; view : where from.
    """

    parts: dict[str, Any]
    dots: list[Any]
    plane_mm: float
    view: View


def is_slice(tet_mesh: TetMesh) -> bool:
    """Whether the mesh is a plane-strain slice (nodes of equal x and z stand for one another)."""
    return bool(np.any(tet_mesh.twin != np.arange(len(tet_mesh.twin))))


def open_scene(tet_mesh: TetMesh, step: Step, dot_shape: DotShape) -> CutawayScene:
    """The scene of a solid segment cut along the dot, or of a plane-strain slice seen whole from the front."""
    nodes = nodal_steps(tet_mesh, [step])
    origin = step.dot_position_m * MM_PER_M
    dots = placed_dot(dot_shape, tet_mesh, origin, facets=96)
    outer = outer_skin(nodes, 2)
    if is_slice(tet_mesh):
        return CutawayScene(_surfaces_by_part(tet_mesh, [outer]), dots, 0.0, FRONT_VIEW)
    plane = nearby_plane(tet_mesh, float(origin[1]))
    cut = _surfaces_by_part(tet_mesh, [outer], lambda s: s.clip("y", origin=(0.0, plane, 0.0), invert=False))
    faces = _surfaces_by_part(tet_mesh, [cut_section(nodes, plane, 2)])
    parts = {name: cut[name].merge(faces[name]).extract_surface(algorithm="dataset_surface") for name in cut}
    dots = [dot.clip_closed_surface("y", origin=(0.0, plane, 0.0)) for dot in dots]
    return CutawayScene(parts, [dot for dot in dots if dot.n_cells], plane, OPEN_VIEW)


def draw_parts(scene: CutawayScene, title: str, path: Path) -> None:
    """Draw the parts in their colours, named, with rulers in mm, and write a PNG."""
    bodies = [DrawnBody(_deformed_surface(part), PART_COLOURS[name]) for name, part in scene.parts.items()]
    figure, axes = _draw_scene(scene, bodies, title)
    anchors, names = _name_anchors(scene)
    colours = [PART_COLOURS[name] for name in [*scene.parts, "dot"]]
    column = np.max([a[0] for a in anchors]) + 0.05 * float(np.diff(axes.get_xlim())[0])
    name_parts(axes, names, np.array(anchors), colours, column)
    save_png(figure, path)


def draw_von_mises(scene: CutawayScene, title: str, path: Path) -> None:
    """Draw the soft parts by von Mises stress, and the film, a thousand times stiffer, in its own colour.

    On one scale, or each part on its own where the stresses of the parts are far apart. Writes a PNG.
    """
    stresses = {name: part["von_mises_MPa"] for name, part in scene.parts.items() if name != "film"}
    own = {name: float(np.percentile(stress, 99)) or 1e-9 for name, stress in stresses.items()}
    apart = max(own.values()) > FAR_APART_RATIO * min(own.values())
    together = float(np.percentile(np.concatenate(list(stresses.values())), 99)) or 1.0
    tops = own if apart else dict.fromkeys(own, together)
    bodies = [_stress_body(part, tops[name]) if name in tops else DrawnBody(_deformed_surface(part), PART_COLOURS[name])
              for name, part in scene.parts.items()]  # fmt: skip
    figure, _ = _draw_scene(scene, bodies, title)
    if apart:
        parts = "\n".join(f"{name}: up to {top:.2g} MPa" for name, top in own.items())
        draw_colour_bar(figure, 0.0, 1.0, "von Mises, share of the part's scale", "max")
        figure.text(0.98, 0.78, parts, fontsize=10, color=INK, ha="right", va="bottom")
    else:
        beyond = "max" if max(stress.max() for stress in stresses.values()) > together else "neither"
        draw_colour_bar(figure, 0.0, together, "von Mises stress (MPa)", beyond)
    save_png(figure, path)


def _stress_body(part: Any, top: float) -> DrawnBody:
    """A part with colours in its surface itself, so that the light shades them like the parts' own."""
    import matplotlib

    surface = _deformed_surface(part)
    shade = np.clip(surface["von_mises_MPa"] / top, 0, 1)
    surface["rgb"] = (matplotlib.colormaps[COLOUR_MAP](shade)[:, :3] * 255).astype(np.uint8)
    return DrawnBody(surface, None)


def _draw_scene(scene: CutawayScene, bodies: list[DrawnBody], title: str) -> tuple[Any, Any]:
    """Figure and axes with bodies, edges, dot and rulers."""
    bodies += [_edge_lines(part, scene.view) for part in scene.parts.values()]
    bodies += [DrawnBody(_with_smooth_normals(dot), PART_COLOURS["dot"]) for dot in scene.dots]
    flat = np.vstack([scene.view.flat(np.asarray(b.surface.points)) for b in bodies if b.surface.n_points])
    box = picture_box(flat)
    figure, axes, pixels_per_mm = picture_page(box, title)
    image = Image.fromarray(render(bodies, scene.view, box, 2 * pixels_per_mm, smooth_edges=False)).reduce(2)
    limits = axes.get_xlim(), axes.get_ylim()
    axes.imshow(image, extent=box, interpolation="nearest", aspect="auto")  # a pixel for a pixel
    axes.set_xlim(limits[0])
    axes.set_ylim(limits[1])
    _draw_rulers(axes, scene)
    return figure, axes


def _draw_rulers(axes: Any, scene: CutawayScene) -> None:
    """Draw rulers: x along the foot of the section, z up its left edge and, where it shows, y along the right foot."""
    points = np.vstack([part.points for part in scene.parts.values()])
    (x0, y0, z0), (x1, y1, z1) = points.min(axis=0), points.max(axis=0)
    corner = np.array([x1, y0, z0])
    away_x, away_y = np.array([0.0, -1.0]), np.array([0.5, -1.0])
    draw_ruler(axes, scene.view, np.array([x0, y0, z0]), corner, "x", away_x)
    draw_ruler(axes, scene.view, np.array([x0, y0, z0]), np.array([x0, y0, z1]), "z", np.array([-1.0, 0.0]))
    if scene.view is not FRONT_VIEW:
        draw_ruler(axes, scene.view, corner, np.array([x1, y1, z0]), "y", away_y)


def _name_anchors(scene: CutawayScene) -> tuple[list[Floats], list[str]]:
    """Places (2,) where the naming lines start, on the right flank at half height, and the names with thicknesses."""
    anchors, names = [], []
    for name, part in scene.parts.items():
        z = part.points[:, 2]
        low, high = float(z.min()), float(z.max())
        flat = scene.view.flat(np.asarray(_deformed_surface(part).points))
        near = np.flatnonzero(np.abs(z - (low + high) / 2) <= 0.26 * (high - low))
        near = near if len(near) else np.arange(len(z))
        right = near[flat[near, 0] >= flat[near, 0].max() - 1e-3]
        anchors.append(flat[right].mean(axis=0))
        thick = f"{1e3 * (high - low):.0f} µm" if high - low < 0.1 else f"{high - low:.3g} mm"
        names.append(f"{MEDIUM_NAMES.get(name, name)}, {thick}")
    plate = scene.view.flat(np.asarray(scene.dots[-1].points))
    corner = plate[plate[:, 0] >= plate[:, 0].max() - 1e-3]
    return [*anchors, corner.mean(axis=0)], [*names, "rigid dot"]


def _surfaces_by_part(
    tet_mesh: TetMesh, skins: list[Skin], shape: Callable[[Any], Any] = lambda s: s
) -> dict[str, Any]:
    """Name -> one surface, from the base upwards."""
    result = {}
    for number, name in enumerate(tet_mesh.region_names):
        for skin in skins:
            own = skin.triangles[skin.region[skin.triangles[:, 0]] == number]
            surface = triangle_surface(skin.points_mm, own)
            surface["displacement_mm"] = skin.displacement_mm[0]
            surface["von_mises_MPa"] = skin.von_mises_MPa[0]
            result[name] = shape(surface.clean())
    return result


def _deformed_surface(surface: Any) -> Any:
    """The surface where the step has moved it."""
    moved = surface.copy()
    moved.points = np.asarray(moved.points) + moved["displacement_mm"]
    return moved


def _edge_lines(part: Any, view: View) -> DrawnBody:
    """Edges of a part, found on the undeformed shape and lifted a little towards the viewer."""
    edges = part.clean(tolerance=1e-6).extract_feature_edges(
        feature_angle=40, manifold_edges=False, non_manifold_edges=False, clear_data=False
    )
    if edges.n_points:
        edges = _deformed_surface(edges)
        edges.points = np.asarray(edges.points) + 0.01 * view.axes[2]
    return DrawnBody(edges, INK, 2.5)


def _with_smooth_normals(surface: Any) -> Any:
    """The surface with normals that make round faces look round and keep sharp edges."""
    return surface.compute_normals(split_vertices=True, feature_angle=30, cell_normals=False)
