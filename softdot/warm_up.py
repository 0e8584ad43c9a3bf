"""Kernels are compiled in one worker before others start."""

from foundation.cache import data_hash, recall, remember
from foundation.executor import Executor
from foundation.source_hash import source_hash
from softdot.config.loading import config_from
from softdot.prepared_press import PreparedPress

TINY_CONFIG = {
    "segment": {
        "effector": {"height_mm": 0.5},
        "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 100.0},
        "medium2": {"thickness_mm": 0.5},
    },
    "press": {"indentation_mm": 0.05, "load_steps": 1},
    "mesh": {"mesher": "layered", "element_size_mm": 1.0, "contact_element_size_mm": 1.0},
}
"""The smallest press that uses all kernels."""


def warm_up(executor: Executor) -> None:
    """Compile the kernels in one worker: several at once could spoil numba's cache of compiled code."""
    if recall(_done_name()) is None:
        executor.submit(press_tiny).exception()


def press_tiny() -> None:
    """Press the smallest configuration that takes every kernel, and note in the cache that it is done."""
    PreparedPress(config_from(TINY_CONFIG)).solve()
    remember(_done_name(), True)


def _done_name() -> str:
    return f"warm-{data_hash([TINY_CONFIG, source_hash('solve.press')])}"
