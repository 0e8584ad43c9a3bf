"""The script that shows results in ParaView: paraview --script=show_in_paraview.py, or pvpython show_in_paraview.py."""

from pathlib import Path

import numpy as np

from export.units import MPA_PER_PA, PC_PER_MM2_PER_C_PER_M2
from mesh.types import TetMesh
from solve.result import PressResult

TEMPLATE = Path(__file__).with_name("paraview_script.txt")


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
