"""What a run will cost: elements, unknowns, time and memory, from measured runs. Rough, within a factor of two.

Measured on two cores of an EPYC without other work (docs/speed.md): 0.29 s a Newton iteration at 14,800 unknowns,
2.9 s at 68,400, about seven iterations a load step where the path does not ask for more.
"""

from dataclasses import dataclass

from geometry.dot import DotShape
from softdot.config import Config
from softdot.memory import needed_GB
from softdot.mesh_limit import expected_tetrahedra

UNKNOWNS_PER_TETRAHEDRON = {"solid": 4.4, "plane-strain": 1.6}
ITERATIONS = 7
ITERATION_S, AT_UNKNOWNS, EXPONENT = 2.9, 68_400, 1.5
SOLIDS_AND_PICTURES_S, MESH_S_PER_TETRAHEDRON = 15.0, 3e-4
COMPILE_S = 60.0


@dataclass(frozen=True)
class Cost:
    """Expected size of a run; first_run_s : more on a machine that has not compiled the element kernels yet."""

    tetrahedra: int
    unknowns: int
    time_s: float
    first_run_s: float
    memory_GB: float


def expected_cost(config: Config, dot_shape: DotShape) -> Cost:
    """Cost of a run. Waveforms that are followed in time, slides and mechanisms may take several times as long."""
    count = expected_tetrahedra(config.segment, dot_shape, config.mesh)
    unknowns = UNKNOWNS_PER_TETRAHEDRON[config.segment.section] * count
    solve_s = ITERATIONS * config.press.load_steps * ITERATION_S * (unknowns / AT_UNKNOWNS) ** EXPONENT
    time_s = SOLIDS_AND_PICTURES_S + MESH_S_PER_TETRAHEDRON * count + solve_s
    return Cost(
        tetrahedra=_rounded(count),
        unknowns=_rounded(unknowns),
        time_s=float(_rounded(time_s)),
        first_run_s=COMPILE_S,
        memory_GB=round(needed_GB(count, config.segment.section == "plane-strain"), 1),
    )


def _rounded(value: float) -> int:
    """Two digits: more would claim too much."""
    return int(float(f"{value:.2g}"))
