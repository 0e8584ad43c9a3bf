"""The designs of a segment that can be made: what may vary, within which limits, and the press that judges one.

Designs pressed with free and with clamped sides.

Design parameters: what each says a segment's output goes with. The paper's own, and corrected ones.

All work on many designs at once; lengths in mm, moduli in MPa, forces in N per mm of width.
"""

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from typing import Any, cast

import numpy as np
from scipy.stats import qmc

from geometry.arrays import Floats
from geometry.executor import Executor
from softdot.config import Config
from softdot.console import Progress
from softdot.studies.paper.analytical.formulas import (
    bending_softness,
    index_of_modulus,
    index_of_thickness,
    plane_strain_modulus_Pa,
    softness,
)
from softdot.studies.paper.published import (
    INDENTATION_MM,
    LENGTH_MM,
    POISSON_RATIO,
    RIDGE_RADIUS_MM,
    Boundary,
    Reading,
    segment_config,
)
from solve.materials.parameters import VACUUM_PERMITTIVITY, PiezoelectricFilm, find_material

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
"""The paper's final design; its effector's height is fitted, see softdot.studies.paper.published."""
LOW = Design(SHEET_MM[0], SOFT_MPA[0], 0.5, SOFT_MPA[0], SHEET_MM[0], SOFT_MPA[0], FILMS_UM[0])
HIGH = Design(SHEET_MM[1], SOFT_MPA[1], 4.0, SOFT_MPA[1], 1.5, SOFT_MPA[1], FILMS_UM[-1])


def sample(count_log2: int, seed: int) -> list[Design]:
    """2^count_log2 designs that fill the space evenly in the logarithm of every variable (scrambled Sobol)."""
    unit = qmc.Sobol(len(astuple(LOW)), rng=seed).random_base2(count_log2)
    return [design_at(point) for point in unit]


def papers_variables(count_log2: int, seed: int) -> list[Design]:
    """Designs that differ in h1, E1, h2 and E2 alone; effector and film stay the paper's."""
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
    designs: Sequence[Design], reading: Reading, mesh: Mapping[str, Any], progress: Progress, executor: Executor
) -> list[DesignTrial]:
    """Press every design with both boundaries; a design of which one press does not converge is left out."""
    from softdot.sweeps.points import solve_points

    configs = [design_config(design, boundary, reading, mesh) for design in designs for boundary in BOUNDARIES]
    records = solve_points(configs, progress, executor=executor)
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


CONTACT_MM = 2.0 * np.sqrt(RIDGE_RADIUS_MM * INDENTATION_MM)
"""Width of the contact, 2 sqrt(R u): the scale of Hertz."""
BISECTIONS = 60


@dataclass(frozen=True)
class Columns:
    """The variables of n designs, each (n,)."""

    h1: Floats
    e1: Floats
    h2: Floats
    e2: Floats
    effector: Floats
    e_effector: Floats
    film: Floats
    """Thickness in mm."""


def columns(designs: Sequence[Design]) -> Columns:
    """The variables of the designs, the film's thickness in mm."""
    table = Columns(*np.array([astuple(design) for design in designs]).T)
    return replace(table, film=1e-3 * table.film)


def papers_parameters(designs: Sequence[Design]) -> dict[str, Floats]:
    """The paper's parameters (n,). S_A and S_B put designs in the order of S_2/S_1, or its reverse.

    S_1 + S_2 is no parameter of the paper but stands in the denominator of its Eq. (7).
    """
    c = columns(designs)
    s1 = np.array([softness(h, LENGTH_MM, e) for h, e in zip(c.h1, c.e1, strict=True)])
    s2 = np.array([softness(h, LENGTH_MM, e) for h, e in zip(c.h2, c.e2, strict=True)])
    return {
        "f": np.vectorize(index_of_thickness)(c.h1, c.h2),
        "e": np.vectorize(index_of_modulus)(c.e1, c.e2),
        "S₁": s1,
        "S₂": s2,
        "S₂/S₁": s2 / s1,
        "S₁b": np.vectorize(bending_softness)(LENGTH_MM, c.e1, c.h1),
        "S₁ + S₂": s1 + s2,
    }


def free_force_N_per_mm(c: Columns) -> Floats:
    """Depth over the softness of the stack, corrected twice (Eq. 7 has neither).

    Above the film the load spreads from the width of the contact by 45 degrees on either side. Below it medium 2
    is held by base and film, which do not stretch: its modulus grows by the shape factor of Gent and Lindley.
    """
    above = spread_softness([(c.effector, _wide(c.e_effector)), (c.h1, _wide(c.e1))], 1.0)
    below = c.h2 / (LENGTH_MM * _wide(c.e2) * shape_factor(c.h2))
    return INDENTATION_MM / (above + below)


def free_voltage_V(c: Columns, tension_share: float) -> Floats:
    """Media that are squeezed want to widen; the film holds them and is pulled by a share of the force.

    The film is so stiff in its plane that its tension, and so the voltage g31 N, does not depend on its thickness.
    tension_share : tension of the film over the pressing force; fitted.
    """
    force = free_force_N_per_mm(c)
    tension = 1e3 * tension_share * force  # N/m
    return (_stretch_coefficient() * tension + _thickness_voltage(c, force)) / _permittivity()


def clamped_voltage_V(c: Columns, give: float, rest: float, film_stiffness: float = 1.0) -> Floats:
    """The held film is stretched by its deflection w: mean strain (8/3) (w/l)² of a parabola.

    give, rest : see local_softness; fitted. film_stiffness : 0 leaves out the membrane stiffness of the film.
    """
    deflection, force = clamped_deflection(c, give, rest, film_stiffness)
    strain = 8.0 / 3.0 * (deflection / LENGTH_MM) ** 2
    stretched = _stretch_coefficient() * _film_modulus_Pa() * strain * 1e-3 * c.film
    return (stretched + _thickness_voltage(c, force)) / _permittivity()


def clamped_deflection(c: Columns, give: float, rest: float, film_stiffness: float = 1.0) -> tuple[Floats, Floats]:
    """Deflection w of the film in mm and force in N/mm.

    Equilibrium of the local softness above with what carries the film, for a parabola of sagitta w by energies:
    (u - w) / S = (16/3) sum(G h) w / l + (8/15) E2' l w / h2 + (128/9) sum(E' h) (w/l)³
    shear of the held media, medium 2 as a foundation, stretch of the held layers, of which the film is stiffest.
    The left side falls with w and the right side rises: bisection finds the only root.
    """
    local = give * spread_softness([(c.effector, _wide(c.e_effector)), (c.h1, _wide(c.e1))], rest)
    shear = 16.0 / 3.0 * (_shear(c.e_effector) * c.effector + _shear(c.e1) * c.h1) / LENGTH_MM
    foundation = 8.0 / 15.0 * _wide(c.e2) * shape_factor(c.h2) * LENGTH_MM / c.h2
    membrane = film_stiffness * 1e-6 * _film_modulus_Pa() * c.film + _wide(c.e1) * c.h1
    membrane = membrane + _wide(c.e_effector) * c.effector
    low, high = np.zeros_like(c.h1), np.full_like(c.h1, INDENTATION_MM)
    for _ in range(BISECTIONS):
        middle = (low + high) / 2.0
        carried = (shear + foundation) * middle + 128.0 / 9.0 * membrane * (middle / LENGTH_MM) ** 3
        deeper = (INDENTATION_MM - middle) / local > carried
        low, high = np.where(deeper, middle, low), np.where(deeper, high, middle)
    return low, (INDENTATION_MM - low) / local


def spread_softness(layers: Sequence[tuple[Floats, Floats]], rest: float) -> Floats:
    """Depth over force of layers (thickness, modulus) from the top, the load spreading by 45 degrees: 1/(N/mm) mm.

    Integral of dz / (E w) with the loaded width w = CONTACT_MM + 2 z up to the whole length. rest : share that counts
    where the whole length is loaded; below 1 for held sides, between which rubber can only shear.
    """
    full = (LENGTH_MM - CONTACT_MM) / 2.0
    top: Floats = np.zeros_like(layers[0][0])
    total = top
    for thickness, modulus in layers:
        bottom = top + thickness
        upper, lower = np.minimum(top, full), np.minimum(bottom, full)
        spreading = np.log((CONTACT_MM + 2.0 * lower) / (CONTACT_MM + 2.0 * upper)) / 2.0
        total = total + (spreading + rest * (thickness - (lower - upper)) / LENGTH_MM) / modulus
        top = bottom
    return total


def shape_factor(thickness_mm: Floats) -> Floats:
    """1 + S² with S = l / (2 h): a strip between two rigid faces (Gent and Lindley 1959)."""
    return 1.0 + (LENGTH_MM / (2.0 * thickness_mm)) ** 2


def _wide(modulus: Floats) -> Floats:
    return modulus / (1.0 - POISSON_RATIO**2)


def _shear(modulus: Floats) -> Floats:
    return modulus / (2.0 * (1.0 + POISSON_RATIO))


def film() -> PiezoelectricFilm:
    """The film of every design."""
    return cast(PiezoelectricFilm, find_material("pvdf", {}, "material"))


def _film_modulus_Pa() -> float:
    return plane_strain_modulus_Pa(1e6 * film().youngs_modulus_MPa, film().poisson_ratio)


def _stretch_coefficient() -> float:
    """Charge density over stress along the film in C/N: d31 + nu d32, as nothing strains across it."""
    pvdf = film()
    return 1e-12 * (pvdf.d31_pC_per_N + pvdf.poisson_ratio * pvdf.d32_pC_per_N)


def _permittivity() -> float:
    return VACUUM_PERMITTIVITY * film().relative_permittivity


def _thickness_voltage(c: Columns, force: Floats) -> Floats:
    """Charge density times thickness that the pressure gives through d33, C/m."""
    pressure = 1e6 * force / LENGTH_MM
    return -1e-12 * film().d33_pC_per_N * pressure * 1e-3 * c.film
