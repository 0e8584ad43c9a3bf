"""Many presses: designs over any keys of the configuration, solved by an executor, gathered in one table."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from softdot.sweeps.folder import read_table
    from softdot.sweeps.points import solve_points
    from softdot.sweeps.run import run_sweep
    from softdot.sweeps.space import Space, load_space, space_from

__all__ = ["Space", "load_space", "read_table", "run_sweep", "solve_points", "space_from"]
# Public names load on first use.
_HOMES = {
    "Space": "softdot.sweeps.space",
    "load_space": "softdot.sweeps.space",
    "read_table": "softdot.sweeps.folder",
    "run_sweep": "softdot.sweeps.run",
    "solve_points": "softdot.sweeps.points",
    "space_from": "softdot.sweeps.space",
}


def __getattr__(name: str) -> Any:
    """Import a public name from its home."""
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'softdot.sweeps' has no attribute '{name}'")
