"""axe-core for pages in a browser."""

from functools import partialmethod
from pathlib import Path
from typing import Any

import pytest


def axe() -> Any:
    """The checker; skips where it is not installed.

    Its package reads its script in the encoding of the locale, which libraries that draw may have changed.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Path, "read_text", partialmethod(Path.read_text, encoding="utf-8"))
        package = pytest.importorskip("axe_playwright_python.sync_playwright")
    return package.Axe()
