"""One tab of the browser and its design: what the tab asks for and what it is told."""

import asyncio
import secrets
import shutil
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from foundation.worker_process import ProcessDiedError
from softdot.studio.autosave import Autosave
from softdot.studio.comparison import compared
from softdot.studio.document import Document
from softdot.studio.following import Follower, Json
from softdot.studio.processes import InTurn, Pool, TaskRefused

MOST_KEPT = 4
ON_DESIGN = {"influences": "influences:influences", "tolerances": "influences:tolerances_of_making"}
INTO_FOLDER = {"kit": "files:kit", "report": "files:report"}
"""Long work that a tab may start: on the design alone, and into a folder."""


@dataclass(frozen=True)
class Studio:
    """What all tabs share. draw : the parts; check : designs and circuits; solve : presses and long work."""

    draw: InTurn
    check: InTurn
    solve: Pool
    autosave: Autosave
    scratch: Path


class Session:
    """A design and its work. send : to its tab, None while there is none."""

    def __init__(self, name: str, text: str, studio: Studio) -> None:
        self.name, self._studio = name, studio
        self.send: Callable[[Json], None] | None = None
        self.files: dict[str, Path] = {}
        self._document = Document(text)
        self._follower = Follower(self._document, studio.draw, studio.check, studio.solve, self.tell)
        self._last: dict[str, Json] = {}
        self._kept: list[Json] = []
        self._recording: Path | None = None
        self._improved: str | None = None
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._folder = studio.scratch / name
        self._folder.mkdir(mode=0o700, exist_ok=True)
        self._touch()

    @property
    def text(self) -> str:
        """Of the design."""
        return self._document.text

    def attach(self, send: Callable[[Json], None]) -> None:
        """A tab is there: tell it everything."""
        self.send = send
        self._tell_document()
        for message in list(self._last.values()):
            send(message)
        self._tell_kept()
        send({"tell": "earlier", "designs": self._studio.autosave.earlier(without={self.name})})

    def tell(self, kind: str, again: bool = False, **content: Any) -> None:
        """A message to the tab; again : repeated to a tab that comes back."""
        message = {"tell": kind, **content}
        if kind == "curves":
            self._renew_kept()
        if again:
            self._last[f"{kind} {content.get('task', '')}"] = message
        if self.send is not None:
            self.send(message)

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
            if action is None:
                raise TypeError
            action(**message)
        except InputError as error:
            self.tell("said", text=str(error), bad=True)
        except (AttributeError, IndexError, KeyError, TypeError, ValueError):
            self.tell("said", text="the page asked for something that cannot be; reload it", bad=True)

    # What a tab may ask for: {"do": NAME, ...} calls do_NAME.

    def do_set(self, key: list[str | int], value: Any, joined: bool = False) -> None:
        """One value of the design; None takes its key out. joined : it goes on with the last change."""
        if not 0 < len(key) <= 8 or any(type(part) not in (str, int) for part in key):
            raise InputError("there is no such key")
        self._document.set(key, value, joined)
        self._touch(circuit_first=key[0] == "readout")

    def do_change(self, changes: list[list[Any]]) -> None:
        """Several values as one change."""
        for number, (key, value) in enumerate(changes):
            self._document.set(key, value, joined=number > 0)
        self._touch()

    def do_text(self, text: str) -> None:
        """The whole text, as written in the page or imported."""
        if "\0" in text:
            raise InputError("a design must be text without NUL characters")
        self._document.write(text)
        self._touch()

    def do_undo(self) -> None:
        """One change back."""
        self._document.undo()
        self._touch()

    def do_redo(self) -> None:
        """One change forward."""
        self._document.redo()
        self._touch()

    def do_reset(self) -> None:
        """To the design with which the tab began."""
        self.do_text(self._document.start)

    def do_restore(self, name: str) -> None:
        """A design that was saved before."""
        text = self._studio.autosave.load(name)
        if text is None:
            raise InputError("this saved design is gone")
        self.do_text(text)

    def do_keep(self, name: str) -> None:
        """Keep the present design for the comparison."""
        known = self._follower.known
        if len(self._kept) >= MOST_KEPT:
            raise InputError(f"{MOST_KEPT} designs are compared at most; take one out first")
        if known.state.get("press_hash") is None:
            raise InputError("a design with mistakes cannot be compared")
        words = str(name)[:60].strip() or f"design {len(self._kept) + 1}"
        kept = {"name": words, "text": self.text, "numbers": known.numbers}
        self._kept.append(kept | {key: known.state[key] for key in ("values", "press_hash")})
        self._tell_kept()

    def do_drop(self, number: int) -> None:
        """Take a design out of the comparison."""
        del self._kept[number]
        self._tell_kept()

    def do_take(self, number: int) -> None:
        """Go on with a design of the comparison."""
        self.do_text(self._kept[number]["text"])

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
        """Long work: influences, tolerances, kit, report, plate or diagnosis, with what it needs."""
        if task in ON_DESIGN:
            self._begin(task, ON_DESIGN[task], self.text)
        elif task in INTO_FOLDER:
            self._begin(task, INTO_FOLDER[task], self.text, self._new_folder(task))
        elif task == "plate":
            self._begin(task, "files:plate", asked, self._new_folder(task))
        elif task == "diagnosis":
            if self._recording is None:
                raise InputError("there is no recording yet: drop its folder or a zip file of it")
            place = self._new_folder(task)
            self._begin(task, "recording:diagnose", str(self._recording), place, bool(asked.get("quick")))
        else:
            raise InputError("there is no such task")

    def do_improve(self) -> None:
        """Take over what a diagnosis found as the design."""
        if self._improved is None:
            raise InputError("there is no diagnosis with an improved design yet")
        self.do_text(self._improved)

    async def upload(self, unpack: Callable[[Path], Awaitable[Path]]) -> None:
        """A recording: unpack writes it into an empty folder and returns where its rig.toml is. InputError."""
        self._recording = None  # until it has been read, and so been checked
        place = await unpack(Path(self._new_folder("recording")))
        self._begin("recording", "recording:read", str(place))

    # What follows from it.

    def _touch(self, circuit_first: bool = False) -> None:
        """The design is another one."""
        self._studio.autosave.save(self.name, self.text)
        self._tell_document()
        self._follower.touch(circuit_first)

    def _tell_document(self) -> None:
        document = self._document
        undo, redo, reset = document.can_undo, document.can_redo, document.text != document.start
        self.tell("document", text=document.text, undo=undo, redo=redo, reset=reset)

    def _renew_kept(self) -> None:
        """The accurate press of a design that was kept with its coarse one takes its place."""
        now = self._follower.known.curves[-1]
        same = [one for one in self._kept if one["press_hash"] == now["press_hash"]]
        for one in same:
            one["numbers"] = now["numbers"]
        if same:
            self._tell_kept()

    def _tell_kept(self) -> None:
        self.tell("kept", names=[one["name"] for one in self._kept], rows=compared(self._kept), most=MOST_KEPT)

    def _new_folder(self, task: str) -> str:
        folder = self._folder / f"{task}-{secrets.token_hex(4)}"
        folder.mkdir()
        return str(folder)

    def _begin(self, task: str, function: str, *arguments: Any) -> None:
        if task in self._tasks and not self._tasks[task].done():
            raise InputError("this is under way already; cancel it first")
        self._tasks[task] = asyncio.create_task(self._work(task, function, *arguments))

    async def _work(self, task: str, function: str, *arguments: Any) -> None:
        """A task in a process of its own; what it makes can be downloaded."""

        def on_way(told: Json) -> None:
            if "progress" in told:
                self.tell("progress", task=task, **told["progress"])
            else:
                self.tell("done", again=True, task=task, result=self._offered(told))

        self.tell("progress", task=task, stage="start", done=0, count=0, left_s=None)
        started = time.monotonic()
        try:
            found = await self._studio.solve.run(function, *arguments, tell=on_way)
            if task == "recording":
                self._recording = Path(arguments[0])
            self._improved = found.get("improved") or self._improved
            took = time.monotonic() - started
            self.tell("done", again=True, task=task, result=self._offered(found), took_s=took)
            self.tell("ended", task=task)
        except asyncio.CancelledError:
            self.tell("ended", task=task, said="cancelled")
            raise
        except (TaskRefused, ProcessDiedError) as error:
            lost = isinstance(error, ProcessDiedError)
            said = "its process ended before it was done; the design is as it was" if lost else str(error)
            self.tell("ended", task=task, said=said, bad=True)

    def _offered(self, found: Json) -> Json:
        """The result with addresses instead of paths."""
        offered = {name: self._address(value) if name in ("file", "page") else value for name, value in found.items()}
        if "plots" in found:
            offered["plots"] = {name: self._address(path) for name, path in found["plots"].items()}
        return offered

    def _address(self, path: str) -> str:
        """Of a file that was made here; only such are served."""
        known = {str(place): token for token, place in self.files.items()}
        token = known.get(path, f"{secrets.token_urlsafe(16)}/{Path(path).name}")
        self.files[token] = Path(path)
        return token
