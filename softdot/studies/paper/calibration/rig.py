"""The sensor of Fig. 1 and Table 1 as configurations: film on sponge, under an OHP sheet or rubber."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from softdot.config.loading import config_from
from softdot.config.schema import Config

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
