"""Modules of other programs that hide a package of softdot are refused: Python would load them in its place."""

import sys
from importlib.util import find_spec
from pathlib import Path

PACKAGE_FOLDER = Path(__file__).resolve().parents[1]
PACKAGES = ("foundation", "geometry", "mesh", "solve", "export", "diagnose")


def refuse_foreign_packages() -> None:
    """ImportError in one sentence for a module of another program that hides one of ours; a command exits with 2."""
    for name in PACKAGES:
        known = sys.modules.get(name)
        spec = getattr(known, "__spec__", None) if known is not None else find_spec(name)
        place = Path(spec.origin).resolve() if spec is not None and spec.origin else None
        if place is not None and place.parent == PACKAGE_FOLDER / name:
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
