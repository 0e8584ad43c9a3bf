"""Designs pressed with free and with clamped sides."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from foundation.executor import Executor
from softdot.progress import Progress
from softdot.studies.paper.beyond.designs import Design, design_config
from softdot.studies.paper.segment import Boundary, Reading

BOUNDARIES: tuple[Boundary, Boundary] = ("free", "clamped")


@dataclass(frozen=True)
class DesignPress:
    """One press at its full depth."""

    force_N: float
    voltage_V: float
    """Open circuit."""
    charge_pC: float
    capacitance_pF: float
    film_stress_MPa: float
    """Largest principal stress of the film, a mean over an element of the mesh."""

    def voltage_behind_V(self, cable_pF: float) -> float:
        """Voltage with a cable and an amplifier of this capacitance beside the film, which lose no charge."""
        return self.charge_pC / (self.capacitance_pF + cable_pF)


@dataclass(frozen=True)
class DesignTrial:
    """One design with both boundaries."""

    design: Design
    free: DesignPress
    clamped: DesignPress

    @property
    def presses(self) -> tuple[DesignPress, DesignPress]:
        """Free, clamped."""
        return self.free, self.clamped

    def worse_V(self, cable_pF: float = 0.0) -> float:
        """The smaller of the two voltages: open circuit, or behind a cable."""
        return min(press.voltage_behind_V(cable_pF) for press in self.presses)

    @property
    def force_N(self) -> float:
        """The larger of the two forces."""
        return max(press.force_N for press in self.presses)

    @property
    def film_stress_MPa(self) -> float:
        """The larger of the two film stresses."""
        return max(press.film_stress_MPa for press in self.presses)


def solve_trials(
    designs: Sequence[Design], reading: Reading, mesh: Mapping[str, Any], progress: Progress, executor: Executor
) -> list[DesignTrial]:
    """Press every design with both boundaries; a design of which one press does not converge is left out."""
    from softdot.sweeps.points import solve_points

    configs = [design_config(design, boundary, reading, mesh) for design in designs for boundary in BOUNDARIES]
    records = solve_points(configs, progress, executor=executor)
    pairs = zip(designs, records[::2], records[1::2], strict=True)
    return [
        DesignTrial(design, press_of(free), press_of(held)) for design, free, held in pairs if _all_solved(free, held)
    ]


def _all_solved(*records: Mapping[str, Any]) -> bool:
    return all(record["status"] == "solved" for record in records)


def press_of(outcome: Mapping[str, Any]) -> DesignPress:
    """The numbers that count here from the outcome of a press."""
    return DesignPress(
        force_N=outcome["reaction_force_N"][-1],
        voltage_V=outcome["open_circuit_voltage_V"][-1],
        charge_pC=outcome["film_charge_pC"][-1],
        capacitance_pF=outcome["film"]["capacitance_pF"],
        film_stress_MPa=outcome["film"]["max_principal_stress_MPa"],
    )
