"""The input of the amplifier, solved together with the film: resistance and capacitance parallel to it.

With the film's short-circuit charge Q_s, its capacitance C_f, input C_in and R, and C = C_f + C_in,
    C V' = Q_s' - V / R.
For a charge that is linear over the step the exact update is (as in amplifier.leaky_integral)
    Q_s - Q_s,old - C (V - exp(-a) V_old) / phi = 0,      a = dt / (R C),    phi = (1 - exp(-a)) / a.
The film's elements contribute Q_s - C_f V to the row of their voltage; this term adds the rest, so that the tangent
stays symmetric. R = inf with C_in = 0 is open circuit: the total charge stays zero.

Capacitances between inputs take a charge M V more, with M the matrix of them: it leaves the film as the rest does, so
that the charge which the circuit remembers is Q_s - M V.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.decay import mean_decay
from solve.terms.base import Block, History, Term, Trial

SHORT = 1e9  # as good as a short circuit


@dataclass(frozen=True)
class Circuit(Term):
    """Electrodes of one voltage on one input, in solver units; resistance is one of charge, so in seconds times V."""

    voltage_dof: int
    film_capacitance: float
    input_capacitance: float
    resistance: float

    @property
    def groups(self) -> tuple[Ints, ...]:
        """The voltage."""
        return (np.array([[self.voltage_dof]]),)

    def start(self) -> History:
        """Short-circuit charge and voltage at rest."""
        return 0.0, 0.0

    def _balance(self, trial: Trial, history: History) -> tuple[float, float]:
        """The charge Q_s that the circuit asks for at the trial voltage, and its derivative."""
        charge, voltage = history
        capacitance = self.film_capacitance + self.input_capacitance
        if np.isinf(trial.time_step):  # long at rest: discharged
            return SHORT * capacitance * float(trial.x[self.voltage_dof]), SHORT * capacitance
        a = trial.time_step / (self.resistance * capacitance)
        phi = float(mean_decay(a))
        now = float(trial.x[self.voltage_dof])
        return charge + capacitance * (now - np.exp(-a) * voltage) / phi, capacitance / phi

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Charge that the circuit takes from the row of the film's voltage."""
        charge, slope = self._balance(trial, history)
        residual = self.film_capacitance * float(trial.x[self.voltage_dof]) - charge
        yield Block(0, slice(0, 1), np.array([[[self.film_capacitance - slope]]]), np.array([[residual]]))

    def advance(self, trial: Trial, history: History) -> History:
        """Charge and voltage at the converged state."""
        return self._balance(trial, history)[0], float(trial.x[self.voltage_dof])


@dataclass(frozen=True)
class TiedInputs(Term):
    """Inputs that capacitances tie together; matrix : (k, k) of them between k voltages, in solver units."""

    voltage_dofs: Ints
    matrix: Floats

    @property
    def groups(self) -> tuple[Ints, ...]:
        """The voltages."""
        return (self.voltage_dofs[None, :],)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Charges that the capacitances between the inputs take from the rows of the voltages."""
        charge = self.matrix @ trial.x[self.voltage_dofs]
        yield Block(0, slice(0, 1), -self.matrix[None], -charge[None])
