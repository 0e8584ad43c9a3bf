"""Whatever a user writes ends in a converged result that mechanics confirms, or in one sentence; never otherwise.

Hypothesis draws configurations in blocks, each with its own seed, because within a block it varies what it drew.
"""

import re
import signal
from contextlib import contextmanager
from unittest.mock import patch

import pytest
from hypothesis import HealthCheck, Phase, given, note, seed, settings

from foundation.errors import InputError
from softdot import run_config
from softdot.case import Case
from softdot.config.loading import load_config
from tests.softdot.press_checks import solved, wrong
from tests.softdot.random_configurations import ROUND, valid_configurations
from tests.softdot.random_mistakes import invalid_configurations
from tests.softdot.toml_text import toml_text

BLOCK = 10
LIMIT_S, LIMIT_OF_ROUND_S = 60.0, 300.0  # of processor time
LONGEST_SENTENCE = 600  # one that lists all known names
STOPPED = re.compile(r"step \d+ of \d+.*(stopped at|has no equilibrium).*: ")


class Hang(BaseException):
    """Longer than allowed; nothing that catches errors catches this."""


@contextmanager
def no_longer_than(seconds):
    """Hang when the block takes more processor time."""

    def stop(*_):
        raise Hang(f"more than {seconds:g} s of processor time")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def one_sentence(said):
    return "\n" not in said and 10 < len(said) < LONGEST_SENTENCE


def drawn(strategy, start, check, count=BLOCK):
    """Check so many examples of a strategy; a failing one is shown as TOML."""

    @seed(start)
    @settings(
        max_examples=count, deadline=None, database=None, phases=[Phase.generate],
        suppress_health_check=list(HealthCheck), print_blob=False,
    )  # fmt: skip
    @given(strategy)
    def run(example):
        check(example)

    run()


def outcome(tables, limit_s=LIMIT_S):
    """'converged', 'stopped' or 'refused'. AssertionError for anything wrong."""
    note(toml_text(tables))
    refusal = ""
    try:
        with no_longer_than(limit_s):
            pressed = solved(tables)
    except InputError as error:
        refusal = str(error)
    if refusal:
        assert one_sentence(refusal)
        return "refused"
    if not pressed.result.converged:
        assert STOPPED.match(pressed.result.failure)
        assert one_sentence(pressed.result.failure)
        return "stopped"
    assert wrong(pressed) == []
    return "converged"


def outcomes(block):
    seen = []
    drawn(valid_configurations(), block, lambda tables: seen.append(outcome(tables)))
    return seen


def refused(tmp_path):
    """A check that a configuration with a mistake is refused before any work, in one sentence with the key."""

    def check(example):
        before, mistake, tables = example
        note(f"{mistake}:\n{toml_text(tables)}")
        path = tmp_path / "segment.toml"
        path.write_text(toml_text(tables), "utf-8")
        said = refusal_of(path, tmp_path / "out")
        assert one_sentence(said)
        assert names_a_key(said, before, tables), said
        assert "Input should" not in said
        assert "Value error" not in said
        assert [one.name for one in tmp_path.iterdir()] == ["segment.toml"]

    return check


def refusal_of(path, out):
    """What a run says before it builds anything."""
    with no_longer_than(LIMIT_S), patch.object(Case, "parts", property(_accepted)), pytest.raises(InputError) as error:
        run_config(load_config(path), out)
    return str(error.value)


def _accepted(*_):
    raise AssertionError("a configuration with a mistake was accepted")


def names_a_key(said, *configurations):
    """Whether a sentence names a key of the configurations, or the one that is missing there."""
    keys = {key for tables in configurations for key in all_keys(tables)}
    return any(re.search(rf"\b{re.escape(key)}\b", said) for key in keys | {"feedback_pF", "diameter_mm"})


def all_keys(tables):
    for key, value in tables.items() if isinstance(tables, dict) else enumerate(tables):
        if isinstance(key, str):
            yield key
        if isinstance(value, dict | list):
            yield from all_keys(value)


@pytest.mark.press
def test_a_random_configuration_converges_to_a_right_result_or_is_refused():
    assert "converged" in outcomes(0)


def test_a_random_mistake_is_refused_in_one_sentence(tmp_path):
    drawn(invalid_configurations(), 0, refused(tmp_path), count=20)


@pytest.mark.evidence
def test_two_hundred_random_configurations_converge_to_right_results_or_are_refused():
    seen = [one for block in range(1, 21) for one in outcomes(block)]
    assert len(seen) >= 200
    assert seen.count("converged") >= 0.9 * len(seen)  # else the random numbers, or the solver, are bad


@pytest.mark.evidence
def test_random_cylinders_and_domes_converge_to_right_results_or_are_refused():
    seen = []
    drawn(valid_configurations(ROUND), 1, lambda tables: seen.append(outcome(tables, LIMIT_OF_ROUND_S)), count=6)
    assert seen.count("converged") >= 4


@pytest.mark.evidence
@pytest.mark.parametrize("block", range(1, 26))
def test_more_random_mistakes_are_refused_in_one_sentence(block, tmp_path):
    drawn(invalid_configurations(), block, refused(tmp_path))
