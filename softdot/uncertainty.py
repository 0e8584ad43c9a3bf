"""How far force and voltage of a run can be trusted: mesh, mesher and what the materials are known to.

To first order: each constant of a material, off by what is stated of it, moves the response along its derivative
(ISO/IEC Guide 98-3, 2008, clause 5.1.2). The derivatives come from the same press on elements twice as large, at its
full load alone. All parts are taken as independent, and their squares added.
"""

from collections.abc import Mapping, Sequence
from math import hypot
from typing import Any

from geometry.errors import InputError
from mesh.errors import MeshingError
from softdot.config import Config
from softdot.kit.responses import KitPress, Response, coarser, path_matters
from softdot.kit.tolerances import Tolerance, material_tolerances
from solve.full_load import StoppedShortError
from solve.linear import LinearSolveError

COARSER = 2.0
STUDY = {"solid": (0.4, 1.0), "plane-strain": (0.5, 0.6)}
"""Percent of force and of voltage that the default mesh is off: convergence of the default design, and of the same as a
clamped slice, in docs/verification.md."""
SCATTER = 0.5, 0.5
"""Percent by which meshes of pytetwild differ, which is not repeatable: 0.1 to 0.6 % on the segments of
docs/verification.md, once 1.9 %."""
LOST = {
    "path": "what the tolerances of the materials do is not estimated here, since this press depends on its path; "
    "softdot kit calculates it",
    "failed": "what the tolerances of the materials do could not be estimated: the press on larger elements failed",
}


def uncertainty(config: Config, force_N: float, voltage_V: float) -> dict[str, Any]:
    """The keys discretisation_error and uncertainty of summary.json for the final force and voltage of a run.

    config : as the user states it. Each part has name, source, force_percent and voltage_percent; note says what is
    missing. A run whose force or voltage is zero has no percentages.
    """
    if force_N == 0.0 or voltage_V == 0.0:
        return {}
    mesh_error = STUDY[config.segment.section]
    mesh_source = "convergence study of the default design"
    parts, note = [], None
    if path_matters(config):
        note = LOST["path"]
    else:
        try:
            nominal, slopes = KitPress(coarser(config, COARSER)).slopes(_keys(rows := material_tolerances(config)))
        except (InputError, LinearSolveError, MeshingError, StoppedShortError):
            note = LOST["failed"]
        else:
            parts = [_part(row, nominal, slopes) for row in rows if row.counted]
            own = _third_of_difference(nominal, force_N, voltage_V)
            if hypot(*own) > hypot(*mesh_error):
                mesh_error, mesh_source = own, "a third of the change from elements twice as large"
    parts.sort(key=lambda part: -part["voltage_percent"])
    parts += [_named("mesh", mesh_source, mesh_error)]
    if config.mesh.mesher == "pytetwild" and config.segment.section == "solid":
        parts += [_named("repeatability of the mesher", "repeated meshes of the same segments", SCATTER)]
    total = {name: hypot(*(part[name] for part in parts)) for name in ("force_percent", "voltage_percent")}
    return {
        "discretisation_error": {"force_percent": mesh_error[0], "voltage_percent": mesh_error[1]},
        "uncertainty": {**total, "parts": parts, "note": note},
    }


def _keys(rows: Sequence[Tolerance]) -> list[str]:
    return sorted({key for row in rows for key in row.slopes})


def _part(row: Tolerance, nominal: Response, slopes: Mapping[str, Response]) -> dict[str, Any]:
    """One constant of a material at the end of its tolerance."""
    force = sum(slope * slopes[key].force for key, slope in row.slopes.items())
    voltage = sum(slope * slopes[key].voltage for key, slope in row.slopes.items())
    percent = (
        100 * row.plus_minus * abs(force / nominal.force),
        100 * row.plus_minus * abs(voltage / nominal.voltage),
    )
    return _named(f"{row.label} ±{row.plus_minus:.3g} {row.unit}", row.source, percent)


def _third_of_difference(coarse: Response, force_N: float, voltage_V: float) -> tuple[float, float]:
    """Percent of the error of this mesh from one twice as coarse, at second order (Richardson)."""
    return 100 * abs(coarse.force / force_N - 1.0) / 3.0, 100 * abs(coarse.voltage / voltage_V - 1.0) / 3.0


def _named(name: str, source: str, percent: tuple[float, float]) -> dict[str, Any]:
    return {"name": name, "source": source, "force_percent": percent[0], "voltage_percent": percent[1]}
