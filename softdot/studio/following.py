"""What goes on by itself: each change of a design is drawn and checked, and pressed as soon as the hand rests."""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from softdot.studio.autosave import Autosave
from softdot.studio.design_facts import Json, Origin, Phase
from softdot.studio.design_state import DesignState
from softdot.studio.processes import InTurn, MachineError, Pool, TaskRefused

PAUSE_S, REST_S = 0.15, 0.2
"""A hand that has changed nothing for so long pauses, and the design is checked; then it rests, and it is pressed."""
LONGEST_LEARNT_S = 0.3
"""For a derivative that is under way where the next press begins, which wants the cores."""
MOST_MOVED = 8
LOADING = {
    "parts": "the process that draws is being loaded on this machine",
    "check": "the process that checks designs is being loaded on this machine",
}


@dataclass(frozen=True)
class Studio:
    """What all tabs share. draw : the parts; check : designs and circuits; solve : presses and long work.

    family : folder of a family by which designs are estimated, None without.
    """

    draw: InTurn
    check: InTurn
    solve: Pool
    autosave: Autosave
    scratch: Path
    family: str | None = None


class Follower:
    """Does what the state of a design wants. changed : called after every fact that it has brought into the state.

    moved : dotted keys that the hand has moved, the last one first.
    """

    def __init__(self, state: DesignState, studio: Studio, changed: Callable[[], None]) -> None:
        self._state, self._studio, self._changed = state, studio, changed
        self._undrawn, self._unchecked, self._unasked = asyncio.Event(), asyncio.Event(), asyncio.Event()
        self._circuit_first = False
        self.moved: list[str] = []
        self._press_task: asyncio.Task[None] | None = None
        self._slopes_task: asyncio.Task[None] | None = None
        follow = (self._draw(), self._check(), self._ask_the_family())
        self._tasks = {asyncio.create_task(one) for one in follow}

    def touch(self, circuit_first: bool = False) -> None:
        """The design has changed; circuit_first : in the amplifier alone, which is answered before the rest."""
        self._circuit_first = circuit_first
        self._undrawn.set()
        self._unchecked.set()
        self._unasked.set()

    def has_moved(self, key: str) -> None:
        """A hand has moved this number."""
        self.moved = [key, *(one for one in self.moved if one != key)][:MOST_MOVED]

    def press_again(self) -> None:
        """Also where the present design is pressed already, or its press was cancelled."""
        self.cancel_press(None)
        self._state.again()
        self.touch()

    def cancel_press(self, phase: Phase | None = "cancelled") -> None:
        """End the press. phase : None where the design is another one, or is pressed anew."""
        if self._state.job is not None:
            self._state.press_ends(self._state.job, phase, "The press was cancelled.")
        if self._press_task is not None:
            self._press_task.cancel()
            self._press_task = None
        self._changed()

    def close(self) -> None:
        """End everything."""
        for task in (*self._tasks, self._slopes_task):
            if task is not None:
                task.cancel()
        self.cancel_press(None)

    async def _draw(self) -> None:
        """The parts, at every change."""
        while True:
            await self._undrawn.wait()
            self._undrawn.clear()
            while self._state.wants_parts:
                origin, view = self._state.present, None
                with suppress(TaskRefused, MachineError):
                    view = await self._quick("parts", "design:draw", origin.text)
                self._state.drawn(origin, view)
                self._changed()

    async def _ask_the_family(self) -> None:
        """What a family says of the design, at every change."""
        while self._studio.family is not None:
            await self._unasked.wait()
            self._unasked.clear()
            while self._state.wants_family:
                text, found = self._state.text, None
                with suppress(TaskRefused, MachineError):
                    found = await self._studio.check.run("goal:answer", self._studio.family, text)
                self._state.answered_by_family(text, found)
                self._changed()

    async def _check(self) -> None:
        """The rest, when the hand pauses; and the press, when it rests."""
        while True:
            await self._unchecked.wait()
            self._unchecked.clear()
            await self._look()

    async def _look(self) -> None:
        state = self._state
        if self._circuit_first:
            await self._answer_circuit()
        if state.wants_check:
            if state.revision and await self._changes_within(PAUSE_S):
                return
            await self._examine(state.present)
        if state.check is not None:
            if state.job is not None and state.job.press_hash != state.present.press_hash:
                self.cancel_press(None)
            await self._answer_circuit()
        if await self._changes_within(REST_S):
            return
        if state.wants_press and state.job is None:
            self._press_task = asyncio.create_task(self._press())

    async def _changes_within(self, seconds: float) -> bool:
        """Whether there is another change in that time."""
        with suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                await self._unchecked.wait()
        return self._unchecked.is_set()

    async def _examine(self, origin: Origin) -> None:
        try:
            self._state.checked(origin.text, await self._quick("check", "design:examine", origin.text))
        except (TaskRefused, MachineError) as error:
            self._state.check_fails(origin, f"The design could not be checked: {error}.")
        self._changed()

    async def _quick(self, of: str, task: str, *arguments: Any) -> Any:
        """A short task. What takes longer than it should for a reason of the machine is said of the machine."""
        process = self._studio.draw if of == "parts" else self._studio.check
        if not process.is_warm:
            self._state.machine_says(of, LOADING[of])
            self._changed()
        try:
            found = await process.run(task, *arguments)
        except MachineError as error:
            self._state.machine_says(of, str(error))
            raise
        except BaseException:
            self._state.machine_says(of, None)
            raise
        self._state.machine_says(of, None)
        return found

    async def _answer_circuit(self) -> None:
        """What the amplifier makes of the charge of the press."""
        state, press = self._state, self._state.shown_press
        if press is None or not state.wants_circuit:
            return
        origin = replace(state.present, press_hash=press.origin.press_hash)
        history = press.found["history"]
        with suppress(TaskRefused, MachineError):  # a mistake, of which its check tells
            found = await self._quick("check", "press:circuit", origin.text, history)
            state.made("circuit", origin, {"history": history, "found": found})
            self._changed()

    async def _press(self) -> None:
        """Coarse, then accurate; each is shown as soon as it is there."""
        state = self._state
        if self._slopes_task is not None:
            self._slopes_task.cancel()
        job = state.press_begins()
        self._changed()
        try:
            await self._press_in_stages(job)
            state.press_ends(job)
        except asyncio.CancelledError:
            state.press_ends(job)
            raise
        except TaskRefused as error:
            state.press_ends(job, "failed", str(error))
        except MachineError as error:
            state.press_ends(job, "failed", f"The press has no answer: {error}. The design is as it was.")
        finally:
            self._changed()
        if state.wants_exponents:
            self._slopes_task = asyncio.create_task(self._learn_exponents(state.present))

    async def _learn_exponents(self, origin: Origin) -> None:
        """From them designs beside a pressed one are estimated while a slider moves."""

        def on_way(told: Json) -> None:
            if "exponents" in told:
                self._state.estimator.add_exponents(origin.press_hash or "", told["exponents"])
                self._changed()

        with suppress(TaskRefused, MachineError):  # where nothing can be estimated, a press tells
            need = self._state.need_GB
            asked = "press", "slopes:exponents", origin.text, self.moved
            await self._studio.solve.run(*asked, need_GB=need, tell=on_way, longest_stop_s=LONGEST_LEARNT_S)

    async def _press_in_stages(self, job: Origin) -> None:
        state = self._state

        def on_way(told: Json) -> None:
            if "press" in told:
                state.pressed(job, told["press"], complete=False)
                answer = asyncio.create_task(self._answer_circuit())
                self._tasks.add(answer)
                answer.add_done_callback(self._tasks.discard)
            else:
                state.press_goes_on(job, told["progress"])
            self._changed()

        tasks, need_GB = list(state.presses_to_do), state.need_GB
        for task in tasks:
            is_last = task == tasks[-1]
            need = need_GB if is_last else 0.0
            found = await self._studio.solve.run("press", task, job.text, need_GB=need, tell=on_way)
            state.pressed(job, found, complete=is_last)
            self._changed()
            await self._answer_circuit()
