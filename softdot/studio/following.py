"""What goes on by itself: each change of a design is drawn and checked, and pressed as soon as the hand rests."""

import asyncio
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from foundation.worker_process import ProcessDiedError
from softdot.studio.comparison import differences
from softdot.studio.document import Document
from softdot.studio.processes import InTurn, Pool, TaskRefused

PAUSE_S, REST_S = 0.15, 0.2
"""A hand that has changed nothing for so long pauses, and the design is checked; then it rests, and it is pressed."""
MOST_CURVES = 6
Json = dict[str, Any]
TellTab = Callable[..., None]
"""The kind of a message, whether it is repeated to a tab that comes back (again), and its content."""


@dataclass
class Known:
    """What is known of a design. state : of its last check (softdot.studio.work.design.examine).

    curves : presses, the last one last: label, quality, numbers, values of the configuration, hash of what is pressed.
    history : of the last press, for circuits. pressed : hash of what it depends on.
    """

    state: Json = field(default_factory=dict)
    curves: list[Json] = field(default_factory=list)
    history: bytes | None = None
    pressed: str | None = None

    @property
    def numbers(self) -> Json | None:
        """Of the press of the present design, None where there is none yet."""
        last = self.curves[-1] if self.curves else {"press_hash": None}
        there = last["press_hash"] is not None and last["press_hash"] == self.state.get("press_hash")
        return last["numbers"] if there else None

    @property
    def is_pressed(self) -> bool:
        """Whether the last press, or the one under way, is of the present design."""
        return self.pressed is not None and self.pressed == self.state.get("press_hash")


class Follower:
    """Follows one document. draw, check : processes for what is quick, solve : for presses."""

    def __init__(self, document: Document, draw: InTurn, check: InTurn, solve: Pool, tell: TellTab) -> None:
        self.known = Known()
        self._document, self._tell = document, tell
        self._draw_process, self._check_process, self._solve_pool = draw, check, solve
        self._undrawn, self._unchecked, self._circuit_first = asyncio.Event(), asyncio.Event(), False
        self._press_task: asyncio.Task[None] | None = None
        self._tasks = [asyncio.create_task(self._draw()), asyncio.create_task(self._check())]

    def touch(self, circuit_first: bool = False) -> None:
        """The document has changed; circuit_first : in the amplifier alone, which is answered before the rest."""
        self._circuit_first = circuit_first
        if not circuit_first:
            self._undrawn.set()
        self._unchecked.set()

    def press_again(self) -> None:
        """Also where the present design is pressed already, or its press was cancelled."""
        self.cancel_press()
        self.known.pressed = None
        self._unchecked.set()

    def cancel_press(self) -> None:
        """End the press; the next change begins another one."""
        if self._press_task is not None:
            self._press_task.cancel()

    def close(self) -> None:
        """End everything."""
        for task in self._tasks:
            task.cancel()
        self.cancel_press()

    async def _draw(self) -> None:
        """The parts, at every change."""
        while True:
            await self._undrawn.wait()
            self._undrawn.clear()
            with suppress(TaskRefused, ProcessDiedError, TimeoutError):
                parts = await self._quick(self._draw_process, "design:draw", self._document.text)
                if parts is not None:
                    self._tell("parts", again=True, view=parts)

    async def _check(self) -> None:
        """The rest, when the hand pauses; and the press, when it rests."""
        while True:
            await self._unchecked.wait()
            self._unchecked.clear()
            with suppress(TaskRefused, ProcessDiedError, TimeoutError):
                await self._look(self._document.text)

    async def _look(self, text: str) -> None:
        known = self.known
        if self._circuit_first:
            await self._answer_circuit(text)
        if known.state and await self._changes_within(PAUSE_S):
            return
        known.state = await self._quick(self._check_process, "design:examine", text)
        self._tell("state", again=True, **known.state)
        if not known.is_pressed:
            self.cancel_press()
        elif not self._circuit_first:
            await self._answer_circuit(text)
        if await self._changes_within(REST_S):
            return
        if known.state.get("press_hash") is not None and not known.is_pressed:
            known.pressed = known.state["press_hash"]
            self._press_task = asyncio.create_task(self._press(text, known.state))

    async def _changes_within(self, seconds: float) -> bool:
        """Whether there is another change in that time."""
        with suppress(TimeoutError):
            await asyncio.wait_for(self._unchecked.wait(), seconds)
        return self._unchecked.is_set()

    async def _quick(self, process: InTurn, task: str, *arguments: Any) -> Any:
        """A short task; the tab is told where it or its process fails."""
        try:
            return await process.run(task, *arguments)
        except TimeoutError:
            self._tell("said", text="this design takes too long to check: its numbers are absurd", bad=True)
            raise
        except ProcessDiedError:
            self._tell("said", text="the process that checks designs ended and was started again", bad=True)
            raise
        except TaskRefused as refused:
            self._tell("said", text=str(refused), bad=True)
            raise

    async def _answer_circuit(self, text: str) -> None:
        known = self.known
        if known.history is None:
            return
        try:
            found = await self._check_process.run("press:circuit", text, known.history)
        except TaskRefused:  # the design has a mistake, of which its check tells
            return
        known.curves[-1]["numbers"]["readout_voltage_V"] = found and found["readout_voltage_V"]
        self._tell("circuit", again=True, found=found)

    async def _press(self, text: str, state: Json) -> None:
        """Coarse, then accurate; each is shown as soon as it is there."""
        values = state["values"]
        curve = {"label": self._label(values), "values": values, "press_hash": state["press_hash"]}

        def on_way(told: Json) -> None:
            if "press" in told:
                self._show(told["press"], curve)
            else:
                self._tell("progress", task="press", **told["progress"])

        try:
            for task in state["presses"]:
                found = await self._solve_pool.run(task, text, tell=on_way)
                if "array" in found:
                    self._show_array(found, curve["press_hash"])
                    continue
                self._show(found, curve)
                with suppress(ProcessDiedError, TimeoutError):
                    await self._answer_circuit(self._document.text)
            self._tell("ended", task="press")
        except asyncio.CancelledError:
            self._tell("ended", task="press", said="cancelled")
            raise
        except (TaskRefused, ProcessDiedError) as error:  # not again by itself
            lost = isinstance(error, ProcessDiedError)
            said = "the process of the press ended; the design is as it was" if lost else str(error)
            self._tell("ended", task="press", said=said, bad=True)

    def _label(self, values: Mapping[str, Any]) -> str:
        """What distinguishes a press from the one before."""
        if not self.known.curves:
            return "first design"
        changed = differences(self.known.curves[-1]["values"], values)
        words = [f"{key.removeprefix('segment.')} = {value}" for key, value in changed.items()]
        return ", ".join(words[:2]) + (f" and {len(words) - 2} more" if len(words) > 2 else "") or "the same again"

    def _show(self, found: Json, curve: Json) -> None:
        """Numbers and fields of a press: the accurate one takes the place of the coarse one."""
        known = self.known
        if known.curves and known.curves[-1]["press_hash"] == curve["press_hash"]:
            curve = known.curves.pop()
        curve = {**curve, "quality": found["quality"], "numbers": found["numbers"]}
        known.curves = [*known.curves[1 - MOST_CURVES :], curve]
        known.history = found["history"]
        shown = [{name: one[name] for name in ("label", "quality", "numbers", "press_hash")} for one in known.curves]
        self._tell("curves", again=True, curves=shown)
        if found["view"] is not None:
            self._tell("pressed", again=True, view=found["view"])

    def _show_array(self, found: Json, press_hash: str) -> None:
        """The press of an array, which has no curves among those of single segments."""
        self._tell("array", again=True, pressed={**found["array"], "press_hash": press_hash})
        if found["view"] is not None:
            self._tell("pressed", again=True, view=found["view"])
