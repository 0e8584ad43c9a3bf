"""What an experimenter believes was built, how it is pressed and how noisy it is."""

from dataclasses import dataclass

from softdot.studies.proof.world.amplifier import Amplifier
from softdot.studies.proof.world.made import Made
from softdot.studies.proof.world.runs import Run


@dataclass(frozen=True)
class Bench:
    """Rig, specimen and runs. nuisance : name -> one sigma, as in rig.toml. noise : one sigma as a share of the largest
    signal of a channel.

    mesh_mm : sizes of elements and of those at the dot that the experimenter chose; None for none.
    peak_V, peak_N : about the largest signals, to scale noise and effects. force : whether a load cell is there.
    usual : whether a proof has it where no rigs are asked for.
    """

    name: str
    made: Made
    amplifier: Amplifier
    runs: tuple[Run, ...]
    nuisance: tuple[tuple[str, float], ...]
    peak_V: float
    peak_N: float
    noise: float = 0.004
    rate_Hz: float = 250.0
    force: bool = True
    mesh_mm: tuple[float, float] | None = None
    usual: bool = False

    def floating(self, run: Run) -> tuple[tuple[str, float], ...]:
        """Nuisances of a run: those of a load cell too where it has one of its own."""
        return self.nuisance + (LOAD_CELL if run.load_cell and not self.force else ())

    @property
    def deepest_mm(self) -> float:
        """Largest depth of all runs."""
        return max(run.depth_mm for run in self.runs)

    @property
    def film_pF(self) -> float:
        """Capacitance of the film."""
        return self.made.capacitance_pF

    @property
    def voltages(self) -> tuple[str, ...]:
        """Names of the voltage channels."""
        count = len(self.made.electrodes)
        return tuple(f"voltage_{n}_V" for n in range(1, count + 1)) or ("voltage_V",)


LOAD_CELL = ("force_gain", 0.02), ("offset_N", 0.01)
