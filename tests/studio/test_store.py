"""The page's store and the frames that it unpacks, by the test runner of node."""

import base64
import json
import shutil
import subprocess
from pathlib import Path

import pytest

from softdot.studio.frames import packed

TESTS = Path(__file__).with_name("store.test.mjs")


def test_arrays_of_a_view_travel_as_bytes():
    view = {"points": base64.b64encode(b"abcde").decode(), "region": base64.b64encode(b"xy").decode(), "plane": 0.5}
    frame = packed({"tell": "parts", "revision": 3, "view": view})
    length = int.from_bytes(frame[:4], "little")
    head, arrays = json.loads(frame[4 : 4 + length]), frame[4 + length :]
    for name, content in (("points", b"abcde"), ("region", b"xy")):
        at = head["view"][name]["at"]
        assert at % 4 == 0
        assert arrays[at : at + head["view"][name]["bytes"]] == content
    assert (head["revision"], head["view"]["plane"]) == (3, 0.5)


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_the_store_of_the_page():
    done = subprocess.run(["node", "--test", str(TESTS)], capture_output=True, encoding="utf-8", timeout=60)
    assert done.returncode == 0, done.stdout
