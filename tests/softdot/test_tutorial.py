"""What the tutorial prints works as printed: its files load, its commands exist, its diagnosis finds what it says."""

import re
import shlex
from pathlib import Path

import pytest

from softdot.cli import main
from softdot.config.loading import config_from
from softdot.config.toml import parse_toml

TEXT = (Path(__file__).parents[2] / "docs" / "tutorial.md").read_text("utf-8")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", TEXT, re.DOTALL | re.MULTILINE)


def test_its_configurations_load():
    first, mine = blocks("toml")
    more = re.search(r"^```\n(waveform.*?)^```$", TEXT, re.DOTALL | re.MULTILINE)[1]
    for text in (first, mine, mine + more):
        config_from(parse_toml(text, "tutorial"))
    assert config_from(parse_toml(mine + more, "tutorial")).mechanisms[0].name == "viscoelasticity"


def test_its_commands_exist(capsys):
    commands = [shlex.split(line) for text in blocks("sh") for line in text.splitlines() if line.startswith("softdot ")]
    assert [command[1] for command in commands] == ["--version", "run", "run", "run", "kit", "diagnose"]
    for _, command, *arguments in commands[1:]:
        with pytest.raises(SystemExit) as ended:
            main([command, "--help"])
        assert ended.value.code == 0
        assert "-o" in arguments
    capsys.readouterr()


@pytest.mark.press
def test_its_diagnosis_finds_the_stiffening(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (script,) = blocks("python")
    exec(compile(script, "strip.py", "exec"), {})
    assert main(["diagnose", "coupon", "-o", "diagnosis", "--json"]) == 0
    told = capsys.readouterr().out
    (named,) = re.findall(r"Left out: the specimen stiffens at large strain; force ratio ([\d.]+)", TEXT)
    assert "the specimen stiffens at large strain; force ratio" in told
    found = float(re.search(r"force ratio ([\d.]+) \(90 % interval", told)[1])
    assert found == pytest.approx(float(named), abs=0.02)
