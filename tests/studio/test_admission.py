"""The queue in front of heavy work: as many as cores and memory bear, in order; what is cancelled leaves in silence."""

import asyncio
from concurrent.futures import Future
from contextlib import suppress

import pytest

from softdot.studio.admission import Admission
from softdot.studio.processes import TaskRefused, Worker


class Hall:
    """An admission with tasks that run until they are let go. events : what began and ended, in order."""

    def __init__(self, most, free_GB=float("inf")):
        self.free_GB = free_GB
        self.admission = Admission(most, lambda: self.free_GB)
        self.events, self.said, self.tasks, self._gates = [], {}, {}, {}

    async def come(self, name, need_GB=0.0):
        self._gates[name] = asyncio.Event()
        self.tasks[name] = asyncio.create_task(self._work(name, need_GB))
        await settled()

    async def _work(self, name, need_GB):
        async with self.admission.place(need_GB, lambda told: self.said.update({name: told["progress"]})):
            self.events.append(f"{name} begins")
            await self._gates[name].wait()
        self.events.append(f"{name} ends")

    async def go(self, name):
        self._gates[name].set()
        await settled()

    async def cancel(self, name):
        self.tasks[name].cancel()
        await settled()


async def settled():
    for _ in range(10):
        await asyncio.sleep(0)


def in_a_hall(story, *arguments):
    async def told():
        hall = Hall(*arguments)
        await story(hall)
        for task in hall.tasks.values():
            task.cancel()
        await asyncio.gather(*hall.tasks.values(), return_exceptions=True)

    asyncio.run(told())


def test_no_more_run_than_there_are_cores_and_the_others_follow_in_order():
    async def story(hall):
        for name in "abcd":
            await hall.come(name)
        assert hall.events == ["a begins", "b begins"]
        assert hall.said["c"]["stage"] == "waiting"
        assert hall.said["c"]["text"] == "2 other tasks"
        await hall.go("b")
        await hall.go("a")
        assert hall.events == ["a begins", "b begins", "b ends", "c begins", "a ends", "d begins"]

    in_a_hall(story, 2)


def test_a_task_waits_for_memory_and_smaller_ones_do_not_pass_it():
    async def story(hall):
        await hall.come("a", 3.0)
        await hall.come("large", 6.0)
        await hall.come("small", 0.1)
        assert hall.events == ["a begins"]
        assert hall.said["large"]["text"] == "other work on this machine"
        hall.free_GB = 8.0
        await hall.go("a")
        assert hall.events == ["a begins", "a ends", "large begins", "small begins"]

    in_a_hall(story, 4, 4.0)


def test_where_nothing_runs_a_task_begins_whatever_it_needs():
    async def story(hall):
        await hall.come("huge", 500.0)
        await hall.come("next", 500.0)
        assert hall.events == ["huge begins"]
        await hall.go("huge")
        assert hall.events == ["huge begins", "huge ends", "next begins"]

    in_a_hall(story, 2, 1.0)


def test_what_is_cancelled_leaves_its_place_whether_it_waits_or_runs():
    async def story(hall):
        for name in "abcd":
            await hall.come(name)
        await hall.cancel("b")
        await hall.cancel("a")
        assert hall.events == ["a begins", "c begins"]
        await hall.go("c")
        assert hall.events[-1] == "d begins"

    in_a_hall(story, 1)


def test_a_task_that_fails_leaves_its_place_too():
    async def story():
        admission = Admission(1)
        with pytest.raises(TaskRefused):
            async with admission.place(0.0, print):
                raise TaskRefused("no")
        async with asyncio.timeout(1.0), admission.place(0.0, print):
            pass

    asyncio.run(story())


class ByHand(Worker):
    """A process whose task is told by the test."""

    def __init__(self):
        self._task = None

    def begin(self, *_, tell=None):
        self.tell = tell
        return Future()


def test_what_a_cancelled_task_still_sends_is_not_told():
    """Else a page that was told of its end would show it at work for ever."""

    async def story():
        worker, told = ByHand(), []
        task = asyncio.create_task(worker.run("press:accurate_press", tell=told.append))
        await settled()
        worker.tell("step 1")
        await settled()
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task
        worker.tell("step 2")
        await settled()
        assert told == ["step 1"]

    asyncio.run(story())
