"""One point: the outcome of its press, or the reason why there is none. This runs in the workers."""

import time
from typing import Any

from geometry.base import InputError
from softdot.config import Config, config_from
from softdot.outcome import outcome

Record = dict[str, Any]

SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST = "solved", "refused", "not-converged", "crashed", "lost"
STATUSES = (SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST)
ACCIDENTS = (CRASHED, LOST)
"""Not the fault of the configuration: tried again when the sweep is started again."""

TINY = {
    "segment": {
        "effector": {"height_mm": 0.5},
        "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 100.0},
        "medium2": {"thickness_mm": 0.5},
    },
    "press": {"indentation_mm": 0.05, "load_steps": 1},
    "mesh": {"mesher": "layered", "element_size_mm": 1.0, "contact_element_size_mm": 1.0},
}


def solve_point(config: Config) -> Record:
    """Outcome of a press with status, reason (None when solved) and seconds. Raises nothing."""
    start = time.perf_counter()
    return {**_attempt(config), "seconds": time.perf_counter() - start}


def _attempt(config: Config) -> Record:
    try:
        found = outcome(config)
    except InputError as error:
        return failed(REFUSED, str(error))
    except Exception as error:
        return failed(CRASHED, f"{type(error).__name__}: {error}")
    if found["solver"]["converged"]:
        return {"status": SOLVED, "reason": None, **found}
    return {**failed(NOT_CONVERGED, found["solver"]["failure"]), **found}


def failed(status: str, reason: str) -> Record:
    """A record without numbers; the reason on one line."""
    return {"status": status, "reason": " ".join(reason.split())}


def warm_up_config() -> Config:
    """A press of seconds that has the kernels compiled by one worker before all of them need them."""
    return config_from(TINY)
