"""The folder with the cut files of all patterns of a kit."""

from collections.abc import Sequence
from pathlib import Path

from export.cut_files.dxf import write_dxf
from export.cut_files.svg import write_svg
from foundation.files import whole_folder
from geometry.flat.pattern import FlatPattern, kerf_compensated_pattern


def write_cut_files(patterns: Sequence[FlatPattern], folder: Path) -> None:
    """Write <name>.dxf and <name>.svg of every pattern, kerf compensated; the folder appears whole or not at all."""
    with whole_folder(folder) as scratch:
        for pattern in patterns:
            cut = kerf_compensated_pattern(pattern)
            write_dxf(cut, scratch / f"{pattern.name}.dxf")
            write_svg(cut, scratch / f"{pattern.name}.svg")
