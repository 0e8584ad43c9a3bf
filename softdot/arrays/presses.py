"""What a solved press of an array gives: force, and charge and voltage of every segment, against depth.

Outcomes are kept on disk (softdot.outcome), so that an array study that was stopped goes on where it was; a press that
was stopped goes on from its checkpoint.
"""

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from foundation.arrays import Floats
from foundation.executor import HERE, Executor, completed_calls
from softdot.config.schema import Config
from softdot.outcome import keep_outcome, outcome, outcome_key, solve_with_fields, stored_outcome
from softdot.prepared_press import PreparedPress
from solve.result import PressResult


class Signals:
    """The outcome of a press as arrays; index 0 of each history (s,) is the unloaded array.

    charge_pC : (s, n) short-circuit charge of each segment's electrode; voltage_V : (s, n) of its open circuit, Q / C.
    readout_voltage_V : (s, n), each electrode behind an amplifier of its own; None without one. signal_V : (s, n), what
    is read: the voltage behind the amplifiers where there are some, else at open circuit. capacitance_pF : (n,).
    """

    def __init__(self, outcome: Mapping[str, Any], solve_s: float = 0.0) -> None:
        """outcome : as in softdot.outcome; solve_s : time in s that it took here."""
        self.outcome, self.solve_s, electrodes = outcome, solve_s, outcome["electrodes"]

        def of_electrodes(key: str) -> Floats:
            return np.array([one[key] for one in electrodes], dtype=np.float64).T

        self.depth_mm, self.force_N = np.array(outcome["indentation_mm"]), np.array(outcome["reaction_force_N"])
        self.charge_pC, self.voltage_V = of_electrodes("film_charge_pC"), of_electrodes("open_circuit_voltage_V")
        amplified = "readout_voltage_V" in electrodes[0]
        self.readout_voltage_V = of_electrodes("readout_voltage_V") if amplified else None
        self.signal_V = self.voltage_V if self.readout_voltage_V is None else self.readout_voltage_V
        self.capacitance_pF = of_electrodes("capacitance_pF")


class StoppedPressError(RuntimeError):
    """A press of the array did not converge: which one, where and why. The command exits with 3."""


class ArrayPresses:
    """Presses of a study in numbers, each solved once by an executor.

    told : after each press, how many are there, of how many, and the name of that one.
    """

    def __init__(self, executor: Executor = HERE, told: Callable[[int, int, str], None] = lambda *_: None) -> None:
        self._executor, self._told = executor, told
        self._known: dict[str, Signals] = {}

    def __call__(self, presses: Mapping[str, PreparedPress]) -> dict[str, Signals]:
        """Signals of each press by its name. StoppedPressError where one stopped or has no mesh, InputError."""
        keys = {name: outcome_key(press.config) for name, press in presses.items()}
        for name, key in keys.items():
            if key not in self._known and (stored := stored_outcome(presses[name].config)) is not None:
                self._know(presses[name].config, name, stored)
        missing = {key: name for name, key in keys.items() if key not in self._known}
        calls = {name: (presses[name].config,) for name in missing.values()}
        there = len(presses) - len(missing)
        for number, (name, future) in enumerate(completed_calls(self._executor, timed_outcome, calls), 1 + there):
            self._know(presses[name].config, name, *future.result())
            self._told(number, len(presses), name)
        return {name: self._known[key] for name, key in keys.items()}

    def with_fields(self, press: PreparedPress, name: str, others: Mapping[str, PreparedPress]) -> PressResult:
        """The solver's own result of a press, solved beside others, which are then known. Errors as for a call."""
        future, key = self._executor.submit(solve_with_fields, press.config), outcome_key(press.config)
        self({other: one for other, one in others.items() if outcome_key(one.config) != key})
        found, result = future.result()
        self._know(press.config, name, found)
        assert isinstance(result, PressResult)
        return result

    def _know(self, config: Config, name: str, found: Mapping[str, Any], solve_s: float = 0.0) -> None:
        """Keep the outcome of a press, on disk too. StoppedPressError where it stopped short."""
        if not found["solver"]["converged"]:
            raise StoppedPressError(f"{name} did not converge: {found['solver']['failure']}")
        keep_outcome(config, found)
        self._known[outcome_key(config)] = Signals(found, solve_s)


def timed_outcome(config: Config) -> tuple[dict[str, Any], float]:
    """The outcome of a press and the time in s that it took."""
    begun = time.perf_counter()
    return outcome(config), time.perf_counter() - begun
