"""The search's optima and the paper's final design on finer meshes, in 3D by both meshers, and in cross-section."""

from collections.abc import Mapping, Sequence
from typing import Any

from foundation.executor import Executor
from softdot.progress import Progress
from softdot.studies.paper.beyond.designs import PAPERS, Design
from softdot.studies.paper.beyond.ranking import SLICE_MESH
from softdot.studies.paper.beyond.trials import DesignTrial, solve_trials
from softdot.studies.paper.presses import NotSolvedError
from softdot.studies.paper.segment import Reading

FINER_SIZES_MM = {"element_size_mm": 0.5, "contact_element_size_mm": 0.25}
MODELS: Mapping[str, tuple[Reading, Mapping[str, Any]]] = {
    "pytetwild": ("solid", {**FINER_SIZES_MM, "mesher": "pytetwild"}),
    "layered": ("solid", {**FINER_SIZES_MM, "mesher": "layered"}),
    "cross-section": ("plane-strain", SLICE_MESH),
}
MESHERS = ("pytetwild", "layered")


def compare(optima: Sequence[Design], progress: Progress, executor: Executor) -> dict[str, list[DesignTrial]]:
    """Model -> the paper's final design and the optima, in this order. NotSolvedError."""
    designs = [PAPERS, *optima]
    found = {}
    for model, (reading, mesh) in MODELS.items():
        found[model] = solve_trials(designs, reading, mesh, progress, executor)
        if [trial.design for trial in found[model]] != designs:
            raise NotSolvedError(f"one of the designs of the final comparison did not converge, {model}")
    return found


def beats(optimum: DesignTrial, papers: DesignTrial, cable_pF: float = 0.0) -> bool:
    """More voltage in the worse boundary, with no more film stress and no more force."""
    return (
        optimum.worse_V(cable_pF) > papers.worse_V(cable_pF)
        and optimum.film_stress_MPa <= papers.film_stress_MPa
        and optimum.force_N <= papers.force_N
    )
