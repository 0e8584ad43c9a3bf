"""Draw the pictures of docs/kit_parts.md from the solids of the kit.

Run ``python docs/make_kit_pictures.py`` at the top of the repository after a mould, the frame or the jig has
changed. It writes docs/pictures/kit-*.png.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS.parent))  # the rooms of this repository, whatever is installed

from geometry.fabrication.device import lone_device  # noqa: E402
from geometry.fabrication.kit import solid_kit  # noqa: E402
from geometry.fabrication.parameters import Fabrication  # noqa: E402
from geometry.fabrication.part import FabricationPart  # noqa: E402
from geometry.parameters import Effector, Film, Medium, Segment  # noqa: E402
from geometry.solids import PART_COLOURS, layer_solids  # noqa: E402

Shift = tuple[float, float, float]
Item = tuple[Any, Any, Shift]
HERE: Shift = (0.0, 0.0, 0.0)


def main() -> None:
    """Draw all of them."""
    dome = _segment(Effector(shape="dome", diameter_mm=2.0, height_mm=0.8), "clamped")
    parts = _parts(dome, Fabrication())
    _draw([_of(parts["mould-effector-plate"]), _of(parts["mould-effector-lid"], (4, 16, 9))], "kit-open-mould")
    frame = [_of(parts["frame-body"]), _of(parts["frame-ring"], (0, 0, 4.5))]
    _draw([*frame, *_soft(dome, medium2=0.0, medium1=2.0, effector=6.0)], "kit-frame", (1.0, -1.3, 0.9))

    cylinder = _segment(Effector(shape="cylinder", diameter_mm=2.0, height_mm=1.0), "free")
    sheets = {"medium1": "sheet", "medium2": "sheet"}
    parts = _parts(cylinder, Fabrication.model_validate({"mould_style": "split", "routes": sheets}))
    bars = [_of(parts[f"mould-effector-bar-{number}"], (0, 4.0 * (number - 2), 3.5)) for number in (1, 2, 3)]
    lid = _of(parts["mould-effector-lid"], (6, 26, 12))
    _draw([_of(parts["mould-effector-floor"]), *bars, lid], "kit-split-mould")
    jig = [_of(parts["jig"]), _of(parts["jig-locator"], (0, 0, 4.5))]
    _draw([*jig, *_soft(cylinder, medium2=0.0, medium1=0.0, effector=4.5)], "kit-jig", (1.0, 1.3, 1.0))


def _segment(effector: Effector, boundary: str) -> Segment:
    return Segment.model_validate(
        {
            "effector": effector,
            "medium1": Medium(thickness_mm=0.5),
            "film": Film(thickness_um=28.0),
            "medium2": Medium(thickness_mm=2.0),
            "boundary": boundary,
        }
    )


def _parts(segment: Segment, fabrication: Fabrication) -> dict[str, FabricationPart]:
    return {part.label: part for part in solid_kit(lone_device(segment), fabrication).parts}


def _of(part: FabricationPart, shift: Shift = HERE) -> Item:
    return (part.solid, part.colour, shift)


def _soft(segment: Segment, **lifts: float) -> list[Item]:
    """Soft layers, each lifted by some millimetres."""
    solids = layer_solids(segment, segment.film.thickness_um * 1e-3)
    return [(solids[name], PART_COLOURS[name], (0.0, 0.0, lift)) for name, lift in lifts.items()]


def _draw(items: list[Item], name: str, view: Shift = (0.6, -1.2, 1.1)) -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=[900, 700])
    plotter.set_background("white")
    for solid, colour, shift in items:
        surface = _surface(solid, shift)
        plotter.add_mesh(surface, color=colour, ambient=0.15)
        plotter.add_mesh(surface.extract_feature_edges(25.0), color="#333333", line_width=1.2)
    plotter.enable_anti_aliasing("ssaa")
    plotter.enable_parallel_projection()
    plotter.view_vector(view, (0, 0, 1))
    plotter.screenshot(str(DOCS / "pictures" / f"{name}.png"))
    plotter.close()


def _surface(solid: Any, shift: Shift) -> pv.PolyData:
    points, triangles = solid.tessellate(0.01, 0.15)
    corners = np.array([tuple(point) for point in points]) + np.array(shift)
    return pv.PolyData(corners, np.hstack([np.full((len(triangles), 1), 3), np.array(triangles)]).ravel())


if __name__ == "__main__":
    main()
