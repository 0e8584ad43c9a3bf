"""All presses of the segment studies, each solved once and remembered."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from foundation.executor import Executor
from softdot.config.schema import Config
from softdot.progress import Progress
from softdot.studies.paper.presses import solve_named
from softdot.studies.paper.published import published_numbers
from softdot.studies.paper.segment import Reading, segment_config
from softdot.studies.paper.segments.cases import CASES, PaperCase

READINGS: tuple[Reading, ...] = ("plane-strain", "solid")
SOLID_MESH = {"element_size_mm": 0.6, "contact_element_size_mm": 0.2, "mesher": "layered"}
FINER_SOLID_MESH = {"element_size_mm": 0.42, "contact_element_size_mm": 0.14, "mesher": "layered"}
FINER_SLICE_MESH = {"element_size_mm": 0.15, "contact_element_size_mm": 0.05, "mesher": "layered"}
SOLID_STEPS = 2
"""The half and the full depth are all that the study shows of a true segment."""
CHECKED = "final-clamped"
"""The case whose mesh is refined to see its error."""
VARIANTS: dict[str, dict[str, Any]] = {
    "effector 0.8 mm high": {"effector_height_mm": 0.8},
    "effector 1.2 mm high": {"effector_height_mm": 1.2},
    "ridge of radius 0.8 mm": {"ridge_radius_mm": 0.8},
    "ridge of radius 1.5 mm": {"ridge_radius_mm": 1.5},
    "sides of medium 2 held too": {"held_layers": ["effector", "medium1", "film", "medium2"]},
    "rubber less compressible, Poisson's ratio 0.4995": {"poisson_ratio": 0.4995},
}
"""What the paper leaves open, changed one at a time in the plane-strain reading."""
VARIED = ("C1", "C4", "final-free", "final-clamped")


@dataclass(frozen=True)
class SolvedPress:
    """What one press gave. Histories are of shape (s,), index 0 unloaded."""

    depth_mm: tuple[float, ...]
    force_history_N: tuple[float, ...]
    voltage_history_V: tuple[float, ...]
    film_strain: float
    """Largest principal strain in the film."""
    film_stress_MPa: float
    unknowns: int

    @property
    def force_N(self) -> float:
        """Force at full depth."""
        return self.force_history_N[-1]

    @property
    def voltage_V(self) -> float:
        """Open-circuit voltage at full depth."""
        return self.voltage_history_V[-1]

    @property
    def calibrated_mV(self) -> float:
        """The open-circuit voltage over the paper's calibration factor."""
        return 1e3 * self.voltage_V / calibration_factor()

    @property
    def calibrated_V_per_mm(self) -> float:
        """Calibrated voltage per depth, the vertical axis of the paper's figures."""
        return 1e-3 * self.calibrated_mV / self.depth_mm[-1]

    @property
    def exponent(self) -> float:
        """Exponent n of V ~ u^n through the middle and the end of the press; 1 for a linear sensor."""
        middle = len(self.depth_mm) // 2
        voltage_ratio = abs(self.voltage_history_V[-1] / self.voltage_history_V[middle])
        return float(np.log(voltage_ratio) / np.log(self.depth_mm[-1] / self.depth_mm[middle]))


@dataclass(frozen=True)
class Study:
    """Every press of the segment studies."""

    readings: Mapping[Reading, Mapping[str, SolvedPress]]
    refined: Mapping[Reading, SolvedPress]
    """CHECKED on a finer mesh."""
    variants: Mapping[str, Mapping[str, SolvedPress]]
    """Name of VARIANTS -> case of VARIED -> press, plane strain."""


def calibration_factor() -> float:
    """The paper's mean p, by which all its voltages are divided."""
    return published_numbers()["section2.p-mean"].value


def solve_study(progress: Progress, executor: Executor) -> Study:
    """Press everything, as far as it is not remembered. NotSolvedError when a press does not converge."""
    presses = {name: press_of(found) for name, found in solve_named(_configs(), progress, executor).items()}
    return Study(
        {reading: {name: presses[reading, name] for name in CASES} for reading in READINGS},
        {reading: presses[f"finer {reading}", CHECKED] for reading in READINGS},
        {variant: {name: presses[variant, name] for name in VARIED} for variant in VARIANTS},
    )


def _configs() -> dict[tuple[str, str], Config]:
    """Configurations by (group, case), the long ones first, so that no core waits at the end."""
    fine = CASES[CHECKED]
    configs = {("finer solid", CHECKED): _config(fine, "solid", mesh=FINER_SOLID_MESH, load_steps=SOLID_STEPS)}
    configs |= {
        ("solid", name): _config(case, "solid", mesh=SOLID_MESH, load_steps=SOLID_STEPS) for name, case in CASES.items()
    }
    configs |= {("finer plane-strain", CHECKED): _config(fine, "plane-strain", mesh=FINER_SLICE_MESH)}
    configs |= {("plane-strain", name): _config(case, "plane-strain") for name, case in CASES.items()}
    for variant, changes in VARIANTS.items():
        configs |= {(variant, name): _config(CASES[name], "plane-strain", **changes) for name in VARIED}
    return configs


def _config(case: PaperCase, reading: Reading, **changes: Any) -> Config:
    return segment_config(case.boundary, case.h1_mm, case.e2_MPa, reading, **changes)


def press_of(outcome: Mapping[str, Any]) -> SolvedPress:
    """The numbers of the study from an outcome."""
    return SolvedPress(
        depth_mm=tuple(outcome["indentation_mm"]),
        force_history_N=tuple(outcome["reaction_force_N"]),
        voltage_history_V=tuple(outcome["open_circuit_voltage_V"]),
        film_strain=outcome["film"]["max_principal_strain"],
        film_stress_MPa=outcome["film"]["max_principal_stress_MPa"],
        unknowns=outcome["mesh"]["unknowns"],
    )
