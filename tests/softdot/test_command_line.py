"""The command line itself: quick, and clear about what it does not know."""

import os
import subprocess
import sys

import pytest

import softdot
from softdot.cli import main
from tests.cases import for_each

HEAVY = (
    "build123d",
    "OCP",
    "vtkmodules",
    "pyvista",
    "pydantic",
    "numpy",
    "scipy",
    "pypardiso",
    "numba",
    "matplotlib",
)


@pytest.mark.process
@for_each("command", [[], ["run"], ["schema"], ["check"], ["new"], ["list"], ["kit"]])
def test_help_loads_nothing_heavy(command):
    code = (
        "import sys\n"
        "from softdot.cli import main\n"
        f"try: main({[*command, '--help']})\n"
        "except SystemExit as end: assert end.code == 0\n"
        f"print('LOADED', [name for name in {HEAVY} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True)
    assert done.stdout.startswith("usage: softdot")
    assert done.stdout.splitlines()[-1] == "LOADED []"


def test_help_takes_less_than_half_a_second():
    def once():
        before = sum(os.times()[2:4])  # processor time of children: other programs may be busy
        subprocess.run([sys.executable, "-m", "softdot.cli", "--help"], capture_output=True, check=True)
        return sum(os.times()[2:4]) - before

    assert min(once() for _ in range(3)) < 0.5


@pytest.mark.process
def test_a_configuration_is_written_in_utf8_in_every_locale():
    """TOML knows no other encoding; a cluster's jobs may run in the locale POSIX."""
    ascii_only = {**os.environ, "LC_ALL": "POSIX", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    command = [sys.executable, "-m", "softdot.cli", "new"]
    written = [subprocess.run(command, env=own, capture_output=True, check=True).stdout for own in (ascii_only, None)]
    assert written[0] == written[1]
    assert "³" in written[0].decode("utf-8")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "required: COMMAND"),
        (["run"], "required: -o/--output"),
        (["rum", "-o", "out"], "invalid choice: 'rum'"),
        (["run", "-o"], "expected one argument"),
        (["run", "-o", "out", "--fast"], "unrecognized arguments: --fast"),
    ],
)
def test_wrong_arguments_are_one_sentence(arguments, said, capsys):
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2
    complaint = capsys.readouterr().err
    assert said in complaint
    assert complaint.count("\n") == 1


def test_version_is_the_installed_one(capsys):
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out == f"softdot {softdot.__version__}\n"


@pytest.mark.process
def test_a_reader_that_leaves_early_is_no_error():
    command = f"{sys.executable} -m softdot.cli schema | head -c 10; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, encoding="utf-8", check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_public_names_are_found():
    assert all(hasattr(softdot, name) for name in softdot.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        softdot.nonsense  # noqa: B018
