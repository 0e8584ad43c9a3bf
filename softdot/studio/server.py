"""The server of the page, from its address to its end."""

import asyncio
import signal
from collections.abc import Callable
from contextlib import suppress

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets

from foundation.errors import InputError
from foundation.scratch_folders import scratch_folder
from softdot.studio.admission import Admission, cores
from softdot.studio.autosave import Autosave, folder
from softdot.studio.following import Studio
from softdot.studio.guard import Guard
from softdot.studio.handlers import application
from softdot.studio.processes import InTurn, Pool
from softdot.studio.tabs import Tabs

LARGEST_HEADER, LARGEST_BODY = 1 << 16, 1 << 16
"""Bytes of what is sent without a key; an upload has a bound of its own."""
LONGEST_LOOK_S = 30.0
"""For a design to be drawn or checked by a process that has loaded; after it another process tries once more."""


async def serve(host: str, port: int, start: str, ready: Callable[[str], None]) -> None:
    """Serve the page until SIGINT or SIGTERM. ready : called with the address once it answers.

    start : text of the design with which a tab begins. InputError for an address that cannot be used.
    """
    stop = asyncio.Event()
    try:
        sockets = bind_sockets(port, host)
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no address of this machine"
        raise InputError(f"--host {host} --port {port}: cannot be used ({reason})") from None
    guard = Guard.of(host, sockets[0].getsockname()[1])
    with scratch_folder() as scratch:
        draw, check = (InTurn(warm_up, LONGEST_LOOK_S) for warm_up in ("design:warm_up", "form:warm_up"))
        solve = Pool("press:warm_up", {"press": Admission(cores()), "long": Admission(max(1, cores() - 1))})
        try:
            check.prepare()
            tabs = Tabs(guard, Studio(draw, check, solve, Autosave(folder()), scratch), start)
            try:
                server = HTTPServer(application(tabs), max_header_size=LARGEST_HEADER, max_body_size=LARGEST_BODY)
                server.add_sockets(sockets)
                _stop_by_signals(stop)
                name = f"127.0.0.1:{sockets[0].getsockname()[1]}" if len(guard.hosts) > 1 else next(iter(guard.hosts))
                ready(f"http://{name}/?key={guard.key}")
                await stop.wait()
            finally:
                tabs.close()
        finally:
            for processes in (draw, check, solve):
                processes.end()


def _stop_by_signals(stop: asyncio.Event) -> None:
    """Ctrl-C and SIGTERM set the event, where this is the main thread of a system with signals."""
    for number in (signal.SIGINT, signal.SIGTERM):
        with suppress(NotImplementedError, ValueError, RuntimeError):
            asyncio.get_running_loop().add_signal_handler(number, stop.set)


def run(host: str, port: int, start: str, ready: Callable[[str], None]) -> None:
    """As serve, to its end."""
    asyncio.run(serve(host, port, start, ready))
