"""All cut files of a kit and their pictures: DXF and SVG in millimetres, with named layers."""

from collections.abc import Sequence
from pathlib import Path

from export.cut_files.drawing import write_dxf, write_svg
from geometry.files import whole_folder
from geometry.flat.pattern import FlatPattern, compensated


def write_cut_files(patterns: Sequence[FlatPattern], folder: Path) -> None:
    """Write <name>.dxf and <name>.svg of every pattern, kerf compensated; the folder appears whole or not at all."""
    with whole_folder(folder) as scratch:
        for pattern in patterns:
            cut = compensated(pattern)
            write_dxf(cut, scratch / f"{pattern.name}.dxf")
            write_svg(cut, scratch / f"{pattern.name}.svg")


def draw_cut_file(dxf: Path, picture: Path) -> None:
    """A PNG of what a DXF file holds, as a CAD program would show it."""
    from ezdxf.addons.drawing.config import BackgroundPolicy, ColorPolicy, Configuration
    from ezdxf.addons.drawing.frontend import Frontend
    from ezdxf.addons.drawing.matplotlib import MatplotlibBackend
    from ezdxf.addons.drawing.properties import RenderContext
    from ezdxf.filemanagement import readfile
    from matplotlib.figure import Figure

    document = readfile(dxf)
    figure = Figure(figsize=(9.0, 5.0), dpi=200)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    settings = Configuration(
        background_policy=BackgroundPolicy.WHITE,
        color_policy=ColorPolicy.COLOR,
        min_lineweight=0.3,
        lineweight_scaling=3.0,
    )
    Frontend(RenderContext(document), MatplotlibBackend(axes), config=settings).draw_layout(document.modelspace())
    figure.savefig(picture, dpi=200, facecolor="white", bbox_inches="tight", pad_inches=0.1)
