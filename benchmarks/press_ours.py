"""The press of the true segment by softdot: python -m benchmarks.press_ours FACTOR STEPS [CASE.npz].

Seconds of press_segment in equal load steps, from the mesh to force and voltage; compilation is done before. With
CASE.npz the mesh is also written for NGSolve.
"""

import json
import sys
import time
from pathlib import Path

from benchmarks.press_case import DEPTH_MM, save, segment_mesh
from mesh.types import TetMesh
from softdot.config.loading import load_config
from softdot.config.schema import Config
from solve.model import Model
from solve.press import press_segment
from solve.result import PressResult


def press(config: Config, tet_mesh: TetMesh, steps: int) -> PressResult:
    """To 0.3 mm: elastic and frictionless, so that the path does not matter."""
    path = config.press.model_copy(update={"indentation_mm": DEPTH_MM, "load_steps": steps})
    result = press_segment(Model(config.segment, config.layer_materials(), config.dot, path), tet_mesh)
    if not result.converged:
        raise SystemExit(result.failure)
    return result


def measure(factor: float, steps: int) -> dict:
    """Time and answers."""
    config = load_config(None)
    press(config, segment_mesh(config, 4.0), 1)  # loads the compiled kernels
    tet_mesh = segment_mesh(config, factor)
    start = time.perf_counter()
    result = press(config, tet_mesh, steps)
    seconds = time.perf_counter() - start
    last, iterations = result.steps[-1], sum(step.newton_iterations for step in result.steps)
    return {
        "unknowns": result.unknowns,
        "load_steps": steps,
        "seconds": seconds,
        "newton_iterations": iterations,
        "force_N": last.reaction_force_N,
        "voltage_V": float(last.open_circuit_voltage_V[0]),
    }


if __name__ == "__main__":
    if len(sys.argv) > 3:
        save(Path(sys.argv[3]), float(sys.argv[1]))
    print(json.dumps(measure(float(sys.argv[1]), int(sys.argv[2]))))
