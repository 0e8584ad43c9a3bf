"""Many presses: designs over any keys of the configuration, solved by an executor, gathered in one table.

Public names load on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from softdot.commands.sweep import run_sweep
    from softdot.sweeps.points import solve_points
    from softdot.sweeps.space import Space, load_space, space_from
    from softdot.sweeps.table import read_table

__all__ = ["Space", "load_space", "read_table", "run_sweep", "solve_points", "space_from"]
_HOMES = {
    "Space": "softdot.sweeps.space",
    "load_space": "softdot.sweeps.space",
    "read_table": "softdot.sweeps.table",
    "run_sweep": "softdot.commands.sweep",
    "solve_points": "softdot.sweeps.points",
    "space_from": "softdot.sweeps.space",
}


def __getattr__(name: str) -> Any:
    """Import a public name from its home."""
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'softdot.sweeps' has no attribute '{name}'")
