"""The designs of a segment that can be made: what may vary, and within which limits."""

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from typing import Any

import numpy as np
from scipy.stats import qmc

from foundation.arrays import Floats
from softdot.config.schema import Config
from softdot.studies.paper.segment import Boundary, Reading, segment_config

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
