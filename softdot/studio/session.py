"""One tab of the browser and its design: what the tab asks for and what it is told."""

import asyncio
import secrets
import shutil
import time
from collections.abc import Awaitable, Callable
from functools import partial
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from softdot.studio.design_facts import Json, Origin
from softdot.studio.design_state import DesignState
from softdot.studio.document import dotted_key
from softdot.studio.following import Follower, Studio
from softdot.studio.goal import DesignGoal, design_goal
from softdot.studio.kept_designs import KeptDesigns
from softdot.studio.large_messages import large_messages
from softdot.studio.processes import MachineError, TaskRefused
from softdot.studio.response import AskedResponse, asked_response, drawn_values, response

ON_DESIGN = {"influences": "influences:influences", "tolerances": "influences:tolerances_of_making"}
INTO_FOLDER = {"kit": "files:kit", "report": "files:report"}
"""Long work that a tab may start: on the design alone, and into a folder."""
QUICK = {"influences", "recording"}
"""Those that take seconds, and so do not queue behind those that take minutes."""
OF_CHECKED = {"response", "goal"}
"""Those that ask a design for its numbers, so that it is checked first."""
MADE_BY = {"diagnosis": "verdict"}
"""Artefacts that are not called as the task that makes them."""
Tell = Callable[[Json], None]
Work = Callable[..., Awaitable[Json]]
Then = Callable[[Json, Origin], Origin | None]


class Session:
    """A design and its work. line : sends to its tab, None while there is none."""

    def __init__(self, name: str, text: str, studio: Studio) -> None:
        self.name, self._studio = name, studio
        self.line: Callable[[Json], None] | None = None
        self.files: dict[str, Path] = {}
        self.state = DesignState(text)
        self._follower = Follower(self.state, studio, self.changed)
        self._sent: dict[str, Any] = {}
        self._serial, self._heard, self._is_due = 0, 0, False
        self._kept = KeptDesigns()
        self._recording: Path | None = None
        self._improved: str | None = None
        self._asked: Json | None = None
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._folder = studio.scratch / name
        self._folder.mkdir(mode=0o700, exist_ok=True)
        self.state.saved = studio.autosave.save(name, text)
        self._follower.touch()

    @property
    def text(self) -> str:
        """Of the design."""
        return self.state.text

    def attach(self, line: Callable[[Json], None]) -> None:
        """A tab is there: tell it everything. One that was there before is told that it is not any more."""
        if self.line is not None:
            self.line({"tell": "elsewhere"})
        self.line, self._sent = line, {}
        line({"tell": "earlier", "designs": self._studio.autosave.earlier(without={self.name})})
        self._tell_all()

    def changed(self) -> None:
        """Tell the tab, once for all that changes in the same moment."""
        if not self._is_due:
            self._is_due = True
            asyncio.get_running_loop().call_soon(self._tell_all)

    def _tell_all(self) -> None:
        """What is new of the artefacts, then the whole state."""
        self._is_due = False
        if self._asked is not None and not self.state.wants_check:
            asked, self._asked = self._asked, None
            self.receive(asked)
        if self.line is None:
            return
        self._kept.renew(self.state)
        for name, (version, message) in {**large_messages(self.state), "kept": self._kept.message()}.items():
            if self._sent.get(name) != version:
                self._sent[name] = version
                self.line({"tell": name, **message()})
        self._serial += 1
        numbers = {"serial": self._serial, "heard": self._heard}
        self.line({"tell": "state", **numbers, **self.state.told(), "kept": self._kept.names()})

    def say(self, text: str, bad: bool = True) -> None:
        """A sentence that answers what was asked, and is no part of the state."""
        if self.line is not None:
            self.line({"tell": "said", "text": text, "bad": bad})

    def close(self) -> None:
        """Give up all work; the design stays on disk."""
        self._follower.close()
        for task in self._tasks.values():
            task.cancel()
        shutil.rmtree(self._folder, ignore_errors=True)

    def receive(self, message: Any) -> None:
        """What a tab asks for. One sentence goes back for what is refused."""
        try:
            action = getattr(self, f"do_{message.pop('do')}", None)
            number = message.pop("n", None)
            if type(number) is int:
                self._heard = number
            if action is None:
                raise TypeError
            action(**message)
        except InputError as error:
            self.say(str(error))
        except (AttributeError, IndexError, KeyError, TypeError, ValueError):
            self.say("the page asked for something that cannot be; reload it")
        self.changed()

    # What a tab may ask for: {"do": NAME, ...} calls do_NAME.

    def do_set(self, key: list[str | int], value: Any, joined: bool = False) -> None:
        """One value of the design; None takes its key out. joined : it goes on with the last change."""
        if not 0 < len(key) <= 8 or any(type(part) not in (str, int) for part in key):
            raise InputError("there is no such key")
        self.state.document.set(key, value, joined)
        self._follower.has_moved(dotted_key(key))
        self._edited(circuit_alone=key[0] == "readout")

    def do_change(self, changes: list[list[Any]]) -> None:
        """Several values as one change."""
        for number, (key, value) in enumerate(changes):
            self.state.document.set(key, value, joined=number > 0)
        self._edited()

    def do_text(self, text: str) -> None:
        """The whole text, as written in the page or imported."""
        if "\0" in text:
            raise InputError("a design must be text without NUL characters")
        self.state.document.write(text)
        self._edited()

    def do_undo(self) -> None:
        """One change back."""
        self.state.document.undo()
        self._edited()

    def do_redo(self) -> None:
        """One change forward."""
        self.state.document.redo()
        self._edited()

    def do_reset(self) -> None:
        """To the design with which the tab began."""
        self.do_text(self.state.document.start)

    def do_restore(self, name: str) -> None:
        """A design that was saved before."""
        text = self._studio.autosave.load(name)
        if text is None:
            raise InputError("this saved design is gone")
        self.do_text(text)

    def do_keep(self, name: str) -> None:
        """Keep the present design for the comparison."""
        self._kept.keep(self.state, str(name))

    def do_rename(self, number: int, name: str) -> None:
        """Call a kept design otherwise."""
        self._kept.rename(number, str(name))

    def do_hide(self, number: int, hidden: bool) -> None:
        """Draw a kept design, or do not; it stays in the list."""
        self._kept.hide(number, bool(hidden))

    def do_drop(self, number: int) -> None:
        """Take a design out of the comparison."""
        self._kept.drop(number)

    def do_take(self, number: int) -> None:
        """Go on with a design of the comparison."""
        self.do_text(self._kept.text(number))

    def do_press(self) -> None:
        """Press the present design again, or where its press was cancelled."""
        self._follower.press_again()

    def do_cancel(self, task: str) -> None:
        """End the press or a task."""
        if task == "press":
            self._follower.cancel_press()
        else:
            self._tasks[task].cancel()

    def do_start(self, task: str, **asked: Any) -> None:
        """Long work: influences, tolerances, kit, report, plate, response, goal or diagnosis, with what it needs."""
        if task in OF_CHECKED and self.state.wants_check:
            self._asked = {"do": "start", "task": task, **asked}
        elif task in ON_DESIGN:
            self._begin(task, ON_DESIGN[task], self.text)
        elif task in INTO_FOLDER:
            self._begin(task, INTO_FOLDER[task], self.text, self._new_folder(task))
        elif task == "plate":
            self._begin(task, "files:plate", asked, self._new_folder(task))
        elif task == "response":
            self._follow_number(asked_response(self._single_segment(), *map(asked.get, ("key", "low", "high"))))
        elif task == "goal":
            self._seek(design_goal(self._single_segment(), asked))
        elif task == "diagnosis":
            if self._recording is None:
                raise InputError("there is no recording yet: drop its folder or a zip file of it")
            place = self._new_folder(task)
            asked_for = str(self._recording), place, bool(asked.get("quick"))
            self._begin(task, "recording:diagnose", *asked_for, then=self._keep_improved)
        else:
            raise InputError("there is no such task")

    def do_improve(self) -> None:
        """Take over what a diagnosis found as the design."""
        if self._improved is None:
            raise InputError("there is no diagnosis with an improved design yet")
        self.do_text(self._improved)

    async def upload(self, unpack: Callable[[Path], Awaitable[Path]]) -> None:
        """A recording: unpack writes it into an empty folder and returns where its rig.toml is. InputError.

        The recording before is gone, also where this one is refused, of which nothing is left on disk.
        """
        for task in ("recording", "diagnosis"):
            if task in self._tasks:
                self._tasks[task].cancel()
        self._recording, self._improved = None, None
        self.state.dropped("recording", "diagnosis", "verdict")
        self.changed()
        folder = Path(self._new_folder("recording"))
        try:
            place = await unpack(folder)
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        self._begin("recording", "recording:read", str(place), then=partial(self._keep_recording, place))

    # What follows from it.

    def _edited(self, circuit_alone: bool = False) -> None:
        """The design may be another one."""
        if self.state.is_edited:
            self.state.edited(circuit_alone)
            self.state.saved = self._studio.autosave.save(self.name, self.text)
            self._follower.touch(circuit_alone)

    def _new_folder(self, task: str) -> str:
        folder = self._folder / f"{task}-{secrets.token_hex(4)}"
        folder.mkdir()
        return str(folder)

    def _begin(self, task: str, function: str, *arguments: Any, then: Then | None = None) -> None:
        """A task in a process of its own; what it makes can be downloaded."""
        room, need = ("press", 0.0) if task in QUICK else ("long", self.state.need_GB)
        self._begin_work(task, partial(self._studio.solve.run, room, function, *arguments, need_GB=need), then)

    def _begin_work(self, task: str, work: Work, then: Then | None = None) -> None:
        """work : called with tell. then : takes what it has found before the page is told of it. InputError."""
        if task in self._tasks and not self._tasks[task].done():
            raise InputError("this is under way already; cancel it first")
        self._tasks[task] = asyncio.create_task(self._work(task, work, then))

    async def _work(self, task: str, work: Work, then: Then | None) -> None:
        origin, started = self.state.present, time.monotonic()

        def on_way(told: Json) -> None:
            if "progress" in told:
                self._tell_task(task, origin, "running", progress=told["progress"])
            else:
                self.state.made(MADE_BY.get(task, task), origin, {"result": self._offered(told)})
                self.changed()

        self._tell_task(task, origin, "running", progress={"stage": "start", "done": 0, "count": 0, "left_s": None})
        try:
            found = await work(tell=on_way)
            of = (then(found, origin) if then else None) or origin
            made = {"result": self._offered(found), "took_s": time.monotonic() - started}
            self.state.made(MADE_BY.get(task, task), of, made)
            self._tell_task(task, of, "done", took_s=made["took_s"])
        except asyncio.CancelledError:
            self._tell_task(task, origin, "cancelled", said="cancelled")
            raise
        except (InputError, TaskRefused) as error:
            self._tell_task(task, origin, "failed", said=str(error))
        except MachineError as error:
            self._tell_task(task, origin, "failed", said=f"{error}; the design is as it was")

    def _keep_recording(self, place: Path, *_: Any) -> None:
        self._recording = place

    def _keep_improved(self, found: Json, _: Origin) -> None:
        self._improved = found["improved"] or self._improved

    def _single_segment(self) -> Json:
        """Values of the present design, which is of one segment and without mistakes. InputError."""
        check, values = self.state.check or {}, self.state.present.values
        if values is None or check.get("mistakes"):
            raise InputError("a design with mistakes, or not checked yet, cannot be pressed")
        if "array" in check:
            raise InputError("this is for designs of a single segment")
        return values

    @property
    def _family(self) -> str | None:
        """Folder of the family of which the present design is one."""
        return self._studio.family if self.state.is_of_family else None

    def _follow_number(self, asked: AskedResponse) -> None:
        """Presses at other values of one number, beside what a family says of them."""
        text, family, need = self.text, self._family, self.state.need_GB
        known = self.state.press.point if self.state.press is not None else None

        async def press(other: str, tell: Tell) -> Json:
            found: Json = await self._studio.solve.run("long", "press:full_load", other, need_GB=need, tell=tell)
            return found

        async def work(tell: Tell) -> Json:
            line: Json = {}
            if family is not None:
                drawn = drawn_values((asked.values[0], asked.values[-1]))
                found = await self._studio.check.run("goal:along", family, text, list(asked.key), drawn)
                line = {"line": found, "by": "family"} if found else {}
            points = await response(press, text, asked, known, lambda told: tell({**told, **line}))
            return {**points, **line}

        self._begin_work("response", work)

    def _seek(self, goal: DesignGoal) -> None:
        """Move the numbers of the design to where it meets a goal, by a family where there is one. InputError."""
        text, family = self.text, self._family
        law, press = self.state.estimator.law(text), self.state.press
        if family is None and law is None:
            raise InputError(
                "nothing is known yet of how this design follows its numbers: its accurate press tells, and some "
                "seconds later its derivatives"
            )

        async def work(tell: Tell) -> Json:
            if family is not None:
                asked = "press", "goal:by_family", family, text, goal.as_dict(), press and press.answer
                found: Json = await self._studio.solve.run(*asked, tell=tell)
            else:
                found = await self._studio.check.run("goal:by_law", law, goal.as_dict())
            return {**found, "enough": goal.enough, "target": goal.target, "least": goal.least}

        self._begin_work("goal", work, self._move_to_goal)

    def _move_to_goal(self, found: Json, origin: Origin) -> Origin:
        """The design is moved where the goal is met. TaskRefused where it is another one by now."""
        if self.text != origin.text:
            raise TaskRefused("the design has been changed meanwhile, so that nothing was moved; ask again")
        if found["reached"]:
            self.do_change(found["changes"])
        return self.state.present

    def _tell_task(self, task: str, origin: Origin, how: str, **more: Any) -> None:
        self.state.tasks[task] = {"is": how, "revision": origin.revision, **more}
        self.changed()

    def _offered(self, found: Json) -> Json:
        """The result with addresses instead of paths."""
        offered = {name: self._address(value) if name in ("file", "page") else value for name, value in found.items()}
        if "plots" in found:
            offered["plots"] = {name: self._address(path) for name, path in found["plots"].items()}
        return offered

    def _address(self, path: str) -> str:
        """Of a file that was made here; only such are served."""
        known = {str(place): token for token, place in self.files.items()}
        token = known.get(path, f"{secrets.token_urlsafe(32)}/{Path(path).name}")
        self.files[token] = Path(path)
        return token
