"""softdot: design, simulate and fabricate a soft piezoelectric tactile sensor segment over a Braille dot.

    from softdot import Case
    Case.load("mine.toml").press().plot()

Public names load on first use, so that importing the package costs nothing.
"""

import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import geometry  # noqa: F401 - sets the thread pools before NumPy is loaded

if TYPE_CHECKING:
    from geometry.base import InputError
    from mesh.types import MeshingError
    from softdot.case import Case, ConvergenceWarning, Pressed, ResultWarning
    from softdot.commands.run import run_config
    from softdot.config import Config, config_hash, config_schema, load_config
    from softdot.outcome import derivatives
    from softdot.scripting import Verdict, diagnose, sweep

    __version__: str

__all__ = [
    "Case",
    "Config",
    "ConvergenceWarning",
    "InputError",
    "MeshingError",
    "Pressed",
    "ResultWarning",
    "Verdict",
    "__version__",
    "config_hash",
    "config_schema",
    "derivatives",
    "diagnose",
    "load_config",
    "run_config",
    "sweep",
]
_HOMES = {
    "Case": "softdot.case",
    "Config": "softdot.config",
    "ConvergenceWarning": "softdot.case",
    "InputError": "geometry.base",
    "MeshingError": "mesh.types",
    "Pressed": "softdot.case",
    "ResultWarning": "softdot.case",
    "Verdict": "softdot.scripting",
    "config_hash": "softdot.config",
    "config_schema": "softdot.config",
    "derivatives": "softdot.outcome",
    "diagnose": "softdot.scripting",
    "load_config": "softdot.config",
    "run_config": "softdot.commands.run",
    "sweep": "softdot.scripting",
}
_BESIDE = Path(__file__).resolve().parents[1]
_PACKAGES = ("geometry", "mesh", "solve", "export", "diagnose")


def _refuse_foreign_packages() -> None:
    """ImportError in one sentence for a module of another program that hides one of ours; a command exits with 2."""
    for name in _PACKAGES:
        known = sys.modules.get(name)
        spec = getattr(known, "__spec__", None) if known is not None else find_spec(name)
        place = Path(spec.origin).resolve() if spec is not None and spec.origin else None
        if place is not None and place.parent == _BESIDE / name:
            continue
        where = place or getattr(known, "__file__", None) or "missing"
        said = (
            f"the package '{name}' of softdot is hidden by '{where}', which is earlier on Python's path; rename that "
            "file or folder, or start Python elsewhere"
        )
        if Path(sys.argv[0]).stem == "softdot":
            print(f"softdot: {said}", file=sys.stderr)
            sys.exit(2)
        raise ImportError(said)


_refuse_foreign_packages()


def __getattr__(name: str) -> Any:
    """Import a public name from its home."""
    if name == "__version__":
        from softdot.console import installed_version

        return installed_version()
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'softdot' has no attribute '{name}'")
