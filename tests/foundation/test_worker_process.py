"""A process beside this one answers in order, raises what a call raised, and ends with its block."""

import os
import time

import pytest

from foundation.errors import InputError
from foundation.worker_process import ProcessDiedError, WorkerProcess


def refused(text):
    raise InputError(text)


def dies():
    if os.environ.get("SOFTDOT_TEST_BESIDE"):
        os._exit(1)
    return os.getpid()


def exists(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_calls_are_done_in_order_in_another_process():
    with WorkerProcess() as ask:
        other, second = ask(os.getpid), ask(len, [1, 2])
        assert other.result() != os.getpid()
        assert second.result() == 2
        assert exists(other.result())
    assert not exists(other.result())


def test_what_a_call_raises_is_raised_here():
    with WorkerProcess() as ask:
        with pytest.raises(InputError, match="no such dot"):
            ask(refused, "no such dot").result()
        assert ask(len, "abc").result() == 3


def test_what_a_process_that_dies_leaves_undone_is_done_here():
    with WorkerProcess({"SOFTDOT_TEST_BESIDE": "1"}) as ask:
        assert ask(dies).result() == os.getpid()


def test_a_block_that_is_left_waits_for_nothing():
    start = time.perf_counter()
    with WorkerProcess() as ask:
        slow, never = ask(time.sleep, 60.0), ask(len, "abc")
    assert time.perf_counter() - start < 20.0
    assert slow.done()
    assert never.cancelled() or never.result() is None


def test_an_inner_block_may_end_it():
    with WorkerProcess() as ask:
        with ask:
            other = ask(os.getpid).result()
        assert not exists(other)


def tells(count, tell):
    for number in range(count):
        tell(number)
    return "done"


def test_what_a_call_tells_on_its_way_is_heard_in_order_and_one_that_is_killed_is_told():
    heard = []
    with WorkerProcess() as process:
        assert process.begin(tells, 3, tell=heard.append).result() == "done"
        assert heard == [0, 1, 2]
        assert process.is_alive
        slow = process.begin(time.sleep, 60.0)
        process.kill()
        with pytest.raises(ProcessDiedError):
            slow.result(timeout=20.0)
        assert not process.is_alive
