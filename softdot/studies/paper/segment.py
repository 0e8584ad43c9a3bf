"""The paper's segment as a configuration, in two readings.

The paper gives neither the width of its segment across its drawings, nor the effector's height, nor the dot's radius.
`plane-strain` reads the drawings as they are: nothing varies across a width of 16 mm, the film's width in the
experiment. `solid` takes the sentence that a segment reads one Braille dot at its word: 2.5 x 2.5 mm, a round dot.
"""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from softdot.config.loading import config_from
from softdot.config.schema import Config

Reading = Literal["plane-strain", "solid"]
Boundary = Literal["free", "clamped"]
LENGTH_MM = 2.5
FILM_WIDTH_MM = 16.0  # section 2 of the paper
FILM_UM = 28.0


H2_MM = 2.0  # the tables; the text says 5


E1_MPA = 5.0


EFFECTOR_MPA = 1.0
POISSON_RATIO = 0.495
INDENTATION_MM = 0.3
EFFECTOR_HEIGHT_MM = 1.0  # fitted to the paper's forces and voltages
RIDGE_RADIUS_MM = 1.15  # fitted to the paper's forces and voltages
HELD_LAYERS = ("effector", "medium1", "film")  # fitted too: with the sides of medium 2 held the film is blocked
DEFAULT_MESH = {"element_size_mm": 0.3, "contact_element_size_mm": 0.1, "mesher": "layered"}


def segment_config(
    boundary: Boundary,
    h1_mm: float,
    e2_MPa: float,
    reading: Reading = "plane-strain",
    *,
    h2_mm: float = H2_MM,
    film_um: float = FILM_UM,
    effector_height_mm: float = EFFECTOR_HEIGHT_MM,
    effector_MPa: float = EFFECTOR_MPA,
    e1_MPa: float = E1_MPA,
    ridge_radius_mm: float = RIDGE_RADIUS_MM,
    poisson_ratio: float = POISSON_RATIO,
    held_layers: Sequence[str] = HELD_LAYERS,
    load_steps: int = 4,
    mesh: Mapping[str, Any] = DEFAULT_MESH,
) -> Config:
    """One press of the paper's section 4: its segment with medium 1 of h1_mm and medium 2 of e2_MPa, and other designs.

    ridge_radius_mm : plane strain only; poisson_ratio : of all rubbers; load_steps : equal steps up to 0.3 mm;
    mesh : the table [mesh]. InputError for what cannot be built.
    """
    solid = reading == "solid"
    return config_from(
        {
            "segment": {
                "length_mm": LENGTH_MM,
                "width_mm": LENGTH_MM if solid else FILM_WIDTH_MM,
                "section": reading,
                "boundary": boundary,
                **({} if boundary == "free" else {"held_layers": list(held_layers)}),
                "effector": {"shape": "layer", "height_mm": effector_height_mm, "material": "effector"},
                "medium1": {"thickness_mm": h1_mm, "material": "medium1"},
                "film": {"thickness_um": film_um, "material": "pvdf"},
                "medium2": {"thickness_mm": h2_mm, "material": "medium2"},
            },
            "materials": {
                "effector": _rubber(effector_MPa, poisson_ratio),
                "medium1": _rubber(e1_MPa, poisson_ratio),
                "medium2": _rubber(e2_MPa, poisson_ratio),
            },
            "dot": {"shape": "cap", "standard": "marburg-medium"}
            if solid
            else {"shape": "ridge", "radius_mm": ridge_radius_mm},
            "press": {"indentation_mm": INDENTATION_MM, "load_steps": load_steps},
            "mesh": dict(mesh),
        }
    )


def _rubber(youngs_modulus_MPa: float, poisson_ratio: float) -> dict[str, Any]:
    return {
        "model": "neo-hookean",
        "youngs_modulus_MPa": youngs_modulus_MPa,
        "poisson_ratio": poisson_ratio,
        "density_kg_m3": 950.0,  # no part in a quasi-static press
    }
