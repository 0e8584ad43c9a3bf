"""Many connections, many sockets, many uploads: the studio answers its user, and leaves nothing behind."""

import io
import json
import os
import socket
import time
import zipfile

import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.ioloop import IOLoop
from tornado.websocket import websocket_connect

from softdot.studio.guard import Guard
from softdot.studio.port_key import PortKey
from softdot.studio.tabs import MOST_TABS
from tests.studio.test_security import asked, handshake, heard, origin

HALF = b"GET /?key=x HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: "


def connected(studio):
    """A socket of a tab, and its name."""

    async def talk():
        address = f"ws://127.0.0.1:{studio.port}/socket?key={studio.key}"
        line = await websocket_connect(HTTPRequest(address, headers={"Origin": origin(studio)}))
        return line, heard(await line.read_message())

    return talk()


@pytest.mark.process
def test_half_open_requests_without_the_key_keep_nobody_out(start_studio):
    running = start_studio()
    lines = []
    try:
        for _ in range(1100):
            line = socket.create_connection(("127.0.0.1", running.port), timeout=20)
            line.sendall(HALF)
            lines.append(line)
        began = time.monotonic()
        assert asked(running, f"/?key={running.key}")[0] == 200
        assert handshake(running, running.key) == 101
        assert time.monotonic() - began < 5.0
        lines[0].settimeout(20.0)
        assert lines[0].recv(100) == b""  # the oldest is closed
    finally:
        for line in lines:
            line.close()
    assert running.end() == 0
    assert running.process.stderr.read() == "softdot studio: ended; designs are kept\n"


@pytest.mark.process
def test_a_request_that_is_never_finished_is_closed(studio):
    with socket.create_connection(("127.0.0.1", studio.port), timeout=30) as line:
        line.sendall(HALF)
        began = time.monotonic()
        assert line.recv(100) == b""
        assert 5.0 < time.monotonic() - began < 25.0


@pytest.mark.process
def test_sockets_that_close_during_the_start_lock_nobody_out(start_studio):
    running = start_studio()

    async def talk():
        for _ in range(2 * MOST_TABS):
            line, _ = await connected(running)
            line.close()
        line, told = await connected(running)
        while told["tell"] != "form":
            assert told["tell"] != "said"
            told = heard(await line.read_message())
        line.close()

    IOLoop().run_sync(talk, timeout=120)
    assert running.end() == 0


@pytest.mark.process
def test_a_refused_upload_leaves_no_file_and_no_recording(start_studio, tmp_path, monkeypatch):
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("rig.toml", "")
        archive.writestr("press.csv", b"\0" * (101 << 20))
    content = bomb.getvalue()
    body = json.dumps([["bomb.zip", len(content)]]).encode() + b"\n" + content
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    running = start_studio()

    async def talk():
        line, told = await connected(running)
        address = f"{origin(running)}/upload?key={running.key}&tab={told['name']}"
        sent = HTTPRequest(address, "POST", {"Origin": origin(running)}, body)
        answer = await AsyncHTTPClient().fetch(sent, raise_error=False)
        line.close()
        return answer.code, answer.body.decode()

    code, said = IOLoop().run_sync(talk, timeout=60)
    assert (code, "more than 100 MB" in said) == (400, True)
    assert list(tmp_path.rglob("*.csv")) == []
    assert running.end() == 0


def test_a_tab_and_the_studio_know_each_other_without_sending_the_key():
    """A question counts once, and another program that listens on the port can answer none."""
    studio, impostor = Guard.of("127.0.0.1", 80), Guard.of("127.0.0.1", 80)
    greeting = studio.greeting("n" * 32)
    assert greeting["proof"] == studio._proof("studio", "n" * 32)
    assert impostor.greeting("n" * 32)["proof"] != greeting["proof"]
    assert studio.key not in json.dumps(greeting)
    answer = studio._proof("tab", greeting["question"])
    assert not impostor.answered(greeting["question"], answer)
    assert studio.answered(greeting["question"], answer)
    assert not studio.answered(greeting["question"], answer)
    assert not studio.answered(studio.greeting("n" * 32)["question"], answer)


def test_the_key_of_a_port_outlives_a_restart_for_a_while_and_is_closed_to_others(tmp_path):
    keys = PortKey(tmp_path / "keys")
    key = keys.take(8123)
    file = tmp_path / "keys" / "8123.key"
    assert (file.stat().st_mode & 0o777, file.parent.stat().st_mode & 0o777) == (0o600, 0o700)
    assert (keys.take(8123), keys.last_port()) == (key, 8123)
    assert keys.take(8124) != key
    file.chmod(0o644)  # somebody may have read it
    second = keys.take(8123)
    assert second != key
    os.utime(file, (time.time() - 700, time.time() - 700))
    assert keys.take(8123) != second
