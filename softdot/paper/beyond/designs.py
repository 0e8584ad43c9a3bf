"""The designs of a segment that can be made: what may vary, within which limits, and the press that judges one.

Designs pressed with free and with clamped sides.
"""

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from typing import Any

import numpy as np
from scipy.stats import qmc

from geometry.arrays import Floats
from softdot.config import Config
from softdot.console import Progress
from softdot.paper.published import Boundary, Reading, segment_config

FILMS_UM = (9.0, 28.0, 52.0, 110.0)
"""Thicknesses of drawn PVDF film that are sold: MSI Piezo Film Sensors Technical Manual, p. 3."""
SHEET_MM = (0.3, 4.0)
"""From the thinnest sheet that is cast with a known thickness to the paper's thickest medium 1."""
SOFT_MPA = (0.05, 5.0)
"""Young's modulus of castable elastomers: Ecoflex 00-30 to the paper's vulcanised natural rubber."""


@dataclass(frozen=True)
class Design:
    """What may vary; everything else is as in the paper."""

    h1_mm: float
    e1_MPa: float
    h2_mm: float
    e2_MPa: float
    effector_height_mm: float
    effector_MPa: float
    film_um: float


PAPERS = Design(0.5, 5.0, 2.0, 1.0, 1.0, 1.0, 28.0)
"""The paper's final design; its effector's height is fitted, see softdot.paper.published."""
LOW = Design(SHEET_MM[0], SOFT_MPA[0], 0.5, SOFT_MPA[0], SHEET_MM[0], SOFT_MPA[0], FILMS_UM[0])
HIGH = Design(SHEET_MM[1], SOFT_MPA[1], 4.0, SOFT_MPA[1], 1.5, SOFT_MPA[1], FILMS_UM[-1])


def sample(count_log2: int, seed: int) -> list[Design]:
    """2^count_log2 designs that fill the space evenly in the logarithm of every variable (scrambled Sobol)."""
    unit = qmc.Sobol(len(astuple(LOW)), rng=seed).random_base2(count_log2)
    return [design_at(point) for point in unit]


def papers_variables(count_log2: int, seed: int) -> list[Design]:
    """The same for h1, E1, h2 and E2 alone; effector and film stay the paper's."""
    unit = qmc.Sobol(4, rng=seed).random_base2(count_log2)
    others = {name: getattr(PAPERS, name) for name in ("effector_height_mm", "effector_MPa", "film_um")}
    return [replace(design_at(np.append(point, [0.0, 0.0, 0.0])), **others) for point in unit]


def design_at(unit: Floats) -> Design:
    """The design at a point (7,) of the unit cube; the film becomes one that is sold."""
    low, high = np.log(astuple(LOW)), np.log(astuple(HIGH))
    values = [float(f"{value:.3g}") for value in np.exp(low + np.asarray(unit) * (high - low))]
    film = FILMS_UM[min(int(unit[-1] * len(FILMS_UM)), len(FILMS_UM) - 1)]
    return replace(Design(*values), film_um=film)


def coordinates(designs: Sequence[Design]) -> Floats:
    """Logarithms of the variables (n, 7), scaled so that the limits lie at 0 and 1."""
    low, high = np.log(astuple(LOW)), np.log(astuple(HIGH))
    scaled: Floats = (np.log([astuple(design) for design in designs]) - low) / (high - low)
    return scaled


def design_config(design: Design, boundary: Boundary, reading: Reading, mesh: Mapping[str, Any]) -> Config:
    """The press of a design. mesh : the table [mesh]."""
    return segment_config(
        boundary, design.h1_mm, design.e2_MPa, reading, h2_mm=design.h2_mm, film_um=design.film_um,
        effector_height_mm=design.effector_height_mm, effector_MPa=design.effector_MPa, e1_MPa=design.e1_MPa,
        load_steps=3, mesh=mesh,
    )  # fmt: skip


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
        """With a cable and an amplifier of this capacitance beside the film, which lose no charge."""
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
    designs: Sequence[Design], reading: Reading, mesh: Mapping[str, Any], progress: Progress
) -> list[DesignTrial]:
    """Press every design with both boundaries; a design of which one press does not converge is left out."""
    from softdot.sweeps import solve_points

    configs = [design_config(design, boundary, reading, mesh) for design in designs for boundary in BOUNDARIES]
    records = solve_points(configs, progress)
    pairs = zip(designs, records[::2], records[1::2], strict=True)
    return [DesignTrial(design, press_of(free), press_of(held)) for design, free, held in pairs if _solved(free, held)]


def _solved(*records: Mapping[str, Any]) -> bool:
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
