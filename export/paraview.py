"""What ParaView opens: collections over the load steps, files of named blocks, and a script that shows it all.

In a shell: paraview --script=show_in_paraview.py, or pvpython show_in_paraview.py.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from export.units import MPA_PER_PA, PC_PER_MM2_PER_C_PER_M2
from mesh.types import TetMesh
from solve.result import PressResult

TEMPLATE = Path(__file__).with_name("paraview_script.txt")


def collection(files: Sequence[str], times: Sequence[float]) -> str:
    """The text of a PVD file: one data file for each time."""
    rows = [
        f'    <DataSet timestep="{time:.9g}" group="" part="0" file={quoteattr(file)}/>'
        for time, file in zip(times, files, strict=True)
    ]
    return _index("Collection", "0.1", rows)


def multi_block(files: Mapping[str, str]) -> str:
    """The text of a VTM file: block name -> data file."""
    rows = [
        f'    <DataSet index="{index}" name={quoteattr(name)} file={quoteattr(file)}/>'
        for index, (name, file) in enumerate(files.items())
    ]
    return _index("vtkMultiBlockDataSet", "1.0", rows)


def _index(kind: str, version: str, rows: Sequence[str]) -> str:
    head = f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="{version}" byte_order="LittleEndian">'
    return "\n".join([head, f"  <{kind}>", *rows, f"  </{kind}>", "</VTKFile>", ""])


def paraview_script(tet_mesh: TetMesh, result: PressResult) -> str:
    """The script with the sizes and ranges of these results: the soft parts' stress, the film's charge density."""
    soft = tet_mesh.region != tet_mesh.region_names.index("film")
    stress = float(np.percentile(result.steps[-1].fields.von_mises_Pa[soft], 99)) * MPA_PER_PA
    charge = PC_PER_MM2_PER_C_PER_M2 * max(map(abs, result.film_peak.charge_density_C_per_m2))
    length = float(np.ptp(tet_mesh.points_mm[:, 0]))
    values = {
        "@STRESS@": stress or 1.0, "@CHARGE@": charge or 1.0, "@ASIDE@": 1.25 * length, "@FOCUS@": 0.6 * length,
        "@PARTS@": [name for name in tet_mesh.region_names if name != "film"],
    }  # fmt: skip
    script = TEMPLATE.read_text("utf-8")
    for mark, value in values.items():
        script = script.replace(mark, f"{value:.4g}" if isinstance(value, float) else repr(value))
    return script
