"""What each address of the page answers: page, scripts, files, uploads and the socket of a tab."""

import asyncio
import json
import re
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from typing import Any

from tornado.http1connection import HTTP1Connection
from tornado.web import Application, HTTPError, RequestHandler, stream_request_body
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from foundation.errors import InputError
from softdot.studio.connections import TRUSTED
from softdot.studio.frames import packed
from softdot.studio.guard import FRAME_POLICY, HEADERS, PAPER_POLICY
from softdot.studio.processes import MachineError, TaskRefused
from softdot.studio.session import Session
from softdot.studio.tabs import Tabs
from softdot.studio.uploads import LARGEST_MB, split, unpack

PAGE = files("softdot.studio").joinpath("page")
TEXTS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
KINDS = {ending: f"{kind}; charset=utf-8" for ending, kind in TEXTS.items()} | {".png": "image/png"}
FOLDERS = PAGE, PAGE.joinpath("scripts"), PAGE.joinpath("vendor")
ASSETS = {one.name: one for folder in FOLDERS for one in folder.iterdir() if one.name.endswith((".css", ".js", ".svg"))}
FRAME = """<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}</title>
<link rel="stylesheet" href="/assets/frame.css">
<iframe sandbox="allow-scripts" src="{address}" title="{title}"></iframe>
"""
LARGEST_MESSAGE = 1 << 20
NONCE = re.compile(r"[\w-]{20,100}")


class Guarded(RequestHandler):
    """Refuses what the guard refuses, and answers errors with one sentence."""

    tabs: Tabs
    needs_key, needs_origin = True, False

    def initialize(self, tabs: Tabs) -> None:
        """Called by the library for each request."""
        self.tabs = tabs

    def set_default_headers(self) -> None:
        """On every answer, also of refusals."""
        for name, value in HEADERS.items():
            self.set_header(name, value)

    def prepare(self) -> None:
        """Before anything of the request is used."""
        key = self.get_query_argument("key", "") if self.needs_key else None
        if key == "" and self.get_query_argument("question", ""):
            key = self._proven_key()
        refused = self.tabs.guard.refusal(self.request.headers, key, self.needs_origin)
        if refused is not None:
            raise HTTPError(403, reason="Forbidden", log_message=refused)
        if self.needs_key:
            TRUSTED.add(getattr(self.request.connection, "stream", self))

    def _proven_key(self) -> str:
        """The key, where a tab that comes back has shown that it holds it."""
        guard = self.tabs.guard
        given = self.get_query_argument("question", ""), self.get_query_argument("proof", "")
        return guard.key if guard.answered(*given) else ""

    def write_error(self, status_code: int, **kwargs: Any) -> None:
        """One sentence, no traceback."""
        error = kwargs.get("exc_info", (None, None))[1]
        said = error.log_message if isinstance(error, HTTPError) else None
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        kinds = {404: "there is nothing at this address", 500: "this failed inside softdot: please report it"}
        self.finish(said or kinds.get(status_code, "this request was refused"))

    def log_exception(self, *_: Any) -> None:
        """Nothing: the address of a request holds the key."""

    def send_file(self, content: bytes, name: str) -> None:
        """An answer whose kind follows from the ending of its name; others are downloads."""
        kind = KINDS.get(Path(name).suffix)
        self.set_header("Content-Type", kind or "application/octet-stream")
        if kind is None:
            self.set_header("Content-Disposition", f'attachment; filename="{name}"')
        self.finish(content)


class PageHandler(Guarded):
    """The page itself, which needs the key of this start."""

    def get(self) -> None:
        """index.html."""
        self.send_file(PAGE.joinpath("index.html").read_bytes(), "index.html")


class GreetingHandler(Guarded):
    """Shows a tab that comes back that this is the studio it knows. It tells nothing to others."""

    needs_key = False

    def get(self) -> None:
        """Proof and question."""
        nonce = self.get_query_argument("nonce", "")
        if not NONCE.fullmatch(nonce):
            raise HTTPError(400)
        self.set_header("Content-Type", "application/json")
        self.finish(json.dumps(self.tabs.guard.greeting(nonce)))


class AssetHandler(Guarded):
    """Scripts and styles of the page: the same for everybody, so that they need no key."""

    needs_key = False

    def get(self, name: str) -> None:
        """One of those that are known."""
        place = ASSETS.get(name)
        if place is None:
            raise HTTPError(404)
        self.send_file(place.read_bytes(), name)


class FileHandler(Guarded):
    """What a task has made, under a random address that only its tab was told, and that is no key to anything else."""

    def prepare(self) -> None:
        """Whoever does not know an address needs the key to be told that there is nothing."""
        self.needs_key = not any(self.path_args[0] in one.files for one in self.tabs.sessions.values())
        super().prepare()

    def path(self, token: str) -> Path:
        """The file of an address. HTTPError 404."""
        path = next((found for one in self.tabs.sessions.values() if (found := one.files.get(token))), None)
        if path is None or not path.is_file():
            raise HTTPError(404)
        return path

    async def get(self, token: str) -> None:
        """A download, a picture, or a report, which may do nothing but show itself in a frame of the studio."""
        path = self.path(token)
        if path.suffix == ".html":
            self.set_header("Content-Security-Policy", PAPER_POLICY)
            self.set_header("X-Frame-Options", "SAMEORIGIN")
        try:
            content = await asyncio.to_thread(path.read_bytes)
        except OSError:
            raise HTTPError(404) from None
        self.send_file(content, path.name)


class ShowHandler(FileHandler):
    """A report in a frame: the policy around it lets no script in it lead the frame elsewhere."""

    async def get(self, token: str) -> None:
        """The page around it."""
        path = self.path(token)
        self.set_header("Content-Security-Policy", FRAME_POLICY)
        self.send_file(FRAME.format(address=f"/files/{token}", title=path.stem).encode(), "frame.html")


@stream_request_body
class UploadHandler(Guarded):
    """A recording: the key is checked before a byte of it is read, its size while it comes."""

    needs_origin = True

    def prepare(self) -> None:
        """Refuse, or open the door as wide as an upload may be."""
        super().prepare()
        most = int(LARGEST_MB * 1e6)
        length = self.request.headers.get("Content-Length", "")
        if not length.isdecimal() or int(length) > most:
            raise HTTPError(413, log_message=f"a recording may have {LARGEST_MB:.0f} MB here; thin it out")
        assert isinstance(self.request.connection, HTTP1Connection)
        self.request.connection.set_max_body_size(most)
        self._body = bytearray()

    def data_received(self, chunk: bytes) -> None:
        """Part of it."""
        self._body += chunk

    async def post(self) -> None:
        """A line of JSON, [[name, size], ...], and the files one after the other."""
        session = self.tabs.sessions.get(self.get_query_argument("tab", ""))
        if session is None:
            raise HTTPError(404)
        try:
            await session.upload(lambda place: asyncio.to_thread(unpack, split(bytes(self._body)), place))
        except InputError as error:
            raise HTTPError(400, log_message=str(error).replace("%", "%%")) from None
        except OSError as error:
            raise HTTPError(400, log_message=f"the recording cannot be kept here ({error.strerror})") from None
        self.finish("")


class SocketHandler(Guarded, WebSocketHandler):
    """What a tab asks for and is told."""

    needs_origin = True
    session: Session | None = None

    def check_origin(self, origin: str) -> bool:
        """The guard has checked it; this is asked by the library."""
        return self.tabs.guard.refusal({**self.request.headers, "Origin": origin}, None, needs_origin=True) is None

    async def open(self, *_: str) -> None:
        """A tab is there. It may be gone again before its form is made."""
        tab = self.get_query_argument("tab", "") or None
        try:
            self.session = session = self.tabs.session(tab, self.get_query_argument("copy", "") == "1")
        except (InputError, OSError) as error:
            said = str(error) if isinstance(error, InputError) else f"no folder can be made here ({error.strerror})"
            self._send({"tell": "said", "text": said, "bad": True})
            self.close()
            return
        self._send({"tell": "tab", "name": session.name})
        session.attach(self._send)
        self._form = asyncio.create_task(self._send_form(session))

    async def _send_form(self, session: Session) -> None:
        try:
            self._send({"tell": "form", **await self.tabs.form()})
        except (MachineError, TaskRefused) as error:
            session.say(f"the form could not be made: {error}; load the page again")

    def on_message(self, message: str | bytes) -> None:
        """One request; of a tab that another one has followed, nothing."""
        if self.session is None or self.session.line != self._send:
            return
        try:
            asked = json.loads(message)
        except (ValueError, RecursionError):
            asked = None
        self.session.receive(asked)

    def on_close(self) -> None:
        """A tab is gone, or loads again."""
        if self.session is not None and self.session.line == self._send:
            self.tabs.left(self.session)

    def _send(self, message: dict[str, Any]) -> None:
        with suppress(WebSocketClosedError):
            content = packed(message)
            sent = asyncio.ensure_future(self.write_message(content, binary=isinstance(content, bytes)))
            sent.add_done_callback(lambda done: done.cancelled() or done.exception())  # the tab may be gone


def application(tabs: Tabs) -> Application:
    """Every address of the server."""
    shared = {"tabs": tabs}
    return Application(
        [
            ("/", PageHandler, shared),
            ("/greeting", GreetingHandler, shared),
            ("/socket", SocketHandler, shared),
            ("/upload", UploadHandler, shared),
            (r"/assets/([\w.-]+)", AssetHandler, shared),
            (r"/files/([\w-]+/[\w.-]+)", FileHandler, shared),
            (r"/show/([\w-]+/[\w-]+\.html)", ShowHandler, shared),
        ],
        default_handler_class=MissingHandler,
        default_handler_args=shared,
        websocket_max_message_size=LARGEST_MESSAGE,
        websocket_ping_interval=20,
        log_function=lambda _: None,  # addresses hold the key
    )


class MissingHandler(Guarded):
    """Every other address."""

    needs_key = False

    def prepare(self) -> None:
        """There is nothing."""
        super().prepare()
        raise HTTPError(404)
