"""softdot verify: what it writes, how it ends, and that it sees what is wrong."""

import json

import pytest

from benchmarks.broken_verify import BREAKS, broken
from softdot.cli import main
from softdot.verify.catalogue import PROBLEMS
from softdot.verify.other_codes import references
from tests.cases import for_each

KEYS = {"name", "source", "reference", "value", "unit", "deviation_percent", "bound_percent", "passed"}
QUICK = ("patch", "rc-voltage", "film-stretch")


def chosen(names):
    return [word for name in names for word in ("--only", name)]


def test_quick_problems_pass_and_are_told(tmp_path, capfd):
    out = tmp_path / "out"
    assert main(["verify", "-o", str(out), *chosen(QUICK)]) == 0
    told = json.loads((out / "verify.json").read_text("utf-8"))
    assert told["format"] == "softdot-verify/1"
    assert [problem["name"] for problem in told["problems"]] == ["patch", "film-stretch", "rc-voltage"]
    assert all(problem.keys() >= KEYS and problem["passed"] for problem in told["problems"])
    page = (out / "verify.html").read_text("utf-8")
    assert "All 3 problems lie within their bounds" in page
    assert "http" not in page
    said = capfd.readouterr()
    assert [line.split()[0] for line in said.out.splitlines()] == ["problem", "patch", "film-stretch", "rc-voltage"]
    assert "verify 3 of 3: rc-voltage passed" in said.err


def test_a_problem_that_fails_ends_with_3_and_its_name(tmp_path, capfd):
    with BREAKS["rc-voltage"]():
        assert main(["verify", "-o", str(tmp_path / "out"), "--json", "--only", "rc-voltage"]) == 3
    said = capfd.readouterr()
    assert json.loads(said.out)["passed"] is False
    assert "1 of 1 problems failed: rc-voltage" in said.err


def test_a_problem_without_a_solution_fails():
    """An element that is turned inside out is no answer."""

    def stopped():
        raise ArithmeticError("no equilibrium")

    outcome = PROBLEMS["patch"].__class__("n", "t", "s", "1", 1.0, "b", lambda: 1.0, stopped).outcome()
    assert not outcome["passed"]
    assert (outcome["value"], outcome["failure"]) == (None, "no equilibrium")


def test_an_unknown_problem_is_refused_before_any_work(tmp_path, capfd):
    assert main(["verify", "-o", str(tmp_path / "out"), "--only", "hertzz"]) == 2
    assert capfd.readouterr().err == "softdot: --only hertzz: no such problem; did you mean 'hertz'?\n"
    assert not (tmp_path / "out").exists()


def test_every_problem_has_a_break_a_source_and_a_bound():
    assert BREAKS.keys() == PROBLEMS.keys()
    assert len(PROBLEMS) >= 20
    assert all(one.source and one.basis and 0.0 < one.bound_percent <= 5.0 for one in PROBLEMS.values())
    assert all("python -m" in one.command and one.source for one in references().values())


@for_each("name", QUICK)
def test_a_broken_constant_is_seen(name):
    assert not broken(name)["passed"]


@pytest.mark.evidence
@for_each("name", [name for name in PROBLEMS if name not in QUICK])
def test_every_problem_passes_and_sees_its_break(name):
    assert PROBLEMS[name].outcome()["passed"]
    assert not broken(name)["passed"]
