"""How far force and voltage of a run can be trusted: mesh, mesher and what the materials are known to.

To first order: each constant of a material, off by what is stated of it, moves the response along its derivative
(ISO/IEC Guide 98-3, 2008, clause 5.1.2). The derivatives come from the same press on elements twice as large, at its
full load alone. All parts are taken as independent, and their squares added. Where a part is missing there is no sum:
mesh and mesher alone are far less than the materials do.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from math import hypot
from typing import Any

from geometry.base import InputError
from mesh.types import MeshingError
from softdot.config import Config
from softdot.config.model import model_of
from softdot.tolerances.responses import KitPress, Response, coarser
from softdot.tolerances.tolerances import Tolerance, material_tolerances
from solve.solution.linear import LinearSolveError
from solve.solution.sensitivity import StoppedShortError

COARSER = 2.0
UNSOLVED = InputError, LinearSolveError, MeshingError, StoppedShortError
STUDY = {"solid": (0.4, 1.0), "plane-strain": (0.5, 0.6)}
"""Percent of force and of voltage that the default mesh is off: convergence of the default design, and of the same as a
clamped slice, in docs/verification.md."""
SCATTER = 0.5, 0.5
"""Percent by which meshes of pytetwild differ, which is not repeatable: 0.1 to 0.6 % on the segments of
docs/verification.md, once 1.9 %."""
LOST = {
    "path": "what the tolerances of the materials do is not estimated here, since this press depends on its path; "
    "softdot kit calculates it",
    "slide": "what the tolerances of the materials do is not estimated here, since the dot slides after it is pressed "
    "in; softdot kit calculates it for the press before the slide",
    "failed": "what the tolerances of the materials do could not be estimated: the press on larger elements failed",
}


def uncertainty(config: Config, force_N: float, voltage_V: float) -> dict[str, Any]:
    """The keys discretisation_error and uncertainty of summary.json: of the final force and open-circuit voltage.

    config : as the user states it. Each part has name, source, force_percent and voltage_percent; note says what is
    missing, and then there is no sum. A run whose force or voltage is zero has no percentages.
    """
    if force_N == 0.0 or voltage_V == 0.0:
        return {}
    given = config.press.force_N is not None
    mesh_error = _known_force(STUDY[config.segment.section], given)
    mesh_source = "convergence study of the default design"
    parts, note = [], _not_estimated(config)
    if note is None:
        rows = _counted(config)
        try:
            nominal, slopes = _slopes(config, rows)
        except UNSOLVED:
            note = LOST["failed"]
        else:
            parts = [_part(row, nominal, slopes, given) for row in rows]
            own = _known_force(_third_of_difference(nominal, force_N, voltage_V), given)
            if hypot(*own) > hypot(*mesh_error):
                mesh_error, mesh_source = own, "a third of the change from elements twice as large"
    parts.sort(key=lambda part: -part["voltage_percent"])
    parts += [_named("mesh", mesh_source, mesh_error)]
    made = config.mesh.file is None and config.mesh.mesher == "pytetwild"
    if made and config.segment.section == "solid":
        scatter = _known_force(SCATTER, given)
        parts += [_named("repeatability of the mesher", "repeated meshes of the same segments", scatter)]
    return {
        "discretisation_error": {"force_percent": mesh_error[0], "voltage_percent": mesh_error[1]},
        "uncertainty": {**(_together(parts) if note is None else {}), "parts": parts, "note": note},
    }


def prepare(config: Config) -> None:
    """What uncertainty needs besides force and voltage, left in the cache: it may be done beside the press itself."""
    if _not_estimated(config) is None:
        with suppress(*UNSOLVED):
            _slopes(config, _counted(config))


def _counted(config: Config) -> list[Tolerance]:
    return [row for row in material_tolerances(config) if row.counted]


def _slopes(config: Config, rows: Sequence[Tolerance]) -> tuple[Response, dict[str, Response]]:
    """Response on larger elements, and its derivatives by what the rows depend on. UNSOLVED."""
    return KitPress(_coarse(config)).full_load_slopes(sorted({key for row in rows for key in row.slopes}))


def _not_estimated(config: Config) -> str | None:
    """Why the full load alone does not tell about the last step; what an amplifier adds does not matter to it."""
    if model_of(config).follows_time:
        return LOST["path"]
    return LOST["slide"] if config.press.path_xy_mm else None


def _coarse(config: Config) -> Config:
    """On larger elements, in one load step: where the path does not matter the steps do not either."""
    coarse = coarser(config, COARSER)
    return coarse.model_copy(update={"press": coarse.press.model_copy(update={"load_steps": 1})})


def _known_force(percent: tuple[float, float], given: bool) -> tuple[float, float]:
    """Of force and voltage; a force that is given is not in doubt."""
    return (0.0 if given else percent[0], percent[1])


def _together(parts: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    return {name: hypot(*(part[name] for part in parts)) for name in ("force_percent", "voltage_percent")}


def _part(row: Tolerance, nominal: Response, slopes: Mapping[str, Response], given: bool) -> dict[str, Any]:
    """One constant of a material at the end of its tolerance."""
    force = sum(slope * slopes[key].force for key, slope in row.slopes.items())
    voltage = sum(slope * slopes[key].voltage for key, slope in row.slopes.items())
    percent = (
        100 * row.plus_minus * abs(force / nominal.force),
        100 * row.plus_minus * abs(voltage / nominal.voltage),
    )
    return _named(f"{row.label} ±{row.plus_minus:.3g} {row.unit}", row.source, _known_force(percent, given))


def _third_of_difference(coarse: Response, force_N: float, voltage_V: float) -> tuple[float, float]:
    """Percent of the error of this mesh from one twice as coarse, at second order (Richardson)."""
    return 100 * abs(coarse.force / force_N - 1.0) / 3.0, 100 * abs(coarse.voltage / voltage_V - 1.0) / 3.0


def _named(name: str, source: str, percent: tuple[float, float]) -> dict[str, Any]:
    return {"name": name, "source": source, "force_percent": percent[0], "voltage_percent": percent[1]}
