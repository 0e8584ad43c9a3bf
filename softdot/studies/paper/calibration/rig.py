"""The sensor of Fig. 1 and Table 1 as configurations: film on sponge, under an OHP sheet or rubber.

What p depends on and the paper does not say: every input with its range.

The acrylic beam that carries dot and strain gauge, as a displacement sensor.

A cantilever of free length L, the gauge at its clamp, the dot at its end. The hand pushes with P at the distance a
nearer to the clamp, the sensor pushes back with F. Bernoulli's beam (Gere and Goodno, Mechanics of Materials, 2012,
appendix H) gives the moment at the gauge and the deflection of the dot,
    M = P (L - a) - F L,
    w = P (L - a)^2 (2 L + a) / 6 E I - F L^3 / 3 E I          (a >= 0; beyond the dot P L^2 (2 L - 3 a) / 6 E I).
The gauge was calibrated at the end: it reads u = M L^2 / 3 E I. With a = 0 that is w, whatever F: the beam is a
spring in parallel to the sensor, and stays out of p.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import exp, log
from typing import Any, Literal

from scipy.optimize import brentq

from softdot.config import Config, config_from

Section = Literal["plane-strain", "solid"]

FILM_MM, SPONGE_MM, SPONGE_MPA = 16.0, 5.0, 0.05
TABLE_SPONGE_MPA = 0.005  # as Table 1 prints it, against the text
DOT_HEIGHT_MM = 4.0  # higher than any press is deep: the beam must not touch the sensor
OHP_POISSON_RATIO, RUBBER_POISSON_RATIO = 0.38, 0.495
LOAD_STEPS = 6
SLICE_SIZES = {"element_size_mm": 1.0, "contact_element_size_mm": 0.15, "film_element_size_mm": 0.6}
SOLID_SIZES = {"element_size_mm": 4.0, "contact_element_size_mm": 0.5, "film_element_size_mm": 4.0}
FINENESS = 0.7
"""The finer meshes, against the others."""


@dataclass(frozen=True)
class RigCase:
    """One row of Table 1."""

    name: str
    title: str
    thickness_mm: float
    material: Mapping[str, Any]
    depth_mm: float


OHP_SHEET = {"model": "linear", "youngs_modulus_MPa": 3000.0, "poisson_ratio": OHP_POISSON_RATIO}
RUBBER = {"model": "neo-hookean", "youngs_modulus_MPa": 1.0, "poisson_ratio": RUBBER_POISSON_RATIO}
CASES = {
    "I": RigCase("I", "OHP sheet", 0.3, OHP_SHEET, 0.831),
    "II": RigCase("II", "rubber", 1.0, RUBBER, 1.57),
}


def constant_sponge(poisson_ratio: float, youngs_modulus_MPa: float = SPONGE_MPA) -> dict[str, Any]:
    """The sponge as simulated: one modulus."""
    return {"model": "neo-hookean", "youngs_modulus_MPa": youngs_modulus_MPa, "poisson_ratio": poisson_ratio}


def foam(exponent: float, poisson_ratio: float) -> dict[str, Any]:
    """The sponge as a foam of the same Young's modulus at small strain."""
    shear = SPONGE_MPA / (2.0 * (1.0 + poisson_ratio))
    return {"model": "hyperfoam", "mu_MPa": [shear], "alpha": [exponent], "poisson_ratio": [poisson_ratio]}


def rig_config(
    case: RigCase,
    section: Section,
    sponge: Mapping[str, Any],
    dot_radius_mm: float,
    *,
    finer: bool = False,
    mechanisms: tuple[Mapping[str, Any], ...] = (),
) -> Config:
    """One press to the mean depth of Table 1, open circuit. sponge : its table in [materials]."""
    solid = section == "solid"
    sizes, scale = SOLID_SIZES if solid else SLICE_SIZES, FINENESS if finer else 1.0
    return config_from(
        {
            "segment": {
                "length_mm": FILM_MM,
                "width_mm": FILM_MM,
                "section": section,
                "boundary": "free",
                "medium1": {"thickness_mm": case.thickness_mm, "material": "medium1"},
                "film": {"thickness_um": 28.0, "material": "pvdf"},
                "medium2": {"thickness_mm": SPONGE_MM, "material": "medium2"},
            },
            "materials": {"medium1": dict(case.material), "medium2": dict(sponge)},
            "dot": {"shape": "cap" if solid else "ridge", "radius_mm": dot_radius_mm, "height_mm": DOT_HEIGHT_MM},
            "press": {"indentation_mm": case.depth_mm, "load_steps": LOAD_STEPS},
            "mesh": {"mesher": "layered", **{key: scale * size for key, size in sizes.items()}},
            "mechanisms": [dict(mechanism) for mechanism in mechanisms],
        }
    )


Values = Mapping[str, float]
"""Name of an input -> its value, in the unit of the name."""


@dataclass(frozen=True)
class Input:
    """One unknown of the rig. assumed : the value taken where a single one is needed."""

    name: str
    title: str
    unit: str
    low: float
    assumed: float
    high: float
    why: str
    logarithmic: bool = False

    def at(self, share: float) -> float:
        """The value a share, 0 to 1, of the way from low to high."""
        if self.logarithmic:
            return exp(log(self.low) + share * (log(self.high) - log(self.low)))
        return self.low + share * (self.high - self.low)


INPUTS = {
    entry.name: entry
    for entry in (
        Input(
            "resistance_MOhm",
            "input resistance R",
            "MΩ",
            0.5,
            1.0,
            10.0,
            "1 MΩ is usual for filters and oscilloscopes, half of it if both load the film, 10 MΩ for a probe",
            logarithmic=True,
        ),
        Input(
            "capacitance_pF",
            "capacitance C of input and cable",
            "pF",
            50.0,
            150.0,
            400.0,
            "1 to 3 m of coaxial cable, about 100 pF/m, and the input",
        ),
        Input(
            "press_time_s",
            "press time T, from touch to full depth",
            "s",
            0.1,
            1.0 / 3.0,
            0.5,
            "ten presses in ten seconds: press and release last at most one second together",
        ),
        Input("dot_radius_mm", "radius of the copper dot", "mm", 0.75, 0.8, 1.2, "Braille dots have 0.75 to 0.85 mm"),
        Input(
            "poisson_ratio",
            "Poisson's ratio of the simulated sponge",
            "",
            0.0,
            0.3,
            0.495,
            "from an open foam to the rubbers of the paper's Table 2",
        ),
        Input(
            "foam_poisson_ratio",
            "Poisson's ratio of the real sponge",
            "",
            0.05,
            0.05,
            0.3,
            "open cells near 0, closed cells about 0.3",
        ),
        Input("foam_exponent", "exponent α of the foam law", "", 8.0, 12.0, 20.0, "early or late softening of a foam"),
        Input("beam_length_mm", "free length of the beam", "mm", 50.0, 100.0, 150.0, "bar of 2 × 9 mm under a finger"),
        Input(
            "push_offset_mm",
            "hand nearer to the clamp than the dot",
            "mm",
            -2.0,
            0.0,
            2.0,
            "a fingertip is about 10 mm wide; negative: beyond the dot",
        ),
    )
}


def assumed(**changes: float) -> dict[str, float]:
    """The assumed value of every input, but for the changed ones."""
    return {name: entry.assumed for name, entry in INPUTS.items()} | changes


BENDING_STIFFNESS_N_MM2 = 2800.0 * 9.0 * 2.0**3 / 12.0
"""E I of acrylic, 2.8 GPa, 9 mm wide and 2 mm high."""


def tip_stiffness_N_per_mm(length_mm: float) -> float:
    """Force per deflection at the end of the beam alone."""
    return 3.0 * BENDING_STIFFNESS_N_MM2 / length_mm**3


def dot_depth_mm(read_mm: float, force_at: Callable[[float], float], length_mm: float, push_offset_mm: float) -> float:
    """How deep the dot stands when the gauge reads read_mm; force_at : depth in mm -> force in N."""

    def missing(depth: float) -> float:
        return _deflection_mm(read_mm, force_at(depth), length_mm, push_offset_mm) - depth

    return float(brentq(missing, 0.0, 4.0 * read_mm, xtol=1e-9)) if missing(0.0) > 0.0 else 0.0


def _deflection_mm(read_mm: float, force_N: float, length_mm: float, offset_mm: float) -> float:
    """Deflection of the dot at what the gauge reads and a force of the sensor."""
    moment = 3.0 * BENDING_STIFFNESS_N_MM2 / length_mm**2 * read_mm
    arm = length_mm - offset_mm
    push = (moment + force_N * length_mm) / arm
    if offset_mm >= 0.0:
        by_push = push * arm**2 * (2.0 * length_mm + offset_mm)
    else:
        by_push = push * length_mm**2 * (2.0 * length_mm - 3.0 * offset_mm)
    return (by_push - 2.0 * force_N * length_mm**3) / (6.0 * BENDING_STIFFNESS_N_MM2)
