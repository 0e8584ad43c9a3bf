"""Whole presses by the pipeline that softdot run takes: a block that relaxes, and two segments pressed at once."""

from functools import cache
from typing import Any

import numpy as np

from softdot.arrays.case import ArrayCase
from softdot.case import Case
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from
from softdot.verify.problem import Problem

SHARE, TIME_S = 0.8, 0.2
"""Share of the modulus that relaxes, and its relaxation time."""
RISE_S, HOLD_S = 1e-6, 0.4
"""Times of the waveform: rise to the full depth, and hold."""


def relaxed_share() -> float:
    """Force of a Maxwell block at fixed depth, at the end of a hold over that at its beginning.

    All parts are one foam with one series, so that the field stays and all stresses fade alike.
    """
    foam = {"model": "hyperfoam", "mu_MPa": [0.2], "alpha": [2.0], "poisson_ratio": [0.25]}
    parts = ("effector", "medium1", "medium2", "film")
    creep = {"relative_moduli": [SHARE], "relaxation_times_s": [TIME_S]}
    case = Case(
        segment={
            "section": "plane-strain",
            "boundary": "free",
            "effector": {"shape": "layer", "height_mm": 0.5, "material": "foam"},
            "medium1": {"material": "foam"},
            "medium2": {"material": "foam"},
            "film": {"material": "soft"},
        },
        materials={
            "foam": foam,
            "soft": {"model": "piezoelectric-film", "youngs_modulus_MPa": 2.0, "poisson_ratio": 0.29},
        },
        dot={"shape": "plate"},
        press={"indentation_mm": 0.05, "load_steps": 2, "waveform": {"rise_s": RISE_S, "hold_s": HOLD_S}},
        mesh={"mesher": "layered", "element_size_mm": 0.9, "contact_element_size_mm": 0.45},
        mechanisms=[{"name": "viscoelasticity", "component": part, "parameters": creep} for part in parts],
    )
    trace = case.solve().trace
    peak = np.argmin(np.abs(trace.time_s - RISE_S))
    return float(trace.reaction_force_N[-1] / trace.reaction_force_N[peak])


def _two_islands(tables: dict[str, Any]) -> ArrayCase:
    """Two segments as islands, with nothing but the rigid base in common."""
    stated = {
        "segment": {"length_mm": 2.3, "width_mm": 2.3, "boundary": "free"},
        "array": {"columns": 2, "rows": 1, "shared": [], "pitch_mm": 2.5},
        "press": {"indentation_mm": 0.2, "load_steps": 2},
        "mesh": {"element_size_mm": 0.6, "contact_element_size_mm": 0.2},
        **tables,
    }
    return ArrayCase(config_from(with_default_design(stated)))


@cache
def force_alone() -> float:
    """Force, N, of one segment of that size, by the mesher and pipeline of a lone one."""
    case = Case(
        segment={"length_mm": 2.3, "width_mm": 2.3, "boundary": "free"},
        press={"indentation_mm": 0.2, "load_steps": 2},
        mesh={"mesher": "layered", "element_size_mm": 0.6, "contact_element_size_mm": 0.2},
    )
    return float(case.solve().trace.reaction_force_N[-1])


def force_of_two() -> float:
    """Force, N, of a cell of two dots on two segments that share nothing."""
    pair = _two_islands({"dot": {"cell": "⠉", "standard": "marburg-medium"}})
    return float(pair.press_by_cell().solve().trace.reaction_force_N[-1])


PROBLEMS = (
    Problem(
        name="maxwell-block",
        title="Block of foam at fixed depth, force after twice its relaxation time over that at once",
        source="1 - g (1 - exp(-t/τ)), g = 0.8 (Ferry, Viscoelastic Properties of Polymers, 1980, ch. 3)",
        unit="1",
        bound_percent=0.01,
        basis="exact for a strain that stays; the rise takes 5e-6 of the relaxation time",
        reference=lambda: 1.0 - SHARE * -float(np.expm1(-HOLD_S / TIME_S)),
        solve=relaxed_share,
    ),
    Problem(
        name="array-of-two",
        title="Two segments that share nothing, pressed by two dots at once, force",
        source="superposition: twice the force of a lone segment, from the mesher and pipeline of one",
        unit="N",
        bound_percent=1.0,
        basis="two meshers, whose meshes may each be 0.5 % from the limit at this size",
        reference=lambda: 2.0 * force_alone(),
        solve=force_of_two,
    ),
)
