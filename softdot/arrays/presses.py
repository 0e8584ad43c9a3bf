"""What a solved press of an array gives: force, and charge and voltage of every segment, against depth.

Each is kept on disk under a hash of all that it depends on, so that an array study that was stopped goes on where it
was; a press that was stopped goes on from its checkpoint.
"""

import json
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from foundation.arrays import Floats
from foundation.cache import cache_folder, data_hash, read_with_checksum, write_with_checksum
from foundation.executor import HERE, Executor, completed_calls
from foundation.source_hash import source_hash
from softdot.config.hashes import input_hash
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from softdot.pressed import Pressed
from solve.result import PressResult


@dataclass(frozen=True)
class Signals:
    """A press in numbers; index 0 of each history (s,) is the unloaded array.

    charge_pC : (s, n) short-circuit charge of each segment's electrode; voltage_V : (s, n) of its open circuit, Q / C.
    readout_voltage_V : (s, n), each electrode behind an amplifier of its own; None without one.
    capacitance_pF : (n,). failure : None where it converged.
    """

    depth_mm: Floats
    force_N: Floats
    charge_pC: Floats
    voltage_V: Floats
    readout_voltage_V: Floats | None
    capacitance_pF: Floats
    unknowns: int
    newton_iterations: int
    max_relative_residual: float
    solve_s: float
    warnings: tuple[str, ...]
    failure: str | None

    @property
    def signal_V(self) -> Floats:
        """Voltage (s, n) that is read: behind the amplifiers where there are some, else at open circuit."""
        return self.voltage_V if self.readout_voltage_V is None else self.readout_voltage_V


class StoppedPressError(RuntimeError):
    """A press of the array did not converge: which one, where and why. The command exits with 3."""


class ArrayPresses:
    """Presses of a study in numbers, each solved once by an executor.

    told : after each press, how many are there, of how many, and the name of that one.
    """

    def __init__(self, executor: Executor = HERE, told: Callable[[int, int, str], None] = lambda *_: None) -> None:
        self._executor, self._told = executor, told
        self._known: dict[Path, Signals] = {}

    def __call__(self, presses: Mapping[str, PreparedPress]) -> dict[str, Signals]:
        """Signals of each press by its name. StoppedPressError where one did not converge, InputError, MeshingError."""
        paths = {name: _path(press) for name, press in presses.items()}
        self._known |= {path: found for path in paths.values() if (found := self._recall(path)) is not None}
        missing = {path: name for name, path in paths.items() if path not in self._known}
        calls = {path: (presses[name].config,) for path, name in missing.items()}
        there = len(presses) - len(missing)
        for number, (path, future) in enumerate(completed_calls(self._executor, solve_signals, calls), 1 + there):
            self.know(path, require_converged(future.result(), missing[path]))
            self._told(number, len(presses), missing[path])
        return {name: self._known[path] for name, path in paths.items()}

    def _recall(self, path: Path) -> Signals | None:
        """Signals of a press that this object or the disk knows, else None."""
        return self._known.get(path) or recall(path)

    def with_fields(self, press: PreparedPress, name: str, others: Mapping[str, PreparedPress]) -> PressResult:
        """The solver's own result of a press, solved beside others, which are then known. Errors as for a call."""
        future = self._executor.submit(solve_config, press.config)
        self({key: other for key, other in others.items() if _path(other) != _path(press)})
        found, result = future.result()
        assert isinstance(result, PressResult)
        self.know(_path(press), require_converged(found, name))
        return result

    def know(self, path: Path, found: Signals) -> None:
        """Keep what was solved, on disk too."""
        self._known[path] = found
        _keep(path, found)


def solve_signals(config: Config) -> Signals:
    """Signals of the press of a configuration."""
    return signals(PreparedPress(config))


def solve_config(config: Config) -> tuple[Signals, PressResult]:
    """Signals of the press of a configuration, and the solver's own result."""
    return _solve(PreparedPress(config))


def require_converged(found: Signals, what: str) -> Signals:
    """Return the signals of a press. StoppedPressError where it stopped short."""
    if found.failure is not None:
        raise StoppedPressError(f"{what} did not converge: {found.failure}")
    return found


def signals(press: PreparedPress) -> Signals:
    """Solve a press, or take it from the cache. What did not converge has a failure and what was reached before it.

    InputError, MeshingError.
    """
    return recall(_path(press)) or _solve(press)[0]


def recall(path: Path) -> Signals | None:
    """Signals of a press in a file, None where it was not solved before."""
    kept = read_with_checksum(path)
    return None if kept is None else _decode(json.loads(kept))


def _solve(press: PreparedPress) -> tuple[Signals, PressResult]:
    begun = time.perf_counter()
    result = press.solve()
    found = signals_of(press, result, time.perf_counter() - begun)
    _keep(_path(press), found)
    return found, result


def _path(press: PreparedPress) -> Path:
    """File in which a press is kept."""
    key = data_hash([source_hash(__name__), input_hash(press.config)])
    return cache_folder() / f"array-{key}.json"


def signals_of(press: PreparedPress, result: PressResult, solve_s: float) -> Signals:
    """Signals of the result of a press; solve_s : time of its solution in s."""
    pressed, steps = Pressed(press, result), result.steps
    readout = pressed.channel_voltages_V
    return Signals(
        depth_mm=pressed.indentation_mm,
        force_N=pressed.reaction_force_N,
        charge_pC=np.column_stack(list(pressed.charges_pC.values())),
        voltage_V=np.column_stack(list(pressed.voltages_V.values())),
        readout_voltage_V=None if readout is None else readout.T,
        capacitance_pF=1e12 * result.capacitance_F,
        unknowns=result.unknowns,
        newton_iterations=sum(step.newton_iterations for step in steps),
        max_relative_residual=result.max_relative_residual,
        solve_s=solve_s,
        warnings=tuple(pressed.doubts),
        failure=result.failure,
    )


def _keep(path: Path, found: Signals) -> None:
    if found.failure is not None or path.exists():
        return
    tree = {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in asdict(found).items()}
    with suppress(OSError):  # a cache that cannot be written is no cache
        write_with_checksum(path, json.dumps(tree).encode())


def _decode(tree: dict[str, Any]) -> Signals:
    arrays = {key: np.array(value) for key, value in tree.items() if isinstance(value, list)}
    return Signals(**{**tree, **arrays, "warnings": tuple(tree["warnings"])})
