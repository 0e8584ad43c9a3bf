"""Real recordings, which licences forbid to copy here; SOFTDOT_RECORDINGS names their folder."""

import os
import runpy
from pathlib import Path

import pytest

RECORDINGS = os.environ.get("SOFTDOT_RECORDINGS", "")
EXAMPLES = Path(__file__).parents[2] / "examples" / "recordings"
NEEDED = [pytest.mark.evidence, pytest.mark.skipif(not RECORDINGS, reason="SOFTDOT_RECORDINGS names no folder")]


def converted(data, out):
    """Recordings of one set in a new folder, by its script among the examples."""
    runpy.run_path(str(EXAMPLES / f"{data.replace('-', '_')}.py"))["convert"](Path(RECORDINGS) / data, out)


def control(name):
    """A function of examples/recordings/controls.py."""
    return runpy.run_path(str(EXAMPLES / "controls.py"))[name]


def silent(*_):
    """A report that nobody reads."""
