"""Tests that draw at random draw the same, whichever tests ran before them."""

import numpy as np
import pytest


@pytest.fixture(autouse=True)
def same_draws(request):
    """A module's RNG starts anew for each of its tests."""
    rng = getattr(request.module, "RNG", None)
    if rng is not None:
        rng.bit_generator.state = np.random.default_rng(1).bit_generator.state
