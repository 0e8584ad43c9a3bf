"""What each address of the page answers: page, scripts, files, uploads and the socket of a tab."""

import asyncio
import json
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from typing import Any

from tornado.http1connection import HTTP1Connection
from tornado.web import Application, HTTPError, RequestHandler, stream_request_body
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from foundation.errors import InputError
from softdot.studio.frames import packed
from softdot.studio.guard import HEADERS, PAPER_POLICY
from softdot.studio.session import Session
from softdot.studio.tabs import Tabs
from softdot.studio.uploads import LARGEST_MB, split, unpack

PAGE = files("softdot.studio").joinpath("page")
TEXTS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
KINDS = {ending: f"{kind}; charset=utf-8" for ending, kind in TEXTS.items()} | {".png": "image/png"}
FOLDERS = PAGE, PAGE.joinpath("scripts"), PAGE.joinpath("vendor")
ASSETS = {one.name: one for folder in FOLDERS for one in folder.iterdir() if one.name.endswith((".css", ".js", ".svg"))}
LARGEST_MESSAGE = 1 << 20


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
        refused = self.tabs.guard.refusal(self.request.headers, key, self.needs_origin)
        if refused is not None:
            raise HTTPError(403, reason="Forbidden", log_message=refused)

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
    """What a task has made, under a random address that only its tab was told."""

    def get(self, token: str) -> None:
        """A download, a picture, or a report, which may do nothing but show itself."""
        path = next((found for one in self.tabs.sessions.values() if (found := one.files.get(token))), None)
        if path is None or not path.is_file():
            raise HTTPError(404)
        if path.suffix == ".html":
            self.set_header("Content-Security-Policy", PAPER_POLICY)
        self.send_file(path.read_bytes(), path.name)


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
        self.finish("")


class SocketHandler(Guarded, WebSocketHandler):
    """What a tab asks for and is told."""

    needs_origin = True
    session: Session | None = None

    def check_origin(self, origin: str) -> bool:
        """The guard has checked it; this is asked by the library."""
        return self.tabs.guard.refusal({**self.request.headers, "Origin": origin}, None, needs_origin=True) is None

    async def open(self, *_: str) -> None:
        """A tab is there."""
        try:
            self.session = self.tabs.session(self.get_query_argument("tab", "") or None)
        except InputError as error:
            self._send({"tell": "said", "text": str(error), "bad": True})
            self.close()
            return
        session = self.session
        session.send = self._send
        self._send({"tell": "tab", "name": session.name})
        self._send({"tell": "form", **await self.tabs.form()})
        session.attach(self._send)

    def on_message(self, message: str | bytes) -> None:
        """One request."""
        if self.session is None:
            return
        try:
            asked = json.loads(message)
        except (ValueError, RecursionError):
            asked = None
        self.session.receive(asked)

    def on_close(self) -> None:
        """A tab is gone, or loads again."""
        if self.session is not None:
            self.tabs.left(self.session)

    def _send(self, message: dict[str, Any]) -> None:
        with suppress(WebSocketClosedError):
            content = packed(message)
            self.write_message(content, binary=isinstance(content, bytes))


def application(tabs: Tabs) -> Application:
    """Every address of the server."""
    shared = {"tabs": tabs}
    return Application(
        [
            ("/", PageHandler, shared),
            ("/socket", SocketHandler, shared),
            ("/upload", UploadHandler, shared),
            (r"/assets/([\w.-]+)", AssetHandler, shared),
            (r"/files/([\w-]+/[\w.-]+)", FileHandler, shared),
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
