"""All tabs of the browser, and what they share."""

import asyncio
from contextlib import suppress
from typing import Any

from foundation.errors import InputError
from softdot.studio.autosave import new_name
from softdot.studio.following import Studio
from softdot.studio.guard import Guard
from softdot.studio.session import Session

MOST_TABS = 12
FIRST_FORM_S, FIRST_PARTS_S = 0.3, 1.3
"""After which the tab that waits has its form, and its parts can be drawn."""
GRACE_S = 20.0
"""A tab that is loaded again is back within that time, on a busy machine too; after it its processes end."""


class Tabs:
    """All tabs, and what they share."""

    def __init__(self, guard: Guard, studio: Studio, start: str) -> None:
        self.guard, self.studio, self.start = guard, studio, start
        self.sessions: dict[str, Session] = {}
        self._leaving: dict[str, asyncio.TimerHandle] = {}
        self._form = asyncio.ensure_future(self._load())

    async def form(self) -> Any:
        """What the form is made of; asked for again where its process was lost. Processes that draw and press load
        after it, so that the browser has the cores until it shows the form.
        """
        if self._form.done() and self._form.exception() is not None:
            self._form = asyncio.ensure_future(self._load())
        found = await asyncio.shield(self._form)
        for wait_s, processes in ((FIRST_FORM_S, self.studio.draw), (FIRST_PARTS_S, self.studio.solve)):
            asyncio.get_running_loop().call_later(wait_s, processes.prepare)
        return found

    async def _load(self) -> Any:
        """What the form is made of."""
        return await self.studio.check.run("form:form")

    def session(self, name: str | None, is_copy: bool) -> Session:
        """The design of a tab that comes back, also after a crash; else a new one. InputError for too many.

        is_copy : the tab was made as a copy of another one, which may still be open.
        """
        known = self.sessions.get(name or "")
        if known is not None and not (is_copy and known.line is not None):
            if known.name in self._leaving:
                self._leaving.pop(known.name).cancel()  # it may leave again, and then has the whole time
            return known
        self._make_room()
        saved = None
        with suppress(InputError):
            saved = self.studio.autosave.load(name) if name else None
        if known is not None:
            made = Session(new_name(), known.text, self.studio)
        elif name and saved is not None:
            made = Session(name, saved, self.studio)
        else:
            made = Session(new_name(), self.start, self.studio)
        self.sessions[made.name] = made
        return made

    def _make_room(self) -> None:
        """The design that was left first makes room for a new one. InputError where all have a tab."""
        if len(self.sessions) < MOST_TABS:
            return
        left = next((one for one in self.sessions.values() if one.line is None), None)
        if left is None:
            raise InputError(f"{MOST_TABS} designs are open, which is the most; close a tab")
        self._forget(left)

    def left(self, session: Session) -> None:
        """A tab is gone: give up its work unless it comes back soon."""
        session.line = None
        self._leaving[session.name] = asyncio.get_running_loop().call_later(GRACE_S, self._forget, session)

    def _forget(self, session: Session) -> None:
        if session.line is None and self.sessions.get(session.name) is session:
            del self.sessions[session.name]
            self._leaving.pop(session.name, None)
            session.close()

    def close(self) -> None:
        """Give up all work."""
        for session in self.sessions.values():
            session.close()
