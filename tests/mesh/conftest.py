from collections.abc import Iterator

import pytest
from mesh_samples import SAMPLES, built

from mesh.types import TetMesh


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOFTDOT_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


LONGEST = "cylinder solid pytetwild"
PARAMS = [pytest.param(name, marks=pytest.mark.press) if name == LONGEST else name for name in sorted(SAMPLES)]


@pytest.fixture(params=PARAMS)
def sample(request: pytest.FixtureRequest) -> tuple[str, TetMesh]:
    """Every sample segment, meshed once by each mesher that can."""
    return request.param, built(request.param)
