"""The search's optima and the paper's final design on finer meshes, in 3D by both meshers, and in cross-section."""

from collections.abc import Mapping, Sequence
from typing import Any

from softdot.paper.beyond.designs import PAPERS, Design
from softdot.paper.beyond.ranking import SLICE_MESH
from softdot.paper.beyond.trials import Trial, solve_trials
from softdot.paper.presses import NotSolvedError
from softdot.paper.reading import Reading
from softdot.progress import Progress

FINER = {"element_size_mm": 0.5, "contact_element_size_mm": 0.25}
MODELS: Mapping[str, tuple[Reading, Mapping[str, Any]]] = {
    "pytetwild": ("solid", {**FINER, "mesher": "pytetwild"}),
    "layered": ("solid", {**FINER, "mesher": "layered"}),
    "cross-section": ("plane-strain", SLICE_MESH),
}
MESHERS = ("pytetwild", "layered")


def compare(optima: Sequence[Design], progress: Progress) -> dict[str, list[Trial]]:
    """Model -> the paper's final design and the optima, in this order. NotSolvedError."""
    designs = [PAPERS, *optima]
    found = {}
    for model, (reading, mesh) in MODELS.items():
        found[model] = solve_trials(designs, reading, mesh, progress)
        if [trial.design for trial in found[model]] != designs:
            raise NotSolvedError(f"one of the designs of the final comparison did not converge, {model}")
    return found


def beats(optimum: Trial, papers: Trial, cable_pF: float = 0.0) -> bool:
    """More voltage in the worse boundary, with no more film stress and no more force."""
    return (
        optimum.worse_V(cable_pF) > papers.worse_V(cable_pF)
        and optimum.film_stress_MPa <= papers.film_stress_MPa
        and optimum.force_N <= papers.force_N
    )
