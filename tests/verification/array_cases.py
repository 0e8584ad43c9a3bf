"""Coarse arrays for verification: the paper's final design on segments of 2.3 mm at the pitch of 2.5 mm."""

from softdot.arrays.case import ArrayCase
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from
from solve.press import press_segment

COARSE = {"element_size_mm": 0.9, "contact_element_size_mm": 0.3}


def array(columns=2, rows=1, segment=None, press=None, mesh=None, tables=None, **keys) -> ArrayCase:
    """keys : of the table [array]."""
    stated = {
        "segment": {"length_mm": 2.3, "width_mm": 2.3, "boundary": "free", **(segment or {})},
        "array": {"columns": columns, "rows": rows, **keys},
        "press": {"indentation_mm": 0.2, "load_steps": 2, **(press or {})},
        "mesh": {**COARSE, **(mesh or {})},
        **(tables or {}),
    }
    return ArrayCase(config_from(with_default_design(stated)))


def solved(press, mesh=None):
    """The result of a press of an array, on another mesh where one is given; AssertionError without convergence."""
    result = press_segment(press.model, press.solved_mesh if mesh is None else mesh, dot=press.dot)
    assert result.converged, result.failure
    return result
