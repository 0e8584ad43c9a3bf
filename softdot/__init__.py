"""softdot: design, simulate and fabricate a soft piezoelectric tactile sensor segment over a Braille dot.

Public names load on first use, so that importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from geometry.base import InputError
    from mesh.types import MeshingError
    from softdot.commands.new import config_schema
    from softdot.commands.run import run_config
    from softdot.config import Config, config_hash, load_config
    from softdot.differentiate import derivatives

    __version__: str

__all__ = [
    "Config",
    "InputError",
    "MeshingError",
    "__version__",
    "config_hash",
    "config_schema",
    "derivatives",
    "load_config",
    "run_config",
]
_HOMES = {
    "Config": "softdot.config",
    "InputError": "geometry.base",
    "MeshingError": "mesh.types",
    "config_hash": "softdot.config",
    "config_schema": "softdot.commands.new",
    "derivatives": "softdot.differentiate",
    "load_config": "softdot.config",
    "run_config": "softdot.commands.run",
}


def __getattr__(name: str) -> Any:
    """Import a public name from its home."""
    if name == "__version__":
        from softdot.numbers import installed_version

        return installed_version()
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'softdot' has no attribute '{name}'")
