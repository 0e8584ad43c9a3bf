"""The server of the page, from its address to its end."""

import asyncio
import logging
import signal
import socket
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module

from tornado.ioloop import PeriodicCallback
from tornado.netutil import bind_sockets

from foundation.errors import InputError
from foundation.scratch_folders import scratch_folder
from foundation.worker_process import ProcessDiedError
from softdot.studio.admission import Admission, cores
from softdot.studio.autosave import Autosave, folder
from softdot.studio.connections import LONGEST_BODY_S, LONGEST_HEAD_S, BoundedServer
from softdot.studio.following import Studio
from softdot.studio.guard import Guard
from softdot.studio.handlers import application
from softdot.studio.port_key import LONGEST_KEPT_S, PortKey
from softdot.studio.processes import InTurn, Pool
from softdot.studio.tabs import Tabs

LARGEST_HEADER, LARGEST_BODY = 1 << 16, 1 << 16
"""Bytes of what is sent without a key; an upload has a bound of its own."""
LONGEST_LOOK_S = 30.0
"""For a design to be drawn or checked by a process that has loaded; after it another process tries once more."""


async def serve(host: str, port: int, start: str, ready: Callable[[str], None], family: str | None = None) -> None:
    """Serve the page until SIGINT or SIGTERM. ready : called with the address once it answers.

    start : text of the design with which a tab begins. family : folder of a family, None without.
    InputError for an address that cannot be used.
    """
    stop = asyncio.Event()
    keys = PortKey(folder() / "keys")
    sockets = bound_sockets(host, port, keys.last_port())
    own = sockets[0].getsockname()[1]
    guard = Guard.of(host, own, keys.take(own))
    with scratch_folder() as scratch:
        draw, check = (InTurn(warm_up, LONGEST_LOOK_S) for warm_up in ("design:warm_up", "form:warm_up"))
        solve = Pool("press:warm_up", {"press": Admission(cores()), "long": Admission(max(1, cores() - 1))})
        try:
            check.prepare()
            tabs = Tabs(guard, Studio(draw, check, solve, Autosave(folder()), scratch, family), start)
            try:
                server = BoundedServer(
                    application(tabs),
                    max_header_size=LARGEST_HEADER,
                    max_body_size=LARGEST_BODY,
                    idle_connection_timeout=LONGEST_HEAD_S,
                    body_timeout=LONGEST_BODY_S,
                )
                server.add_sockets(sockets)
                PeriodicCallback(lambda: keys.renew(own), 1e3 * LONGEST_KEPT_S / 10).start()
                _stop_by_signals(stop)
                name = f"127.0.0.1:{own}" if len(guard.hosts) > 1 else next(iter(guard.hosts))
                ready(f"http://{name}/?key={guard.key}")
                editing = asyncio.create_task(_load_for_edits(check))
                await stop.wait()
                editing.cancel()
            finally:
                tabs.close()
        finally:
            for processes in (draw, check, solve):
                processes.end()


async def _load_for_edits(check: InTurn) -> None:
    """After the first page has had the cores: else the first edit waits for it, 1.6 s."""
    with suppress(ProcessDiedError, TimeoutError):
        await check.prepare().until_warm()
    await asyncio.to_thread(import_module, "softdot.config.idle")


def bound_sockets(host: str, port: int, last: int) -> list[socket.socket]:
    """Sockets of the server. port : 0 for the one that a studio had last, where it is free, or any. InputError."""
    for number in dict.fromkeys((port or last, port)):
        try:
            return bind_sockets(number, host)
        except (OSError, UnicodeError) as error:
            reason = getattr(error, "strerror", None) or "it is no address of this machine"
    raise InputError(f"--host {host} --port {port}: cannot be used ({reason})")


def _stop_by_signals(stop: asyncio.Event) -> None:
    """Ctrl-C and SIGTERM set the event, where this is the main thread of a system with signals."""
    for number in (signal.SIGINT, signal.SIGTERM):
        with suppress(NotImplementedError, ValueError, RuntimeError):
            asyncio.get_running_loop().add_signal_handler(number, stop.set)


def run(host: str, port: int, start: str, ready: Callable[[str], None], family: str | None = None) -> None:
    """As serve, to its end."""
    for name in ("tornado.general", "tornado.access"):  # one line for each broken request of anybody
        logging.getLogger(name).setLevel(logging.CRITICAL)
    asyncio.run(serve(host, port, start, ready, family))
