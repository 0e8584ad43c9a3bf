import sys
from pathlib import Path

import pytest

from geometry.dot import DotShape
from mesh.types import TetMesh
from solve.result import PressResult

sys.path.insert(0, str(Path(__file__).parent))
from pressed_box import box_dot, box_mesh, made_up_press


@pytest.fixture(scope="session")
def segment() -> TetMesh:
    return box_mesh()


@pytest.fixture(scope="session")
def press(segment: TetMesh) -> PressResult:
    return made_up_press(segment)


@pytest.fixture(scope="session")
def dot() -> DotShape:
    return box_dot()
