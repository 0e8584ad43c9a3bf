"""softdot check: every mistake in one answer, or what a run will cost; nothing is solved."""

import json
import tomllib

import pytest
from hypothesis import HealthCheck, given, settings

from foundation.errors import InputError
from softdot.case import Case
from softdot.checks import cost_of, expected_tetrahedra
from softdot.cli import main
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from
from softdot.config.mistakes import mistakes
from tests.softdot.random_mistakes import invalid_configurations
from tests.softdot.toml_text import toml_text

WRONG = """
[segment]
lenght_mm = 2.0
boundary = "glued"
[segment.medium1]
thickness_mm = -1.0
material = "vnrr"
[segment.effector]
shape = "dome"
[dot]
standard = "adda"
[press]
indentation_mm = 0.2
force_N = 1.0
[[mechanisms]]
name = "fricton"
component = "dot"
parameters = { coefficient = 0.3 }
"""
KEYS = (
    "segment.lenght_mm", "segment.boundary", "segment.medium1.thickness_mm", "segment.medium1.material",
    "segment.effector.diameter_mm", "dot.standard", "press.force_N", "mechanisms[0].name",
)  # fmt: skip


@pytest.fixture
def checked(tmp_path, capfd):
    def check(text, *more):
        path = tmp_path / "mine.toml"
        path.write_text(text, "utf-8")
        status = main(["check", str(path), *more])
        said = capfd.readouterr()
        return status, said.out, said.err

    return check


def test_every_mistake_is_told_once_and_nothing_else(checked):
    status, out, err = checked(WRONG)
    assert (status, out) == (2, "")
    told = [line.removeprefix("softdot: ") for line in err.splitlines()]
    assert sorted(sentence.split(" ")[0] for sentence in told) == sorted(KEYS)


def test_each_mistake_alone_is_the_sentence_of_a_run(checked, tmp_path, capfd):
    _, _, err = checked("[press]\nindentation_mm = 9.0\n")
    assert main(["run", str(tmp_path / "mine.toml"), "-o", str(tmp_path / "out")]) == 2
    assert capfd.readouterr().err == err


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(invalid_configurations())
def test_a_random_mistake_is_among_those_told(example):
    """Whatever else is set aside to look on: the sentence of a run comes first, and looking on ends."""
    _, _, tables = example
    tables = tomllib.loads(toml_text(tables))
    with pytest.raises(InputError) as alone:
        _check(tables)
    found, checked = mistakes(tables, _check)
    assert (found[0], checked) == (str(alone.value), None)
    assert len(found) == len(set(found)) < 10


def _check(tables):
    return Case(config_from(with_default_design(tables))).checked_design


def test_a_good_file_is_told_its_mesh_time_and_memory(checked, monkeypatch):
    monkeypatch.setattr(Case, "mesh", property(lambda _: pytest.fail("something was meshed")))
    status, out, err = checked('[dot]\nstandard = "ada"')
    assert (status, err) == (0, "")
    assert "tetrahedra" in out
    assert "on two cores" in out
    summary = json.loads(checked('[dot]\nstandard = "ada"', "--json")[1])
    assert summary["mistakes"] == []
    assert set(summary["expected"]) == {"tetrahedra", "unknowns", "time_s", "first_run_s", "memory_GB"}
    assert "segment.film.thickness_um" in summary["from_default"]


def test_the_expected_size_of_the_default_is_that_of_its_mesh():
    """The default design has 15,400 tetrahedra and 68,000 unknowns, whatever the mesher's scatter."""
    case = Case()
    whole = expected_tetrahedra(case.model.segment, case.dot, case.config.mesh)
    cost = cost_of(whole, case.config)
    assert 15_400 / 2 < cost.tetrahedra < 15_400 * 2
    assert 68_000 / 2 < cost.unknowns < 68_000 * 2


def test_a_finer_mesh_costs_more(checked):
    def expected(size):
        return json.loads(checked("", "--json", "--set", f"mesh.contact_element_size_mm={size}")[1])["expected"]

    coarse, fine = expected(0.15), expected(0.07)
    assert all(fine[key] > coarse[key] for key in ("tetrahedra", "unknowns", "time_s", "memory_GB"))


LISTED = [("materials", "sylgard-184"), ("standards", "ada"), ("mechanisms", "friction"), ("amplifiers", "LMP7721")]


@pytest.mark.parametrize(("what", "known"), LISTED)
def test_what_is_built_in_is_listed_with_its_source(what, known, capfd):
    assert main(["list", what, "--json"]) == 0
    entries = {entry["name"]: entry for entry in json.loads(capfd.readouterr().out)[what]}
    assert all(entry["source"] for entry in entries.values())
    assert main(["list", what]) == 0
    assert f"{known}  {entries[known]['is']}\n" in capfd.readouterr().out


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_completion_knows_commands_and_options(shell, capfd):
    with pytest.raises(SystemExit) as end:
        main(["--print-completion", shell])
    assert end.value.code == 0
    script = capfd.readouterr().out
    assert all(word in script for word in ("diagnose", "--hold-out", "--template", "mechanisms"))


def test_an_element_of_a_pair_that_is_wrong_is_told_once(checked):
    path = "[segment]\nsection = 'plane-strain'\n[dot]\nshape = 'ridge'\noffset_mm = [0.0, 0.5]\n"
    assert str(checked(path)).count("offset_mm[") == 1


def test_a_waveform_that_never_reaches_its_end_is_told(checked, tmp_path):
    """As one whose fractions are millimetres."""
    for largest in (0.2, 1.0):
        (tmp_path / "way.csv").write_text(f"time_s,fraction\n0,0\n1,{largest}\n", "utf-8")
        text = f"[press.waveform]\nshape = 'file'\nfile = '{tmp_path / 'way.csv'}'\n"
        assert ("the largest fraction is 0.2" in str(checked(text))) == (largest < 1.0)
