"""How quickly the studio's page shows a large view: .venv/bin/python -m benchmarks.studio_view [TRIANGLES]

Three boxes of tetrahedra over seven steps, sent by the studio's own server and drawn by Chromium without a GPU. What is
told, in ms from when the program begins to pack the message: received by the page, taken over by its scripts, and drawn
to the last pixel; and how long it takes to pack it alone. Views come one after the other, in the same tab. Work is
processor time of this process (the server), and of the processes of the browser, by what they are for.
"""

import asyncio
import json
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import psutil
from tornado.httpclient import AsyncHTTPClient
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop
from tornado.netutil import bind_sockets
from tornado.websocket import websocket_connect

from benchmarks.studio import FLAGS
from export.viewer_data import colour_map_bytes
from mesh.types import TET_FACES
from softdot.commands.studio import start_text
from softdot.studio.design_state import DesignState
from softdot.studio.frames import packed
from softdot.studio.guard import Guard
from softdot.studio.handlers import application
from softdot.studio.large_messages import large_messages
from softdot.studio.work.form import form

BOXES, STEPS, LAYERS, TIMES = 3, 7, 2, 3
LOADED_S = 3.0
"""After which the page has loaded and drawn what it begins with."""
IN_CUBE = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]])
"""Tetrahedra of a cube by its corners, whose bits are x, y and z."""
WATCH = """() => {
  const Real = window.WebSocket;
  window.times = [];
  window.WebSocket = class extends Real {
    constructor(...of) {
      super(...of);
      this.addEventListener("message", ({ data }) => { if (typeof data !== "string") window.received = Date.now(); });
    }
  };
  document.addEventListener("softdot", ({ detail }) => {
    if (detail !== "state" || !window.received) return;
    const taken = Date.now(), { received } = window;
    window.received = 0;
    requestAnimationFrame(() => {
      const gl = document.querySelector("#view3d canvas").getContext("webgl2");
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      window.times.push([received, taken, Date.now()]);
    });
  });
}"""


def box(side: int, layers: int) -> tuple[Any, Any, Any]:
    """Nodes (n, 3), tetrahedra (m, 4) and the triangles (t, 3) of their surface, of a box of cubes."""
    shape = (side + 1, side + 1, layers + 1)
    nodes = np.stack(np.meshgrid(*(np.arange(count) for count in shape), indexing="ij"), -1).reshape(-1, 3)
    first = np.stack(np.meshgrid(*(np.arange(count - 1) for count in shape), indexing="ij"), -1).reshape(-1, 3)
    corners = np.array([[number & 1, number >> 1 & 1, number >> 2] for number in range(8)])
    cubes = np.ravel_multi_index(tuple(np.moveaxis(first[:, None] + corners, -1, 0)), shape)
    tets = cubes[:, IN_CUBE].reshape(-1, 4)
    faces = tets[:, np.array(TET_FACES)[:, :3]].reshape(-1, 3)
    _, where, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return nodes / (side, side, layers), tets, faces[where[count == 1]]


def view(triangles: int) -> dict[str, Any]:
    """As export.solid_view makes it, with at least so many triangles."""
    side = int(np.ceil(np.sqrt(triangles / BOXES / 4.0)))
    nodes, tets, faces = box(side, LAYERS)
    count = len(nodes)
    points = np.concatenate([nodes * (2.5, 2.5, 0.5) + (0, 0, 0.5 * number) for number in range(BOXES)])
    together = [np.concatenate([one + number * count for number in range(BOXES)]) for one in (faces, tets)]
    rng = np.random.default_rng(0)
    shares = {
        name: rng.integers(0, 255, (STEPS, len(points)), np.uint8)
        for name in ("stress", "strain", "charge", "pressure")
    }
    return {
        "steps": [{"indentation": 0.1 * step, "force": 0.1 * step} for step in range(STEPS)],
        "names": ["medium2", "film", "medium1"], "colours": [[0.6, 0.7, 0.8], [0.7, 0.2, 0.3], [0.5, 0.7, 0.6]],
        **colour_map_bytes(), "slice": False, "plane": 1.25, "points": points.astype(np.float32),
        "region": np.repeat(np.arange(BOXES, dtype=np.uint8), count),
        "triangles": together[0].astype(np.uint32), "tets": together[1].astype(np.uint32),
        "displacement": rng.integers(-9, 9, (STEPS, len(points), 3), np.int16), "displacementUnit": 1e-3,
        **shares, "tops": dict.fromkeys(shares, 1.0),
        "dotPoints": points[:3].astype(np.float32), "dotShift": [[0.0, 0.0, 0.0]] * STEPS, "dotColour": [0.5, 0.5, 0.5],
    }  # fmt: skip


def work_ms() -> dict[str, float]:
    """Processor time of this process and of those that it started, by what those of the browser are for."""
    own = psutil.Process()
    found = {"server": sum(own.cpu_times()[:2])}
    for one in own.children(recursive=True):
        with suppress(psutil.Error):
            kind = next((word[7:] for word in one.cmdline() if word.startswith("--type=")), "browser")
            found[kind] = found.get(kind, 0.0) + sum(one.cpu_times()[:2])
    return {kind: 1e3 * spent for kind, spent in found.items()}


class FixedTab:
    """A tab whose design is drawn already. shows : when each view was begun to be packed, and how long that took."""

    def __init__(self, shown: dict[str, Any]) -> None:
        self.name, self.files, self.line = "fixed", {}, None
        self.state = DesignState(f"# many triangles\n{start_text(None)}")
        self._view = shown
        self.shows: list[tuple[float, float]] = []

    def attach(self, line: Any) -> None:
        """Tell the state without parts."""
        self.line = line
        self._line({"tell": "state", "serial": 0, "heard": 0, **self.state.told(), "kept": []})

    def _line(self, message: dict[str, Any]) -> None:
        assert self.line is not None
        self.line(message)

    def show(self) -> None:
        """Tell the parts, as a session does."""
        self.state.drawn(self.state.present, dict(self._view))
        message = {"tell": "parts", **large_messages(self.state)["parts"][1]()}
        began = time.perf_counter()
        packed(message)
        packing = time.perf_counter() - began
        self.shows.append((1e3 * time.time(), 1e3 * packing))
        self._line(message)
        self._line({"tell": "state", "serial": 1, "heard": 0, **self.state.told(), "kept": []})

    def receive(self, _: Any) -> None:
        """Nothing is asked for."""


def serve(tab: FixedTab, ready: threading.Event, told: dict[str, Any]) -> None:
    """The studio's server with this tab alone, until its loop is stopped."""
    sockets = bind_sockets(0, "127.0.0.1")
    port = sockets[0].getsockname()[1]
    guard = Guard.of("127.0.0.1", port)

    async def made() -> Any:
        return form()

    tabs = SimpleNamespace(guard=guard, sessions={"fixed": tab}, session=lambda *_: tab, form=made, left=lambda _: None)
    server = HTTPServer(application(tabs))  # type: ignore[arg-type]
    server.add_sockets(sockets)
    told |= {"loop": IOLoop.current(), "address": f"http://127.0.0.1:{port}/?key={guard.key}"}
    ready.set()
    told["loop"].start()


class Watched:
    """A page of Chromium by its DevTools protocol alone: with a library beside it that records what comes over the net,
    as playwright does, the browser would copy every message twice.
    """

    def __init__(self, folder: str, flags: list[str]) -> None:
        command = [
            str(shutil.which("chromium")),
            "--headless=new",
            "--remote-debugging-port=0",
            "--window-size=1366,768",
        ]
        command += [f"--user-data-dir={folder}", "--no-first-run", *flags, "about:blank"]
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._port_file, self._count, self._line = Path(folder) / "DevToolsActivePort", 0, None

    async def open(self) -> None:
        """Connect to its page."""
        while not self._port_file.exists():
            await asyncio.sleep(0.1)
        await asyncio.sleep(1.0)
        port = self._port_file.read_text("ascii").split()[0]
        found = await AsyncHTTPClient().fetch(f"http://127.0.0.1:{port}/json")
        address = next(one["webSocketDebuggerUrl"] for one in json.loads(found.body) if one["type"] == "page")
        self._line = await websocket_connect(address)

    async def ask(self, method: str, **what: Any) -> dict[str, Any]:
        """The answer to one command."""
        assert self._line is not None
        self._count += 1
        await self._line.write_message(json.dumps({"id": self._count, "method": method, "params": what}))
        while True:
            told = json.loads(await self._line.read_message() or "{}")
            if told.get("id") == self._count:
                return dict(told["result"])

    async def value(self, expression: str) -> Any:
        """Of an expression in the page."""
        found = await self.ask("Runtime.evaluate", expression=expression, returnByValue=True)
        return found["result"].get("value")


async def watched(page: Watched, tab: FixedTab, told: dict[str, Any]) -> tuple[list[list[float]], dict[str, float]]:
    """Times of TIMES views, [received, taken over, drawn], and the work of each."""
    await page.open()
    await page.ask("Page.enable")
    await page.ask("Page.addScriptToEvaluateOnNewDocument", source=f"({WATCH})()")
    await page.ask("Page.navigate", url=told["address"])
    while tab.line is None:
        await asyncio.sleep(0.1)
    await asyncio.sleep(LOADED_S)
    before = work_ms()
    for number in range(TIMES):
        told["loop"].add_callback(tab.show)
        while await page.value("window.times.length") <= number:
            await asyncio.sleep(0.2)
        await asyncio.sleep(0.5)
    work = {kind: round((spent - before.get(kind, 0.0)) / TIMES) for kind, spent in work_ms().items()}
    return await page.value("window.times"), work


def main() -> None:
    """Show the view TIMES times and print what each took."""
    asked = int(sys.argv[1]) if len(sys.argv) > 1 else 200_000
    tab, ready, told = FixedTab(view(asked)), threading.Event(), {}
    threading.Thread(target=serve, args=(tab, ready, told), daemon=True).start()
    ready.wait(20)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        page = Watched(folder, FLAGS)
        try:
            times, work = asyncio.run(watched(page, tab, told))
        finally:
            page.process.terminate()
            page.process.wait(20)
    shown = tab.state.artefacts()["parts"].content
    print(f"{len(shown['triangles'])} triangles, {len(shown['tets'])} tetrahedra, {len(shown['points'])} nodes")
    print(json.dumps({"work for each view": work}))
    for (began, packing), (received, taken, drawn) in zip(tab.shows, times, strict=True):
        row = {"packed": packing, "received": received - began, "taken over": taken - began, "drawn": drawn - began}
        print(json.dumps({name: round(value) for name, value in row.items()}))


if __name__ == "__main__":
    main()
