"""What a solved press of an array gives: force, and charge and voltage of every segment, against depth.

Each is kept on disk under a hash of all that it depends on, so that an array study that was stopped goes on where it
was; a press that was stopped goes on from its checkpoint.
"""

import json
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geometry.arrays import Floats
from geometry.cache import data_hash, folder, read_kept, source_hash, write_kept
from mesh.types import mesh_hash
from softdot.arrays.case import ArrayPress
from softdot.checks import result_warnings
from softdot.config import input_hash
from solve.model import Readout
from solve.press import OnStep, press_segment
from solve.readout.recording import channel_voltages
from solve.result import PressResult
from solve.solution.checkpoint import Checkpoint


@dataclass(frozen=True)
class Signals:
    """A press in numbers; index 0 of each history (s,) is the unloaded array.

    charge_pC : (s, n) short-circuit charge of each segment's electrode; voltage_V : (s, n) of its open circuit, Q / C.
    readout_voltage_V : (s, n), each electrode behind an amplifier of its own; None without one.
    capacitance_pF : (n,). planes : mirror planes at which the solved mesh ends. failure : None where it converged.
    """

    depth_mm: Floats
    force_N: Floats
    charge_pC: Floats
    voltage_V: Floats
    readout_voltage_V: Floats | None
    capacitance_pF: Floats
    film_strain: float
    planes: tuple[int, ...]
    unknowns: int
    newton_iterations: int
    max_relative_residual: float
    solve_s: float
    warnings: tuple[str, ...]
    failure: str | None

    @property
    def signal_V(self) -> Floats:
        """What is read (s, n): behind the amplifiers where there are some, else at open circuit."""
        return self.voltage_V if self.readout_voltage_V is None else self.readout_voltage_V


TUPLES = ("planes", "warnings")


def signals(press: ArrayPress, on_step: OnStep | None = None) -> Signals:
    """Solve a press, or take it from the cache. What did not converge has a failure and what was reached before it.

    InputError, MeshingError.
    """
    kept = read_kept(_path(press))
    if kept is not None:
        return _decoded(json.loads(kept))
    return _solved(press, on_step)[0]


def remembered(press: ArrayPress, on_step: OnStep | None = None) -> PressResult:
    """The solver's own result with its fields, whose numbers are then kept for signals. InputError, MeshingError."""
    return _solved(press, on_step)[1]


def _solved(press: ArrayPress, on_step: OnStep | None) -> tuple[Signals, PressResult]:
    path = _path(press)
    begun = time.perf_counter()
    checkpoint = Checkpoint(path.with_suffix(".npz"), path.stem)
    result = press_segment(press.model, press.mesh, on_step, checkpoint, press.dot)
    found = signals_of(press, result, time.perf_counter() - begun)
    if found.failure is None:
        _keep(path, found)
    return found, result


def _path(press: ArrayPress) -> Path:
    """Where a press is kept."""
    key = data_hash([source_hash(__name__), input_hash(press.config), mesh_hash(press.mesh)])
    return folder() / f"array-{key}.json"


def signals_of(press: ArrayPress, result: PressResult, solve_s: float) -> Signals:
    """The numbers of a result."""
    model = press.model
    amplified = None
    if model.readout is not None or model.physics.electronics or model.physics.of_channels:
        amplified = channel_voltages(result, model.press, model.readout or Readout(), model.physics).T
    steps = result.steps
    return Signals(
        depth_mm=np.array([1e3 * step.indentation_m for step in steps]),
        force_N=np.array([step.reaction_force_N for step in steps]) + 0.0,
        charge_pC=np.array([1e12 * step.film_charge_C for step in steps]),
        voltage_V=np.array([step.open_circuit_voltage_V for step in steps]),
        readout_voltage_V=amplified,
        capacitance_pF=1e12 * result.capacitance_F,
        film_strain=result.film_peak.strain,
        planes=tuple(result.planes),
        unknowns=result.unknowns,
        newton_iterations=sum(step.newton_iterations for step in steps),
        max_relative_residual=result.max_relative_residual,
        solve_s=solve_s,
        warnings=tuple(result_warnings(model, press.dot, result)),
        failure=result.failure,
    )


def _keep(path: Path, found: Signals) -> None:
    tree = {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in asdict(found).items()}
    with suppress(OSError):  # a cache that cannot be written is no cache
        write_kept(path, json.dumps(tree).encode())


def _decoded(tree: dict[str, Any]) -> Signals:
    lists = {
        key: (tuple if key in TUPLES else np.array)(value) for key, value in tree.items() if isinstance(value, list)
    }
    return Signals(**{**tree, **lists})


Follow = Callable[[str], OnStep]
"""Of the name of a press: who is told of its steps."""
