"""What a user should know about a result that is otherwise good."""

from geometry.checks import press_warnings
from geometry.dot import DotShape
from mesh.types import TetMesh
from softdot.config import Config
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.result import PressResult

NEARLY_INCOMPRESSIBLE = 0.49


def result_warnings(
    config: Config, dot_shape: DotShape, tet_mesh: TetMesh, result: PressResult, yields: bool = False
) -> list[str]:
    """Warnings that a solution gives: the solver's own, yield of the film, strain beyond the data.

    yields : the film's yield is part of the solution.
    """
    warnings = [*result.warnings, *([] if yields else _yield(config, result))]
    for layer, material in config.layer_materials().items():
        warnings += _beyond_fit(layer, material, tet_mesh, result)
    if config.press.indentation_mm is None:
        deepest_mm = 1e3 * max(step.indentation_m for step in result.steps)
        warnings += press_warnings(dot_shape, config.segment, deepest_mm)
    return warnings


def design_warnings(config: Config) -> list[str]:
    """Warnings that need no solution: holding medium 2 closes a cavity."""
    segment = config.segment
    material = config.layer_materials()["medium2"]
    held = segment.boundary == "clamped" and "medium2" in segment.held_layers
    nu = getattr(material, "poisson_ratio", 0.0)
    if not held or isinstance(nu, tuple) or nu < NEARLY_INCOMPRESSIBLE:
        return []
    return [
        f"the held sides of medium2 enclose a nearly incompressible material (poisson_ratio "
        f"= {nu:g}): it blocks the film, and small changes of poisson_ratio change the result a lot"
    ]


def _yield(config: Config, result: PressResult) -> list[str]:
    film = config.layer_materials()["film"]
    stress = 1e-6 * result.film_peak.stress_Pa
    if not isinstance(film, PiezoelectricFilm) or film.yield_stress_MPa is None or stress <= film.yield_stress_MPa:
        return []
    return [
        f"the film's largest principal stress of {stress:.3g} MPa exceeds its yield stress of "
        f"{film.yield_stress_MPa:g} MPa: a real film would remain stretched"
    ]


def _beyond_fit(layer: str, material: Material, tet_mesh: TetMesh, result: PressResult) -> list[str]:
    """Largest principal stretch of the layer over all steps against the range of the data."""
    limit = material.max_fitted_strain
    if limit is None or layer not in tet_mesh.region_names:
        return []
    tets = tet_mesh.region_tets(layer)
    strain = max(float(step.fields.max_stretch[tets].max()) for step in result.steps) - 1.0
    if strain <= limit:
        return []
    return [
        f"the strain of {100 * strain:.3g} % in {layer} is beyond the fitted range of its material "
        f"({100 * limit:.3g} %)"
    ]
