"""A slim machine without OpenGL: the package that is missing, not a traceback."""

import pytest

from softdot.cli import main
from softdot.system_libraries import name_missing_library
from tests.softdot.complaints import complaints


def test_a_missing_library_names_its_package(tmp_path, stages, capfd):
    def import_of_a_wheel(*_):
        raise ImportError("libGL.so.1: cannot open shared object file: No such file or directory")

    stages.parts = import_of_a_wheel
    assert main(["run", "-o", str(tmp_path / "out")]) == 2
    assert complaints(capfd.readouterr().err) == (
        "softdot: system library libGL.so.1 is missing: install libgl1 "
        "(on Debian or Ubuntu 'apt-get install -y libgl1 libegl1')\n"
    )
    assert list(tmp_path.iterdir()) == []


def test_another_import_error_is_left_alone():
    with pytest.raises(ModuleNotFoundError), name_missing_library():
        raise ModuleNotFoundError("No module named 'build123d'")
