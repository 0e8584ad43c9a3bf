"""Two hundred inputs that nobody means well: each is refused in one sentence, or is valid after all; nothing hangs."""

import os
import random
import signal
from contextlib import contextmanager

import pytest

from softdot.cli import main
from tests.diagnose.rigs import HEAD, RUN, SEGMENT, csv_text, samples

LIMIT_S, LONGEST = 30, 2_100
pytestmark = pytest.mark.evidence
CONFIG = (
    SEGMENT
    + """
[segment.effector]
shape = "dome"
diameter_mm = 2.0
height_mm = 0.8
[dot]
standard = "ada"
offset_mm = [0.1, -0.1]
[press]
indentation_mm = 0.2
load_steps = 4
[readout]
input_resistance_MOhm = 10.0
[[mechanisms]]
name = "friction"
component = "dot"
parameters = { coefficient = 0.2 }
"""
)
WAVE = "time_s,fraction\n0,0\n0.5,0.4\n1,1\n2,1\n3,0\n"
WAVE_CONFIG = SEGMENT + "[press.waveform]\nshape = 'file'\nfile = '{}'\n"
SWEEP = CONFIG + "[sweep]\n[[sweep.axes]]\nkey = 'press.indentation_mm'\nvalues = [0.1, 0.2]\n"
PRESS = csv_text(samples())
RIG = HEAD + SEGMENT + RUN
NASTY = [
    "nan", "-inf", "1e300", "1e-320", "-0.0", "1_000", "0x10", "1e", "true", "'1.0'", "[]", "{}", "1979-05-27", "''",
    '"""' + "x" * 5_000 + '"""', "[" * 3_000, "9" * 400, "\u202e1", "\0", "1.0, 2.0", "[[1.0]]", "-1.1e-16", "\ufeff1",
]  # fmt: skip


class ReachedError(Exception):
    """The input was valid: work would begin now."""


@contextmanager
def in_time():
    """TimeoutError after LIMIT_S."""

    def stop(*_):
        raise TimeoutError(f"more than {LIMIT_S} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(LIMIT_S)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


@pytest.fixture
def attempt(monkeypatch, tmp_path, capfd):
    """Runs a command up to the point where work would begin; checks what it says. Returns whether it was refused."""

    def reached(*_args, **_kwargs):
        raise ReachedError

    from softdot import run_folder
    from softdot.commands import sweep
    from softdot.diagnosis import folder as diagnosis
    from softdot.plate import folder as plate

    monkeypatch.setattr(run_folder, "staged_folder", reached)
    monkeypatch.setattr(diagnosis, "engine_for", reached)
    monkeypatch.setattr(sweep, "run_sweep", reached)
    monkeypatch.setattr(plate, "staged_folder", reached)
    monkeypatch.chdir(tmp_path)

    def attempted(*arguments):
        before = sorted(tmp_path.rglob("*"))
        capfd.readouterr()
        try:
            with in_time():
                status = main([*arguments, "-o", "out"])
        except ReachedError:
            status = None
        except SystemExit as error:
            status = error.code
        printed = capfd.readouterr()
        assert status in (None, 2), (arguments, status, printed.err[-500:])
        assert sorted(tmp_path.rglob("*")) == before
        assert "Traceback" not in printed.err
        assert printed.out == ""
        if status == 2:
            said = [line for line in printed.err.splitlines() if not line.startswith("softdot: warning: ")]
            assert len(said) == 1, printed.err[-800:]
            assert said[0].startswith("softdot")
            assert len(said[0]) < LONGEST
        return status == 2

    return attempted


def mutated(text: str, rng: random.Random) -> bytes:
    """A valid file with one thing done to it that an editor, a script or an enemy does."""
    lines, raw = text.splitlines(), text.encode()
    at, line = rng.randrange(len(raw)), rng.randrange(len(lines))
    match rng.randrange(10):
        case 0:
            return raw[:at] + bytes([rng.randrange(256)]) + raw[at + 1 :]
        case 1:
            return raw[:at]
        case 2:
            lines.insert(line, lines[line])
        case 3:
            del lines[line]
        case 4:
            return text.replace("\n", "\r").encode()
        case 5:
            return b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode()
        case 6:
            return raw[:at] + "é\u202e\u0000\U0001f600".encode()[: rng.randrange(1, 9)] + raw[at:]
        case 7:
            return raw[:at] + b"x" * 200_000 + raw[at:]
        case _:
            cells = lines[line].replace("=", ",").split(",")
            old = rng.choice(cells)
            lines[line] = lines[line].replace(old, " " + rng.choice(NASTY) if old.strip() else "nan", 1)
    return "\n".join(lines).encode("utf-8", "surrogatepass")


def refused(attempt, file, text, count, seed, *command) -> int:
    """How many mutations of a file are refused; some leave a valid input."""
    rng, many = random.Random(seed), 0
    for _ in range(count):
        file.write_bytes(mutated(text, rng))
        many += attempt(*command)
    return many


def test_configurations(attempt, tmp_path):
    assert refused(attempt, tmp_path / "mine.toml", CONFIG, 80, 1, "run", "mine.toml") > 30


def test_waveforms(attempt, tmp_path):
    (tmp_path / "mine.toml").write_text(WAVE_CONFIG.format("wave.csv"), "utf-8")
    assert refused(attempt, tmp_path / "wave.csv", WAVE, 40, 2, "run", "mine.toml") > 15


@pytest.mark.parametrize("name", ["rig.toml", "press.csv"])
def test_recordings(attempt, tmp_path, name):
    folder, texts = tmp_path / "recording", {"rig.toml": RIG, "press.csv": PRESS}
    folder.mkdir()
    for file, text in texts.items():
        (folder / file).write_text(text, "utf-8")
    assert refused(attempt, folder / name, texts[name], 20, 3, "diagnose", "recording") > 5


def test_sweeps(attempt, tmp_path):
    assert refused(attempt, tmp_path / "space.toml", SWEEP, 25, 4, "sweep", "space.toml") > 8


COMMANDS = [
    ["plate", "a", "--standard", "ada", "--height-mm", value] for value in ("nan", "inf", "-1", "1e300", "0", "x")
] + [
    ["plate", "a", "--standard", "ada", "--thickness-mm", "nan"],
    ["plate", "a", "--standard", "ada", "--margin-mm", "-inf"],
    ["plate", "a", "--standard", "ada", "--width-cells", "0"],
    ["plate", "a", "--standard", "nowhere"],
    ["plate", "a\0b", "--standard", "ada"],
    ["plate", "", "--standard", "ada"],
    ["plate", "--standard", "ada", "--kind", "height-series", "--heights-mm", "nan,1"],
    ["plate", "--standard", "ada", "--kind", "height-series", "--heights-mm", ",,"],
    ["prove", "--cases", "0"],
    ["prove", "--cases", "-5"],
    ["prove", "--cases", "3", "--seed", "-1"],
    ["prove", "--cases", "3", "--kinds", "x"],
    ["run", "none.toml"],
    ["run", "x" * 300],
    ["run", "/".join(["x"] * 5_000)],
    ["run", "a\0b"],
    ["run", "\udcff"],
    ["run", "."],
    ["run", "pipe"],
    ["run", "endless"],
    ["run", "loop"],
    ["run", "--set", "nonsense"],
    ["run", "--set", "press.indentation_mm=nan"],
    ["run", "--set", "=1"],
    ["run", "--set", "a" * 10_000 + "=1"],
    ["diagnose", "pipe"],
    ["diagnose", "none"],
    ["diagnose", "."],
    ["sweep", "pipe"],
    ["sweep", "endless"],
    ["kit", "endless"],
]


def place_traps(folder):
    """A pipe, a device without end and a link to itself."""
    os.mkfifo(folder / "pipe")
    (folder / "endless").symlink_to("/dev/zero")
    (folder / "loop").symlink_to("loop")


@pytest.mark.parametrize("arguments", COMMANDS, ids=range(len(COMMANDS)))
def test_commands(arguments, attempt, tmp_path):
    place_traps(tmp_path)
    assert attempt(*arguments)


@pytest.mark.parametrize("name", ["pipe", "endless", "loop", "x" * 300, "."])
def test_traps_as_waveforms_and_runs(name, attempt, tmp_path):
    place_traps(tmp_path)
    (tmp_path / "mine.toml").write_text(WAVE_CONFIG.format(name), "utf-8")
    assert attempt("run", "mine.toml")
    (tmp_path / "recording").mkdir()
    place_traps(tmp_path / "recording")
    (tmp_path / "recording" / "rig.toml").write_text(RIG.replace("press.csv", name), "utf-8")
    assert attempt("diagnose", "recording")
