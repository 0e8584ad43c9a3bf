"""A few modules of a library are loaded without the rest, and whoever asks for the rest has it."""

import gc
import subprocess
import sys

import pytest

from foundation.library_loading import load_alone, without_garbage_collection
from softdot.second_process import CAD_MODULES

CODE = """
import sys
from foundation.library_loading import load_alone
load_alone("build123d", *{parts})
from build123d import Color, Compound, Mesher, Plane, Pos, Rot, Solid, export_step
print("sklearn" in sys.modules, round((Pos(1, 0, 0) * Solid.make_box(1, 2, 3)).volume, 9))
import build123d
before = build123d.Solid
print(hasattr(build123d, "__wrapped__"), build123d.Box.__name__, build123d.Solid is before, "sklearn" in sys.modules)
"""


@pytest.mark.process
def test_build123d_is_loaded_in_part_and_as_a_whole_when_more_is_asked_for():
    done = subprocess.run(
        [sys.executable, "-c", CODE.format(parts=CAD_MODULES)], capture_output=True, encoding="utf-8", check=True
    )
    assert done.stdout.split() == ["False", "6.0", "False", "Box", "True", "True"]


def test_what_is_loaded_already_or_does_not_exist():
    load_alone("sys", "nothing")
    with pytest.raises(ModuleNotFoundError, match="no_such_library"):
        load_alone("no_such_library")


def test_the_collector_is_as_it_was():
    with without_garbage_collection():
        assert not gc.isenabled()
        with without_garbage_collection():
            pass
        assert not gc.isenabled()
    assert gc.isenabled()
