"""Calls in processes of this computer: their answers, their errors, their deaths and their end."""

import os
import signal
from concurrent.futures import CancelledError
from time import monotonic, sleep

import psutil
import pytest

from foundation.errors import InputError
from foundation.executor import HERE, LocalProcesses, LostError, completed_calls


def square(number):
    return number**2


def refuse(number):
    raise InputError(f"number = {number}: must be even")


class Picky(Exception):
    """An error that cannot be made again from its sentence alone."""

    def __init__(self, reason, place):
        super().__init__(reason)
        self.place = place


def pick(_):
    raise Picky("not this one", 3)


def die(path):
    """The first process that is asked dies, the second one answers."""
    if not path.exists():
        path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return os.getpid()


def die_always():
    os.kill(os.getpid(), signal.SIGKILL)


def rest():
    sleep(60.0)


def alive():
    """Numbers of the processes that do calls."""
    return {child.pid for child in psutil.Process().children() if "foundation.worker_process" in child.cmdline()}


@pytest.fixture(scope="module")
def processes():
    with LocalProcesses(2) as executor:
        yield executor
    assert not alive()


@pytest.fixture(params=["here", "processes"])
def executor(request):
    return HERE if request.param == "here" else request.getfixturevalue("processes")


def test_every_call_is_answered_under_its_name(executor):
    calls = {f"of {number}": (number,) for number in range(5)}
    found = {name: future.result() for name, future in completed_calls(executor, square, calls)}
    assert found == {f"of {number}": number**2 for number in range(5)}


def test_an_error_is_the_error_of_the_call_alone(executor):
    with pytest.raises(InputError, match="number = 3: must be even"):
        executor.submit(refuse, 3).result()
    assert executor.submit(square, 3).result() == 9


def test_an_error_that_cannot_be_sent_keeps_its_sentence(processes):
    with pytest.raises(RuntimeError, match="Picky: not this one"):
        processes.submit(pick, 0).result()


def test_an_argument_that_cannot_be_sent_costs_that_call_alone(processes):
    with pytest.raises(Exception, match="pickle"):
        processes.submit(square, lambda: 1).result()
    assert processes.submit(square, 4).result() == 16


def test_a_call_whose_process_dies_is_done_by_another_one(processes, tmp_path):
    assert processes.submit(die, tmp_path / "died").result() in alive()


def test_a_call_whose_process_dies_each_time_is_lost_and_no_other(processes):
    calls = {"deadly": (die_always,), **{str(number): (square, number) for number in range(4)}}
    found = dict(completed_calls(processes, called, calls))
    with pytest.raises(LostError, match="its worker died each time"):
        found.pop("deadly").result()
    assert {name: future.result() for name, future in found.items()} == {str(n): n**2 for n in range(4)}


def called(function, *arguments):
    return function(*arguments)


def test_processes_start_with_the_first_call_and_are_kept():
    before = alive()
    with LocalProcesses(2) as executor:
        assert alive() == before
        executor.submit(square, 2).result()
        first = alive()
        assert len(first) == len(before) + 1
        executor.submit(square, 3).result()
        assert alive() == first


def interrupted():
    """As by Ctrl-C: one call is under way, one waits for it."""
    before = alive()
    with LocalProcesses(1) as executor:
        INTERRUPTED[:] = executor.submit(rest), executor.submit(rest)
        while alive() == before:
            sleep(0.01)
        raise KeyboardInterrupt


INTERRUPTED = []


def test_what_is_under_way_ends_at_once_where_the_work_is_stopped():
    begun, before = monotonic(), alive()
    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert monotonic() - begun < 10.0
    assert alive() == before
    under_way, waiting = INTERRUPTED
    assert isinstance(under_way.exception(), LostError)
    with pytest.raises(CancelledError):
        waiting.result()


def test_what_all_need_is_prepared_in_one_process_first():
    asked = []
    with LocalProcesses(2, lambda executor: asked.append(executor.submit(square, 5).result())) as executor:
        assert executor.submit(square, 6).result() == 36
    assert asked == [25]
