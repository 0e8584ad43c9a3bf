"""Pictures of the build sheet: the kit taken apart and cut open, every mould, and each step."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from export.build_sheet.contents import Contents, layer_title
from export.cut_files.dxf import draw_cut_file
from export.printability import draw_findings
from export.printability.surface import surface_of
from export.view import DPI, INK, DrawnBody, View, name_parts, picture_box, picture_page, render
from geometry.fabrication.device import Device
from geometry.flat.pattern import Outline
from geometry.solids import PART_COLOURS

VIEW_FROM_ABOVE = View(28.0, 32.0)
FACET_DEG, SHARPNESS, MARGIN_PX = 25.0, 1.5, 30


@dataclass(frozen=True)
class Thing:
    """A closed pyvista surface in mm, its colour, and its name where it is to be written beside it."""

    surface: Any
    colour: str
    name: str = ""

    def lift(self, by_mm: float) -> "Thing":
        """The thing moved up."""
        return replace(self, surface=self.surface.translate((0.0, 0.0, by_mm), inplace=False))

    def move(self, x_mm: float, y_mm: float) -> "Thing":
        """The thing moved sideways."""
        return replace(self, surface=self.surface.translate((x_mm, y_mm, 0.0), inplace=False))

    def cut_open(self, y_mm: float) -> "Thing":
        """Half of the thing behind a plane of constant y, closed."""
        return replace(self, surface=self.surface.clip_closed_surface("y", origin=(0.0, y_mm, 0.0)))


def solid_thing(solid: Any, colour: str | tuple[float, float, float], name: str = "") -> Thing:
    """The thing of a build123d solid."""
    import pyvista

    if not isinstance(colour, str):
        colour = "#" + "".join(f"{round(255 * part):02x}" for part in colour)
    return Thing(pyvista.wrap(surface_of(solid)), colour, name)


def sheet_thing(outline: Outline, bottom_mm: float, thickness_mm: float, colour: str, name: str = "") -> Thing:
    """The thing of a flat outline with a thickness."""
    import pyvista

    points = np.array([(x, y, bottom_mm) for x, y in outline.points])
    flat = pyvista.PolyData(points, faces=[len(points), *range(len(points))]).triangulate()
    return Thing(flat.extrude((0.0, 0.0, thickness_mm), capping=True), colour, name)


def draw_things(things: Sequence[Thing], title: str, path: Path) -> None:
    """Draw things from above with their names and write a PNG. InputError without OpenGL."""
    view = VIEW_FROM_ABOVE
    shown = [thing for thing in things if thing.surface.n_points]
    box = picture_box(np.vstack([view.flat(np.asarray(thing.surface.points)) for thing in shown]))
    figure, axes, pixels_per_mm = picture_page(box, title)
    bodies = [DrawnBody(_with_sharp_normals(thing.surface), thing.colour) for thing in shown]
    bodies += [DrawnBody(_sharp_edges(thing.surface, view), INK, 2.0) for thing in shown]
    limits = axes.get_xlim(), axes.get_ylim()
    image = render(bodies, view, box, SHARPNESS * pixels_per_mm)
    axes.imshow(image, extent=box, interpolation="antialiased", aspect="auto")
    axes.set_xlim(limits[0])
    axes.set_ylim(limits[1])
    named = [thing for thing in shown if thing.name]
    anchors = np.array([_anchor(thing.surface, view) for thing in named])
    column = box[1] + 0.03 * (limits[0][1] - limits[0][0])
    if named:
        name_parts(axes, [thing.name for thing in named], anchors, [thing.colour for thing in named], column)
    _save_cropped(figure, path)


def _save_cropped(figure: Any, path: Path) -> None:
    """Write a PNG without the empty upper and lower ends of the page."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.image import imsave

    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())
    rows = np.flatnonzero((pixels[..., :3] < 255).any(axis=(1, 2)))
    imsave(path, pixels[max(rows[0] - MARGIN_PX, 0) : rows[-1] + MARGIN_PX], dpi=DPI)


def _with_sharp_normals(surface: Any) -> Any:
    """The surface with normals that keep sharp edges."""
    return surface.compute_normals(split_vertices=True, feature_angle=FACET_DEG, cell_normals=False)


def _sharp_edges(surface: Any, view: View) -> Any:
    """Sharp edges of a surface, moved a little towards the viewer."""
    edges = surface.clean().extract_feature_edges(
        feature_angle=FACET_DEG, manifold_edges=False, non_manifold_edges=False, boundary_edges=False
    )
    if edges.n_points:
        edges.points = np.asarray(edges.points) + 0.01 * view.axes[2]
    return edges


def _anchor(surface: Any, view: View) -> Any:
    """Place on the picture (2,) of the rightmost corner of a surface's top, which is seldom hidden."""
    points = np.asarray(surface.points, np.float64)  # in single precision, the step below vanishes above 16 mm
    flat = view.flat(points[points[:, 2] > points[:, 2].max() - 1e-6])
    return flat[int(np.argmax(flat[:, 0]))]


APART_PER_WIDTH = 1.1
"""Distance between things that are drawn apart, in widths of the device."""
MOST_APART_PER_HEIGHT = 1.0
"""Largest such distance of a wide device, in heights of it."""
MOULD_APART_PER_WIDTH = 0.6
"""Distance between the parts of an opened mould, in sizes of its largest part."""
METAL_COLOUR, METAL_MM = "#e3a93c", 0.004

Group = list[Thing]


def draw_all(contents: Contents, cut: Path, folder: Path) -> None:
    """Write every picture into a folder. cut : folder of the DXF files. InputError without OpenGL."""
    drawer = Drawer(contents, folder)
    drawer.draw_device()
    drawer.draw_moulds()
    drawer.draw_jig()
    drawer.draw_assembly()
    for pattern in contents.flat.patterns:
        draw_cut_file(cut / f"{pattern.name}.dxf", folder / f"cut-{pattern.name}.png")
    for part, answer in zip(contents.solid.parts, contents.printability, strict=True):
        if answer.findings:
            draw_findings(part.solid, answer, folder / f"printability-{part.label}.png")


class Drawer:
    """Draws the things of a kit where they belong.

    Each thing is made once; those that move together form a group.
    """

    def __init__(self, contents: Contents, folder: Path) -> None:
        self.contents, self.folder = contents, folder
        self.single = self._layer_groups(contents.device)
        self.single["film"] = self._film_group()
        self.places = contents.centers
        self.layers = {name: self._at_each_place(group) for name, group in self.single.items()}
        self.printed = {part.label: solid_thing(part.solid, part.colour, part.label) for part in contents.solid.parts}
        sizes = contents.device.stack.length_mm, contents.device.stack.width_mm
        self.space = APART_PER_WIDTH * min(max(sizes), MOST_APART_PER_HEIGHT * contents.layers[-1].top_mm)

    def _layer_groups(self, device: Device) -> dict[str, Group]:
        """Name of each layer -> its pieces, the first one with its name."""
        return {
            layer.name: [
                solid_thing(solid, PART_COLOURS[layer.name], "" if number else layer_title(layer.name))
                for number, solid in enumerate(device.solids(layer.name))
            ]
            for layer in self.contents.layers
        }

    def draw_device(self) -> None:
        """Draw all that stays in the finished device: pulled apart upwards, and with its front half cut away."""
        stack = self._assembly_groups()
        self._draw(_pull_apart(stack, self.space), "What you build, taken apart", "exploded")
        opened = [[thing.cut_open(self.cut_y) for thing in group] for group in stack]
        self._draw(opened, f"Cut through the {self.contents.what}", "section")

    @property
    def cut_y(self) -> float:
        """y of the cut, through the middle of a row of segments."""
        return self.places[0][1] + float(self.contents.device.layout.centres(1)[0])

    def draw_moulds(self) -> None:
        """Draw the mould of each cast component, opened."""
        for pour in self.contents.solid.pours:
            own = [[thing] for label, thing in self.printed.items() if label.startswith(f"mould-{pour.component}-")]
            space = MOULD_APART_PER_WIDTH * max(thing.surface.length for group in own for thing in group)
            floor, *bars = own[:-1]
            opened = _pull_apart([floor, [thing for group in bars for thing in group], own[-1]], space)
            self._draw(opened, f"Mould of {layer_title(pour.component)}, opened", f"mould-{pour.component}")

    def draw_jig(self) -> None:
        """Draw the stack in the corner of the jig, each thing over the one below."""
        tops, single = self.contents.stacked_tops_mm, self.single
        if self.contents.jig_device is not self.contents.device:
            single = self._layer_groups(self.contents.jig_device)
        base = next(layer.bottom_mm for layer in self.contents.layers if layer.name == next(iter(tops)))
        stack = [_lift_group(single[name], -base) for name in tops]
        locator = [[thing] for label, thing in self.printed.items() if label == "jig-locator"]
        stack[-1:-1] = locator
        raised = [_lift_group(group, (number + 1) * self.space) for number, group in enumerate(stack)]
        self._draw([[self.printed["jig"]], *raised], "Stack in the corner of the jig", "jig")

    def draw_assembly(self) -> None:
        """Draw a picture for each thing that is added; the newest hovers over its place."""
        order = self._assembly_groups()
        for number in range(1, len(order)):
            new = order[number]
            name = new[0].name
            shown = [order[0], *map(_without_names, order[1:number]), _lift_group(new, self.space)]
            self._draw(shown, f"{name[:1].upper()}{name[1:]} goes on", f"assembly-{number}")

    def _draw(self, groups: Sequence[Group], title: str, name: str) -> None:
        draw_things([thing for group in groups for thing in group], title, self.folder / f"{name}.png")

    def _assembly_groups(self) -> list[Group]:
        """Frame and layers from the base up, in the order in which they are put together."""
        parts = [[self.printed[label]] for label in ("base", "frame-body") if label in self.printed]
        ring = [[self.printed["frame-ring"]]] if "frame-ring" in self.printed else []
        upper = [self.layers[layer.name] for layer in self.contents.layers if layer.name in ("medium1", "effector")]
        return [*parts, self.layers["medium2"], self.layers["film"], *ring, *upper]

    def _at_each_place(self, group: Group) -> Group:
        """Copies of a group at each place of the array, the first one with its name."""
        first, *others = self.places
        copies = [thing.move(*place) for place in others for thing in _without_names(group)]
        return [thing.move(*first) for thing in group] + copies

    def _film_group(self) -> Group:
        """The film and the metal on its top, which shows which way it lies."""
        pattern, frame = self.contents.flat.patterns[0], self.contents.frame
        outline = pattern.cuts[-1]
        assert isinstance(outline, Outline)
        thickness = frame.film_top - frame.film_bottom
        metal = [one for one in pattern.marks if isinstance(one, Outline) and one.layer == "ELECTRODE-TOP"]
        return [
            sheet_thing(outline, frame.film_bottom, thickness, PART_COLOURS["film"], "film with its tab"),
            *(sheet_thing(one, frame.film_top, METAL_MM, METAL_COLOUR) for one in metal),
        ]


def _lift_group(group: Group, by_mm: float) -> Group:
    return [thing.lift(by_mm) for thing in group]


def _without_names(group: Group) -> Group:
    return [replace(thing, name="") for thing in group]


def _pull_apart(groups: Sequence[Group], space: float) -> list[Group]:
    """Groups lifted until each is clear, by the space in mm, of what is below."""
    found: list[Group] = []
    top = -float("inf")
    for group in groups:
        if not group:
            continue
        low, high = (pick(thing.surface.bounds[k] for thing in group) for k, pick in ((4, min), (5, max)))
        lift = max(top + space - low, 0.0)
        found.append(_lift_group(group, lift))
        top = high + lift
    return found
