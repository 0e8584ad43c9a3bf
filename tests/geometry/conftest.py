"""Segments of the paper's final design, changed where a test asks for it."""

from collections.abc import Callable
from typing import Any

import pytest

from geometry.parameters import Effector, Film, Medium, Segment


@pytest.fixture
def make_segment() -> Callable[..., Segment]:
    """Effector 1.0, medium 1 0.5, film 0.028, medium 2 2.0 mm: a stack of 3.528 mm. effector=None: none."""

    def make(**changes: Any) -> Segment:
        tables: dict[str, Any] = {
            "medium1": Medium(thickness_mm=0.5),
            "film": Film(thickness_um=28.0),
            "medium2": Medium(thickness_mm=2.0),
            "effector": Effector(),
        }
        return Segment(**{**tables, **changes})

    return make


@pytest.fixture
def segment(make_segment: Callable[..., Segment]) -> Segment:
    return make_segment()
