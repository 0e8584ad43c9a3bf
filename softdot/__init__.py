"""softdot: design, simulate and fabricate a soft piezoelectric tactile sensor segment over a Braille dot.
softdot.Case.load("mine.toml").press().plot()
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

import foundation  # noqa: F401 - sets the thread pools before NumPy is loaded
from softdot.foreign_packages import refuse_foreign_packages
from softdot.public_names import HOMES

if TYPE_CHECKING:
    from foundation.errors import InputError
    from mesh.types import MeshingError
    from softdot.case import Case
    from softdot.config.hashes import config_hash
    from softdot.config.loading import load_config
    from softdot.config.schema import Config, config_schema
    from softdot.families.folder import load_family
    from softdot.pressed import ConvergenceWarning, Pressed, ResultWarning
    from softdot.scripting import Verdict, derivatives, diagnose, run_config, sweep

    __version__: str

__all__ = [
    "Case", "Config", "ConvergenceWarning", "InputError", "MeshingError", "Pressed", "ResultWarning", "Verdict",
    "__version__", "config_hash", "config_schema", "derivatives", "diagnose", "load_config", "load_family",
    "run_config", "sweep",
]  # fmt: skip
refuse_foreign_packages()


def __getattr__(name: str) -> Any:
    """Import a public name from its home, on first use."""
    if name == "__version__":
        return import_module("softdot.version").installed_version()
    if name in HOMES:
        return getattr(import_module(HOMES[name]), name)
    raise AttributeError(f"module 'softdot' has no attribute '{name}'")
