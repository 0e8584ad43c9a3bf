"""Each threat of docs/studio_security.md, as an attack on a studio that runs."""

import http.client
import json
import os
import re
import socket
import stat
import subprocess
import sys
from types import SimpleNamespace

import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop
from tornado.iostream import StreamClosedError
from tornado.netutil import bind_sockets
from tornado.websocket import WebSocketClosedError, websocket_connect

from softdot.commands import studio as command
from softdot.studio.guard import Guard
from softdot.studio.handlers import application
from softdot.studio.tabs import MOST_TABS
from tests.cases import for_each
from tests.diagnose.rigs import HEAD, RUN, SEGMENT, write_rig

pytestmark = pytest.mark.process

FAR = "http://evil.example"
LIMIT_MB = 25
NAMES = "report.html", "kit.zip"


def asked(studio, path, method="GET", body=None, **headers):
    """Status, headers and text of an answer; headers replace those that a browser would send."""
    connection = http.client.HTTPConnection("127.0.0.1", studio.port, timeout=20)
    connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
    own = {"Host": f"127.0.0.1:{studio.port}", **{name.replace("_", "-"): value for name, value in headers.items()}}
    for name, value in own.items():
        if value is not None:
            connection.putheader(name, value)
    connection.endheaders(body)
    answer = connection.getresponse()
    found = answer.status, dict(answer.getheaders()), answer.read().decode("utf-8", "replace")
    connection.close()
    return found


def origin(studio):
    return f"http://127.0.0.1:{studio.port}"


def handshake(studio, key, **headers):
    """Status of an attempt to open the socket."""
    upgrade = {
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec_WebSocket_Version": "13",
        "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==",
    }
    return asked_raw(studio, f"/socket?key={key}", {"Origin": origin(studio), **upgrade, **headers})


def asked_raw(studio, path, headers):
    with socket.create_connection(("127.0.0.1", studio.port), timeout=20) as line:
        own = {"Host": f"127.0.0.1:{studio.port}", **{name.replace("_", "-"): value for name, value in headers.items()}}
        text = "".join(f"{name}: {value}\r\n" for name, value in own.items() if value is not None)
        line.sendall(f"GET {path} HTTP/1.1\r\n{text}\r\n".encode())
        return int(line.recv(4096).split()[1])


@for_each("key", ["", "wrong", "wslink-secret", "é", "x" * 5000])
def test_without_the_key_of_this_start_nothing_is_answered(studio, key):
    quoted = "%C3%A9" if key == "é" else key
    assert asked(studio, f"/?key={quoted}")[0] == 403
    assert asked(studio, f"/files/a/b?key={quoted}")[0] == 403
    assert handshake(studio, quoted) == 403
    assert asked(studio, f"/upload?key={quoted}", "POST", b"x", Origin=origin(studio), Content_Length="1")[0] == 403
    assert asked(studio, "/")[0] == 403


def test_the_key_is_long_and_of_this_start(studio, start_studio):
    assert len(studio.key) >= 43  # 256 bits
    other = start_studio()
    assert other.key != studio.key
    assert asked(other, f"/?key={studio.key}")[0] == 403
    assert other.end() == 0


@for_each("host", ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1.evil.example:{port}", None])
def test_another_name_is_refused_so_that_rebinding_a_name_leads_nowhere(studio, host):
    named = host and host.format(port=studio.port)
    paths = [f"/?key={studio.key}", "/assets/main.js"]
    assert [asked(studio, path, Host=named)[0] in (400, 403) for path in paths] == [True, True]
    assert handshake(studio, studio.key, Host=named, Origin=f"http://{named}") in (400, 403)


@for_each(
    "far", [FAR, "null", "http://127.0.0.1:1", "https://127.0.0.1:{port}", "http://127.0.0.1.evil.example:{port}", None]
)
def test_a_page_from_elsewhere_opens_no_socket_and_sends_nothing(studio, far):
    stated = far and far.format(port=studio.port)
    assert handshake(studio, studio.key, Origin=stated) == 403
    status, _, _ = asked(studio, f"/upload?key={studio.key}", "POST", b"x", Origin=stated, Content_Length="1")
    assert status == 403


def test_its_own_page_opens_the_socket(studio):
    assert handshake(studio, studio.key) == 101


def test_every_answer_carries_the_policy(studio):
    for path in (f"/?key={studio.key}", "/", "/assets/main.js", "/nothing", "/assets/none.js"):
        _, headers, _ = asked(studio, path)
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "unsafe" not in policy
        assert (headers["X-Content-Type-Options"], headers["Referrer-Policy"]) == ("nosniff", "no-referrer")
        assert headers["X-Frame-Options"] == "DENY"
        assert "ornado" not in headers["Server"]


def test_the_page_holds_no_script_or_style_and_names_no_other_place(studio):
    _, _, page = asked(studio, f"/?key={studio.key}")
    assert re.search(r"<script(?![^>]*\bsrc=)|<style|\son\w+=|\sstyle=", page) is None
    everything = page + "".join(asked(studio, path)[2] for path in set(re.findall(r'="(/assets/[\w.]+)"', page)))
    modules = set(re.findall(r'from "\./(\w+\.js)"', everything))
    assert modules
    everything += "".join(asked(studio, f"/assets/{name}")[2] for name in modules)
    code = re.sub(r"/\*.*?\*/", "", everything, flags=re.DOTALL)  # a licence names where its library comes from
    found = set(re.findall(r"(?:https?|wss?|ftp)://[\w.$]+", code))
    assert found <= {"http://www.w3.org", "ws://$"}  # the name of SVG, and the server itself
    assert re.search(r"\beval\(|new Function\(|innerHTML|document\.write|insertAdjacentHTML", everything) is None


@for_each(
    "path",
    [
        "/assets/../server.py",
        "/assets/%2e%2e/server.py",
        "/assets/..%2fserver.py",
        "/assets/server.py",
        "/files/../../etc/passwd",
        "/files/x/..%2f..%2fetc%2fpasswd",
        "//etc/passwd",
        "/assets/main.js%00.py",
        "/assets/index.html/../../guard.py",
    ],
)
def test_no_address_leads_to_another_file(studio, path):
    status, _, text = asked(studio, f"{path}?key={studio.key}")
    assert status in (400, 403, 404)
    assert "import" not in text
    assert "root:" not in text


def test_thirty_megabytes_are_refused_before_they_are_read(studio):
    """Whatever length is stated, or none."""
    path, size = f"/upload?key={studio.key}&tab=x", 30_000_000
    status, _, text = asked(studio, path, "POST", None, Origin=origin(studio), Content_Length=str(size))
    assert (status, text) == (413, f"a recording may have {LIMIT_MB} MB here; thin it out")
    status, _, _ = asked(studio, path, "POST", None, Origin=origin(studio), Transfer_Encoding="chunked")
    assert status == 413
    before = memory_MB(studio)
    assert sent_until_closed(studio, f"/?key={studio.key}", size) < size
    assert sent_until_closed(studio, "/upload?key=wrong", size) < size
    assert memory_MB(studio) < before + 5


def sent_until_closed(studio, path, size):
    """Bytes of a body that the server takes before it closes."""
    sent, piece = 0, b"x" * 65536
    with socket.create_connection(("127.0.0.1", studio.port), timeout=20) as line:
        head = f"POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{studio.port}\r\nContent-Length: {size}\r\n\r\n"
        line.sendall(head.encode())
        try:
            while sent < size:
                sent += line.send(piece)
        except OSError:
            pass
    return sent


def memory_MB(studio):
    with open(f"/proc/{studio.process.pid}/status", encoding="ascii") as status:
        return int(re.search(r"VmRSS:\s+(\d+)", status.read())[1]) / 1e3


def test_an_endless_header_is_cut(studio):
    with socket.create_connection(("127.0.0.1", studio.port), timeout=20) as line:
        line.sendall(b"GET / HTTP/1.1\r\n")
        filler = (b"X-Filler: " + b"x" * 1000 + b"\r\n") * 20_000
        with pytest.raises(OSError, match=r"reset|Broken"):
            line.sendall(filler)
    assert asked(studio, f"/?key={studio.key}")[0] == 200


def heard(message):
    """What the program tells; of a frame with arrays its head."""
    if isinstance(message, bytes):
        return json.loads(message[4 : 4 + int.from_bytes(message[:4], "little")])
    return json.loads(message)


def spoken(studio, *messages, answers):
    """What the socket tells after some messages, the first of each kind in answers."""

    async def talk():
        tab = getattr(studio, "tab", "")  # the one before comes back
        address = f"ws://127.0.0.1:{studio.port}/socket?key={studio.key}&tab={tab}"
        line = await websocket_connect(HTTPRequest(address, headers={"Origin": origin(studio)}))
        found = {}
        while "state" not in found:
            told = heard(await line.read_message())
            found[told["tell"]] = told
        studio.tab = found["tab"]["name"]
        found.pop("said", None)
        try:
            for message in messages:
                await line.write_message(message)
        except (StreamClosedError, WebSocketClosedError):  # closed while the message was still being written
            return {"closed": True}
        while not set(answers) <= set(found):
            told = await line.read_message()
            if told is None:
                return {"closed": True}
            told = heard(told)
            found[told["tell"]] = told
        line.close()
        return found

    return IOLoop().run_sync(talk, timeout=60)


@for_each(
    "message",
    [
        "",
        "[",
        "null",
        "[]",
        "7",
        '{"do": 7}',
        '{"do": "__init__"}',
        '{"do": "close"}',
        '{"do": "set"}',
        '{"do": "set", "key": 3, "value": 1}',
        '{"do": "set", "key": ["segment", true], "value": 1}',
        '{"do": "take", "number": 99}',
        '{"do": "cancel", "task": "follow"}',
        '{"do": "start", "task": "../kit"}',
        '{"do": "start", "task": "diagnosis"}',
        '{"do": "text", "text": 5}',
        '{"do": "text", "text": "a\\u0000"}',
        '{"do": "restore", "name": "../../etc/passwd"}',
        '{"do": "restore", "name": "none"}',
        '{"do": "improve"}',
        "[" * 50_000,
    ],
)
def test_nonsense_on_the_socket_is_answered_with_one_sentence(studio, message):
    found = spoken(studio, message, answers=["said"])["said"]
    assert found["bad"] is True
    assert len(found["text"]) < 300
    assert re.search(r"Traceback|\.py|/tmp/|\n", found["text"]) is None


def test_a_message_that_is_too_long_closes_the_socket(studio):
    assert spoken(studio, "x" * (2 << 20), answers=["never"]) == {"closed": True}


@for_each("name", ["/etc/passwd", "../secret.csv", "C:\\secret.csv", "/dev/zero"])
@for_each("text", ["[mesh]\nfile = {}\n", '[press.waveform]\nshape = "file"\nfile = {}\n', "include = [{}]\n"])
def test_a_design_of_somebody_else_reads_no_file_outside(studio, name, text):
    text = text.format(json.dumps(name))
    found = spoken(studio, json.dumps({"do": "text", "text": text}), answers=["state"])
    while not found["state"]["design"]["mistakes"]:  # it is being checked
        found = spoken(studio, answers=["state"])
    assert "must be below the folder in which the studio was started" in found["state"]["design"]["mistakes"][0]


def test_tabs_are_bounded(start_studio):
    running = start_studio()

    async def talk():
        address = f"ws://127.0.0.1:{running.port}/socket?key={running.key}"
        request = {"Origin": origin(running)}
        lines = [await websocket_connect(HTTPRequest(address, headers=request)) for _ in range(MOST_TABS + 1)]
        return json.loads(await lines[-1].read_message()), await lines[-1].read_message()

    told, closed = IOLoop().run_sync(talk, timeout=60)
    assert "close a tab" in told["text"]
    assert closed is None
    assert running.end() == 0


def test_a_report_is_shown_in_a_sandbox(tmp_path):
    """As a page of nowhere: without the studio's origin, and without the net."""
    (tmp_path / "report.html").write_text("<script>fetch('/')</script>", "utf-8")
    (tmp_path / "kit.zip").write_bytes(b"PK")

    async def answers():
        sockets = bind_sockets(0, "127.0.0.1")
        guard = Guard.of("127.0.0.1", sockets[0].getsockname()[1])
        made = {f"x/{name}": tmp_path / name for name in ("report.html", "kit.zip", "gone.html")}
        tabs = SimpleNamespace(guard=guard, sessions={"tab": SimpleNamespace(files=made)})
        server = HTTPServer(application(tabs))
        server.add_sockets(sockets)
        fetch = AsyncHTTPClient().fetch
        address = f"http://127.0.0.1:{sockets[0].getsockname()[1]}/files/x/"
        found = [await fetch(f"{address}{name}?key={guard.key}", raise_error=False) for name in (*NAMES, "gone.html")]
        server.stop()
        return found

    report, archive, gone = IOLoop().run_sync(answers, timeout=20)
    policy = report.headers["Content-Security-Policy"]
    assert policy.startswith("sandbox allow-scripts; default-src 'none'")
    assert "allow-same-origin" not in policy
    assert "connect-src" not in policy
    assert archive.headers["Content-Disposition"] == 'attachment; filename="kit.zip"'
    assert gone.code == 404


def test_mistakes_and_refusals_have_no_traceback(studio):
    for path in ("/nothing", f"/files/x/y?key={studio.key}", "/?key=%ff", "/%", "/?key=a&key=b"):
        status, _, text = asked(studio, path)
        assert status in (400, 403, 404)
        assert "Traceback" not in text
        assert "\n" not in text.strip()


def test_nothing_listens_beyond_loopback(studio):
    with open("/proc/net/tcp", encoding="ascii") as table:
        local = [line.split()[1] for line in table.readlines()[1:]]
    assert f"0100007F:{studio.port:04X}" in local
    assert f"00000000:{studio.port:04X}" not in local


def test_the_key_is_no_argument_of_the_browser_and_its_file_is_closed_to_others(monkeypatch):
    opened = []
    monkeypatch.setattr(command.webbrowser, "open", opened.append)
    place = command._open("http://127.0.0.1:1/?key=secret")
    assert "secret" not in opened[0]
    assert "secret" in place.read_text("utf-8")
    assert stat.S_IMODE(place.stat().st_mode) == 0o600
    assert stat.S_IMODE(place.parent.stat().st_mode) == 0o700
    place.unlink()
    place.parent.rmdir()


def test_saved_designs_are_closed_to_others_and_the_log_holds_no_key(start_studio):
    running = start_studio()
    assert asked(running, "/?key=wrong")[0] == 403
    spoken(running, answers=["state"])
    designs = running.folder / "designs"
    assert stat.S_IMODE(designs.stat().st_mode) == 0o700
    assert len(list(designs.glob("*.toml"))) == 1
    assert running.end() == 0
    assert running.process.stderr.read() == "softdot studio: ended; designs are kept\n"


def test_other_addresses_only_when_told_and_then_under_that_name_alone():
    assert Guard.of("127.0.0.1", 80).hosts == {"127.0.0.1:80", "localhost:80", "[::1]:80"}
    assert Guard.of("192.168.1.5", 80).hosts == {"192.168.1.5:80"}
    assert Guard.of("fe80::1", 80).hosts == {"[fe80::1]:80"}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--host", "0.0.0.0"], "--host 0.0.0.0: name one address"),
        (["--port", "70000"], "--port = 70000: must be between"),
        (["--host", "no.such.host.invalid"], "cannot be used"),
        (["none.toml"], "there is no such file"),
        (["--family", "nowhere"], "'nowhere': holds no 'family.json'"),
    ],
)
def test_bad_arguments_are_refused_in_one_sentence(tmp_path, arguments, said):
    command_line = [sys.executable, "-m", "softdot", "studio", "--no-browser", *arguments]
    done = subprocess.run(
        command_line, cwd=tmp_path, capture_output=True, encoding="utf-8", timeout=60, env=dict(os.environ)
    )
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert len([line for line in done.stderr.splitlines() if "warning" not in line]) == 1


def test_a_recording_of_somebody_else_reads_no_file_outside(studio, tmp_path):
    """It is refused when it is read, and is then no recording that could be diagnosed."""
    rig = write_rig(tmp_path / "rig", HEAD + '[mesh]\nfile = "/etc/passwd"\n' + SEGMENT + RUN)
    files = [(one.name, one.read_bytes()) for one in rig.iterdir()]
    body = json.dumps([[name, len(content)] for name, content in files]).encode() + b"\n"
    body += b"".join(content for _, content in files)

    async def talk():
        address = f"ws://127.0.0.1:{studio.port}/socket?key={studio.key}&tab={getattr(studio, 'tab', '')}"
        line = await websocket_connect(HTTPRequest(address, headers={"Origin": origin(studio)}))
        told = heard(await line.read_message())
        sent = HTTPRequest(
            f"{origin(studio)}/upload?key={studio.key}&tab={told['name']}", "POST", {"Origin": origin(studio)}, body
        )
        assert (await AsyncHTTPClient().fetch(sent)).code == 200
        while told["tell"] != "state" or told["tasks"].get("recording", {}).get("is") != "failed":
            told = heard(await line.read_message())
        refused = told["tasks"]["recording"]["said"]
        await line.write_message(json.dumps({"do": "start", "task": "diagnosis"}))
        while told["tell"] != "said":
            told = heard(await line.read_message())
        line.close()
        return refused, told["text"]

    refused, said = IOLoop().run_sync(talk, timeout=100)
    assert refused.startswith("mesh.file = '/etc/passwd': must be below the folder")
    assert said.startswith("there is no recording yet")
