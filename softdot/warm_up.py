"""The kernels compiled in one worker before others start."""

from foundation.executor import Executor
from softdot.config.loading import config_from
from softdot.outcome import outcome, remembered

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


def warm_up(executor: Executor) -> None:
    """Compile the kernels in one worker: several at once could spoil numba's cache of compiled code."""
    config = config_from(TINY)
    if remembered(config) is None:
        executor.submit(outcome, config).exception()
